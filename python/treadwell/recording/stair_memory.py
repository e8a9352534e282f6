"""What a run knew of stairs, for `map.png`: each stair as it was seen best."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.trace import FLOOR_DEPTH, StairTrace

_SAME_HEIGHT: Final = 0.012
"""Metres by which two sightings of one stair may differ."""


class StairMemory:
    """Keeps every stair as it was seen last with a fitted front edge, and when the robot climbed.

    Attributes:
        stairs: the stairs; those that were never fitted as they were seen last.
        climbing: for each camera frame whether the feet took listed steps.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.stairs: list[StairTrace] = []
        self.climbing: list[bool] = []
        self._forgotten = 0
        self._known: Sequence[StairTrace] = ()

    def update(
        self, stairs: Sequence[StairTrace], *, climbing: bool, forgotten: int | None = None
    ) -> None:
        """Take in the stairs of a camera frame.

        Args:
            stairs: those that the core sees or remembers.
            climbing: whether the feet took listed steps.
            forgotten: how often the core has forgotten its stairs (`Pilot.maps_forgotten`). Once
                more than at the last frame: those that it knew then lie in the wrong place. None
                where that is not known.
        """
        self.climbing.append(climbing)
        if forgotten is not None and forgotten != self._forgotten:
            self._forgotten = forgotten
            self.stairs = [
                old for old in self.stairs if not any(_is_same(old, one) for one in self._known)
            ]
        self._known = stairs
        for new in stairs:
            if new.steps_ago or new.depth() >= FLOOR_DEPTH:
                continue
            same = [old for old in self.stairs if _is_same(old, new)]
            if new.front_fitted or not any(old.front_fitted for old in same):
                self.stairs = [old for old in self.stairs if old not in same]
                self.stairs.append(new)


def outline(stair: StairTrace) -> NDArray[np.float64]:
    """Return a stair's corners from above, (4, 2) m: front left and right, back right and left."""
    corners: NDArray[np.float64] = np.vstack([stair.front, stair.back[::-1]])[:, :2]
    return corners


def _is_same(one: StairTrace, other: StairTrace) -> bool:
    """Say whether two sightings are of one stair: as high, and the middle of one on the other."""
    rise = one.height() - other.height()
    if abs(rise) > _SAME_HEIGHT:
        return False
    a, b = outline(one), outline(other)
    return _contains(a, b.mean(axis=0)) or _contains(b, a.mean(axis=0))


def _contains(corners: NDArray[np.float64], point: NDArray[np.float64]) -> bool:
    """Say whether a point lies inside a convex polygon, whichever way round it is given."""
    along, to = np.concatenate([corners[1:], corners[:1]]) - corners, point - corners
    sides = along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]
    return bool((sides >= 0.0).all() or (sides <= 0.0).all())
