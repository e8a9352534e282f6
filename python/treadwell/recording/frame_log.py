"""What is recorded of camera frames, handed to rerun by the dozen: a row alone costs it 0.1 ms."""

import time
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

Values = NDArray[Any] | Sequence[Any]
"""A component's instances at one time: an array (n, ...), or a sequence of n."""


class FrameLog:
    """Collects rows for a recording; `send` hands over each entity's rows in columns."""

    def __init__(self, stream: rr.RecordingStream) -> None:
        """Begin with nothing.

        Args:
            stream: the recording.
        """
        self.stream = stream
        self._now, self._first_ns = (0, 0), 0
        self._rows: dict[tuple[str, type[Any]], list[tuple[tuple[int, int], Mapping[str, Values]]]]
        self._rows = {}

    def begin(self, time_ns: int) -> None:
        """Set the time of the rows to come, nanoseconds since the start."""
        self._now = (time_ns, time.time_ns())
        if not self._rows:
            self._first_ns = self._now[1]

    @property
    def waiting_seconds(self) -> float:
        """For how long the first of the rows had waited when the last ones began, s."""
        return 1e-9 * (self._now[1] - self._first_ns)

    def log(self, entity: str, archetype: type[Any], **fields: Values) -> None:
        """Add a row.

        Args:
            entity: path of the entity.
            archetype: one of rerun's; an entity's rows of one archetype have the same fields.
            fields: the archetype's fields; nothing in them may change afterwards.
        """
        self._rows.setdefault((entity, archetype), []).append((self._now, fields))

    def send(self) -> None:
        """Hand over what was collected."""
        for (entity, archetype), rows in self._rows.items():
            times = np.array([when for when, _ in rows])
            indexes = (
                rr.TimeColumn("time", duration=times[:, 0].astype("timedelta64[ns]")),
                # As rerun adds it to what is logged row by row.
                rr.TimeColumn("log_time", timestamp=times[:, 1].astype("datetime64[ns]")),
            )
            self.stream.send_columns(
                entity, indexes, _columns(archetype, [fields for _, fields in rows])
            )
        self._rows.clear()


def _columns(
    archetype: type[Any], rows: Sequence[Mapping[str, Values]]
) -> list[rr.ComponentColumn]:
    joined, lengths = {}, {}
    for name in rows[0]:
        parts = [row[name] for row in rows]
        lengths[name] = [len(part) for part in parts]
        whole = isinstance(parts[0], np.ndarray)
        joined[name] = np.concatenate(parts) if whole else list(chain.from_iterable(parts))
    batches = archetype.from_fields(**joined).as_component_batches()
    return [
        batch.partition(lengths[batch.component_descriptor().component.partition(":")[2]])
        for batch in batches
    ]
