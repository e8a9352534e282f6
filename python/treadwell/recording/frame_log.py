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
_When = tuple[int, int]
_Key = tuple[str, type[Any], tuple[str, ...]]


class FrameLog:
    """Collects rows for a recording; `send` hands over each entity's rows in columns."""

    def __init__(self, stream: rr.RecordingStream) -> None:
        """Begin with nothing.

        Args:
            stream: the recording.
        """
        self.stream = stream
        self._frames: list[_When] = []
        self._rows: dict[_Key, list[tuple[int, Mapping[str, Values]]]] = {}
        """Frames, by their index in the list above, and what was logged of them."""
        self._times: dict[tuple[int, ...], tuple[rr.TimeColumn, rr.TimeColumn]] = {}
        self._styled: set[str] = set()

    def begin(self, time_ns: int) -> None:
        """Set the time of the rows to come, nanoseconds since the start."""
        self._frames.append((time_ns, time.time_ns()))

    @property
    def frames(self) -> int:
        """How many frames wait."""
        return len(self._frames)

    @property
    def waiting_seconds(self) -> float:
        """For how long the first of the frames had waited when the last one began, s."""
        return 1e-9 * (self._frames[-1][1] - self._frames[0][1]) if self._frames else 0.0

    def is_styled(self, entity: str) -> bool:
        """Whether it was said what is the same for all rows of an entity."""
        return entity in self._styled

    def style(self, entity: str, archetype: type[Any], **fields: Values) -> None:
        """Say once what is the same for all rows of an entity; said again, it is not heard.

        Args:
            entity: path of the entity.
            archetype: one of rerun's.
            fields: the archetype's fields; none of those of the entity's rows.
        """
        if entity not in self._styled:
            self._styled.add(entity)
            self.stream.log(entity, archetype.from_fields(**fields), static=True)

    def log(self, entity: str, archetype: type[Any], **fields: Values) -> None:
        """Add a row to the frame that was begun last.

        Args:
            entity: path of the entity.
            archetype: one of rerun's.
            fields: the archetype's fields; nothing in them may change afterwards.
        """
        rows = self._rows.setdefault((entity, archetype, tuple(fields)), [])
        rows.append((len(self._frames) - 1, fields))

    def log_all(self, entity: str, archetype: type[Any], **fields: NDArray[Any]) -> None:
        """Hand over a row for each frame that waits.

        Args:
            entity: path of the entity.
            archetype: one of rerun's.
            fields: (frames, n, ...) of the archetype.
        """
        count, each = next(iter(fields.values())).shape[:2]
        flat = {name: value.reshape(-1, *value.shape[2:]) for name, value in fields.items()}
        columns = _columns(archetype, flat, dict.fromkeys(flat, [each] * count))
        self.stream.send_columns(entity, self._indexes(tuple(range(count))), columns)

    def send(self) -> None:
        """Hand over what was collected."""
        for (entity, archetype, names), rows in self._rows.items():
            joined, lengths = {}, {}
            for name in names:
                parts = [fields[name] for _, fields in rows]
                lengths[name] = [len(part) for part in parts]
                joined[name] = _joined(parts)
            times = self._indexes(tuple(frame for frame, _ in rows))
            self.stream.send_columns(entity, times, _columns(archetype, joined, lengths))
        self._rows.clear()
        self._frames.clear()
        self._times.clear()

    def _indexes(self, frames: tuple[int, ...]) -> tuple[rr.TimeColumn, rr.TimeColumn]:
        """Return the times of some frames; most entities have a row at each, or at the same."""
        known = self._times.get(frames)
        if known is None:
            table = np.array([self._frames[frame] for frame in frames])
            known = self._times[frames] = (
                rr.TimeColumn("time", duration=table[:, 0].astype("timedelta64[ns]")),
                # As rerun adds it to what is logged row by row.
                rr.TimeColumn("log_time", timestamp=table[:, 1].astype("datetime64[ns]")),
            )
        return known


def _joined(parts: Sequence[Values]) -> Values:
    if isinstance(parts[0], np.ndarray):
        return np.concatenate(parts) if len(parts) > 1 else parts[0]
    return list(chain.from_iterable(parts))


def _columns(
    archetype: type[Any], joined: Mapping[str, Values], lengths: Mapping[str, Sequence[int]]
) -> list[rr.ComponentColumn]:
    batches = archetype.from_fields(**joined).as_component_batches()
    return [
        batch.partition(lengths[batch.component_descriptor().component.partition(":")[2]])
        for batch in batches
    ]
