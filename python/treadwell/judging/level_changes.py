"""Counts the steps up and down that both feet have made or passed, by the truth."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Footprint = tuple[float, float, float]
"""World x, y, z of a sole's centre, m."""

LEAST_CHANGE = 0.015
"""Metres between two levels that count as two, on a course of scale 1."""
LOOKS_A_FOOTPRINT = 5
"""Looks in a row at which a sole must touch to have taken its place."""
_SPACING = 0.005
_CLEAR_OF_ENDS = 0.05
"""Metres around a footprint's middle in which its own height is taken, not the course's."""


class FootTrack:
    """The levels that one foot has trodden on or swung over, in order.

    Attributes:
        rises: changes of level upwards.
        falls: changes of level downwards.
        other: the other foot's track, None for a foot alone.
    """

    def __init__(self, height_at: Callable[[Floats], Floats], scale: float = 1.0) -> None:
        """Begin with no footprint.

        Args:
            height_at: height of the highest surface at points (n, 2), m.
            scale: the course's.
        """
        self._height_at = height_at
        self._least, self._clear = LEAST_CHANGE * scale, _CLEAR_OF_ENDS * scale
        self._spacing = _SPACING * scale
        self._prints: list[Footprint] = []
        self._last = (0, 0)  # rises and falls of the last step
        self._looks = 0
        self.rises = 0
        self.falls = 0
        self.other: FootTrack | None = None

    def look(self, x: float, y: float, z: float, *, touching: bool) -> None:
        """Take in where the sole's centre is, m, and whether it touches a floor."""
        if not touching:
            self._looks = 0
            return
        self._looks += 1
        if self._looks == LOOKS_A_FOOTPRINT:
            self._step_to((x, y, z))

    def begin_elsewhere(self) -> None:
        """Forget the footprints: what lies between the last and the next was not walked."""
        self._prints, self._last, self._looks = [], (0, 0), 0

    def _step_to(self, end: Footprint) -> None:
        if self._takes_back(end):
            self.rises -= self._last[0]
            self.falls -= self._last[1]
            self._prints, self._last = [end], (0, 0)
            return
        self._prints = [*self._prints[-1:], end]
        if len(self._prints) == 1:
            return
        rises = falls = 0
        level = self._prints[0][2]
        for height in [*self._between(*self._prints), end[2]]:
            # Slopes change the level bit by bit: only a sudden change is a step.
            rises += height - level >= self._least
            falls += level - height >= self._least
            level = height
        self.rises += rises
        self.falls += falls
        self._last = rises, falls

    def _takes_back(self, end: Footprint) -> bool:
        """Say whether the foot returns to where it came from before the other foot followed it."""
        if self.other is None or self._last == (0, 0):
            return False
        before, last = self._prints
        back = math.dist(end[:2], before[:2]) < math.dist(end[:2], last[:2])
        level = abs(end[2] - before[2]) < self._least
        rises, falls = self.rises - self._last[0], self.falls - self._last[1]
        alone = rises >= self.other.rises and falls >= self.other.falls
        return back and level and alone

    def _between(self, begin: Footprint, end: Footprint) -> list[float]:
        """Return the heights that the foot has swung over, away from its two footprints."""
        length = math.dist(begin[:2], end[:2])
        if length <= 2 * self._clear:
            return []
        at = np.arange(self._clear, length - self._clear, self._spacing)[:, None] / length
        first, last = np.array(begin[:2]), np.array(end[:2])
        heights: list[float] = self._height_at(first + at * (last - first)).tolist()
        return heights


class LevelChanges:
    """Both feet's tracks: a change of level counts when both feet have made or passed it."""

    def __init__(self, height_at: Callable[[Floats], Floats], scale: float = 1.0) -> None:
        """Begin with no footprint.

        Args:
            height_at: height of the highest surface at points (n, 2), m.
            scale: the course's.
        """
        self.feet = (FootTrack(height_at, scale), FootTrack(height_at, scale))
        self.feet[0].other, self.feet[1].other = self.feet[1], self.feet[0]

    @property
    def climbed(self) -> int:
        """Changes upwards."""
        return min(foot.rises for foot in self.feet)

    @property
    def descended(self) -> int:
        """Changes downwards."""
        return min(foot.falls for foot in self.feet)
