"""What a run knew of stairs in the end, for `map.png`: each stair as it was seen last."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.recording.trace import StairTrace, Trace

_SAME_HEIGHT: Final = 0.012
"""Metres by which two sightings of one stair may differ."""


_FLOOR_DEPTH: Final = 1.0
"""Metres from front to back from which on a level is floor to look at, not a stair."""


class StairMemory:
    """Keeps every stair as it was seen last, and when the robot climbed.

    Attributes:
        stairs: the stairs, those seen last at the end.
        climbing: for each camera frame whether the feet took listed steps.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.stairs: list[StairTrace] = []
        self.climbing: list[bool] = []

    def update(self, trace: Trace) -> None:
        """Take in a camera frame."""
        self.climbing.append(bool(trace.footsteps))
        seen = [s for s in trace.stairs if s.steps_ago == 0 and _depth(s) < _FLOOR_DEPTH]
        if seen:
            self.stairs = [
                old for old in self.stairs if not any(_is_same(old, new) for new in seen)
            ]
            self.stairs += seen


def outline(stair: StairTrace) -> NDArray[np.float64]:
    """Return a stair's corners from above, (4, 2) m: front left and right, back right and left."""
    corners: NDArray[np.float64] = np.vstack([stair.front, stair.back[::-1]])[:, :2]
    return corners


def _depth(stair: StairTrace) -> float:
    """Return how far its back edge's middle lies from its front edge's, m."""
    return float(np.linalg.norm((stair.back - stair.front).mean(axis=0)[:2]))


def _is_same(one: StairTrace, other: StairTrace) -> bool:
    """Say whether two sightings are of one stair: as high, and the middle of one on the other."""
    rise = one.front[:, 2].mean() - other.front[:, 2].mean()
    if abs(rise) > _SAME_HEIGHT:
        return False
    a, b = outline(one), outline(other)
    return _contains(a, b.mean(axis=0)) or _contains(b, a.mean(axis=0))


def _contains(corners: NDArray[np.float64], point: NDArray[np.float64]) -> bool:
    """Say whether a point lies inside a convex polygon, whichever way round it is given."""
    along, to = np.roll(corners, -1, axis=0) - corners, point - corners
    sides = along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]
    return bool((sides >= 0.0).all() or (sides <= 0.0).all())
