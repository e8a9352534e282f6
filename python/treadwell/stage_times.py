"""How long each stage of an episode took: noted in one call a tick, sorted by the thousand."""

from array import array
from collections.abc import Sequence
from typing import Final

import numpy as np

_TICKS: Final = 1024
"""Ticks whose times wait until they are sorted."""


class StageTimes:
    """Keeps 4 bytes for each time that a stage ran."""

    def __init__(self, others: Sequence[str], row: Sequence[str]) -> None:
        """Begin with nothing.

        Args:
            others: stages whose times are added one by one.
            row: stages whose times are added together.
        """
        self._seconds = {name: array("f") for name in (*others, *row)}
        self._row = tuple(row)
        self._waiting = array("f")
        self._most = _TICKS * len(row)

    def add(self, stage: str, seconds: float) -> None:
        """Note one of the others' times."""
        self._seconds[stage].append(seconds)

    def add_row(self, seconds: list[float]) -> None:
        """Note the times of all stages of the row; NaN for one that did not run."""
        self._waiting.extend(seconds)
        if len(self._waiting) >= self._most:
            self._sort()

    def seconds(self) -> dict[str, Sequence[float]]:
        """Return stage -> the seconds that it took each time that it ran."""
        self._sort()
        return dict(self._seconds)

    def _sort(self) -> None:
        rows = np.array(self._waiting).reshape(-1, len(self._row))
        self._waiting = array("f")
        for name, column in zip(self._row, rows.T, strict=True):
            self._seconds[name].frombytes(column[~np.isnan(column)].tobytes())
