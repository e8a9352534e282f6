"""Counts the steps up and down that both feet have made or passed, by the truth."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEAST_CHANGE = 0.015
"""Metres between two levels that count as two."""
LOOKS_A_FOOTPRINT = 5
"""Looks in a row at which a sole must touch to have taken its place."""
_SPACING = 0.005
_CLEAR_OF_ENDS = 0.05
"""Metres around a footprint's middle in which its own height is taken, not the course's."""


class FootTrack:
    """The levels that one foot has trodden on or swung over, in order."""

    def __init__(self, height_at: Callable[[Floats], Floats]) -> None:
        """Begin with no footprint.

        Args:
            height_at: height of the highest surface at points (n, 2), m.
        """
        self._height_at = height_at
        self._print: tuple[float, float, float] | None = None
        self._looks = 0
        self.rises = 0
        self.falls = 0

    def look(self, x: float, y: float, z: float, *, touching: bool) -> None:
        """Take in where the sole's centre is, m, and whether it touches a floor."""
        self._looks = self._looks + 1 if touching else 0
        if self._looks == LOOKS_A_FOOTPRINT:
            self._step_to(x, y, z)

    def _step_to(self, x: float, y: float, z: float) -> None:
        before, self._print = self._print, (x, y, z)
        if before is None:
            return
        level = before[2]
        for height in [*self._between(before, (x, y, z)), z]:
            # Slopes change the level bit by bit: only a sudden change is a step.
            self.rises += height - level >= LEAST_CHANGE
            self.falls += level - height >= LEAST_CHANGE
            level = height

    def _between(
        self, begin: tuple[float, float, float], end: tuple[float, float, float]
    ) -> list[float]:
        """Return the heights that the foot has swung over, away from its two footprints."""
        length = math.dist(begin[:2], end[:2])
        if length <= 2 * _CLEAR_OF_ENDS:
            return []
        at = np.arange(_CLEAR_OF_ENDS, length - _CLEAR_OF_ENDS, _SPACING)[:, None] / length
        first, last = np.array(begin[:2]), np.array(end[:2])
        heights: list[float] = self._height_at(first + at * (last - first)).tolist()
        return heights


class LevelChanges:
    """Both feet's tracks: a change of level counts when both feet have made or passed it."""

    def __init__(self, height_at: Callable[[Floats], Floats]) -> None:
        """Begin with no footprint.

        Args:
            height_at: height of the highest surface at points (n, 2), m.
        """
        self.feet = (FootTrack(height_at), FootTrack(height_at))

    @property
    def climbed(self) -> int:
        """Changes upwards."""
        return min(foot.rises for foot in self.feet)

    @property
    def descended(self) -> int:
        """Changes downwards."""
        return min(foot.falls for foot in self.feet)
