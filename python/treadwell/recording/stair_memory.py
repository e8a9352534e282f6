"""What a run knew of stairs, for `map.png`: each stair as it was seen best."""

from collections.abc import Sequence
from typing import Final

from treadwell.map_memory import RememberedMap
from treadwell.recording.steppable import StepLimits, contains, outline, told_apart
from treadwell.trace import FLOOR_DEPTH, StairTrace

_SAME_HEIGHT: Final = 0.012
"""Metres by which two sightings of one stair may differ."""


class StairMemory:
    """Keeps every stair as it was seen last with a fitted front edge, and when the robot climbed.

    Attributes:
        stairs: the stairs; those that were never fitted as they were seen last.
        climbing: for each camera frame whether the feet took listed steps.
        lost: for each whether the robot did not know where it was.
        limits: which of them are stairs for the robot; None: all are.
    """

    def __init__(self, limits: StepLimits | None = None) -> None:
        """Begin with nothing."""
        self.stairs: list[StairTrace] = []
        self.climbing: list[bool] = []
        self.lost: list[bool] = []
        self.limits = limits
        self._forgotten = 0
        self._known: Sequence[StairTrace] = ()

    def update(
        self,
        stairs: Sequence[StairTrace],
        *,
        climbing: bool,
        lost: bool = False,
        forgotten: int | None = None,
    ) -> None:
        """Take in the stairs of a camera frame.

        Args:
            stairs: those that the core sees or remembers.
            climbing: whether the feet took listed steps.
            lost: whether the robot does not know where it is.
            forgotten: how often the core has forgotten its stairs (`Pilot.maps_forgotten`). Once
                more than at the last frame: those that it knew then lie in the wrong place. None
                where that is not known.
        """
        self.climbing.append(climbing)
        self.lost.append(lost)
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

    def told_apart(self, remembered: RememberedMap) -> tuple[list[StairTrace], list[StairTrace]]:
        """Return the stairs that the robot can step on or off, and those that are too high.

        Args:
            remembered: what the map said of the ground around them.
        """
        if self.limits is None:
            return self.stairs, []
        return told_apart(self.stairs, remembered, self.limits)


def _is_same(one: StairTrace, other: StairTrace) -> bool:
    """Say whether two sightings are of one stair: as high, and the middle of one on the other."""
    rise = one.height() - other.height()
    if abs(rise) > _SAME_HEIGHT:
        return False
    a, b = outline(one), outline(other)
    return contains(a, b.mean(axis=0)) or contains(b, a.mean(axis=0))
