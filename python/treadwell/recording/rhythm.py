"""At which camera frames a recording takes what costs much to hand over and changes little."""

from typing import Final

_MAP_NS: Final = 300_000_000
"""Nanoseconds from one recorded map to the next: the robot walks less than a cell meanwhile."""
_VOXELS_STRIDE: Final = 12
"""Of so many camera frames, about two seconds, one has its local map recorded."""
_GUESSES_STRIDE: Final = 2
"""Of so many camera frames one has its guesses recorded."""


class Rhythm:
    """Says frame by frame what is due.

    Attributes:
        map: whether the map's window is, with what is measured in it.
        voxels: whether the local map is; until `voxels_taken` says that there were any.
        guesses: whether a localizer's guesses are.
        plans: plans of footsteps that are recorded already.
    """

    def __init__(self) -> None:
        """Begin before the first frame."""
        self.map = self.voxels = self.guesses = False
        self.plans = 0
        self._mapped_ns = -_MAP_NS
        self._frames = self._until_voxels = 0

    def frame(self, time_ns: int) -> None:
        """Go on to the next camera frame, nanoseconds since the start."""
        self.map = time_ns - self._mapped_ns >= _MAP_NS
        if self.map:
            self._mapped_ns = time_ns
        self._until_voxels -= 1
        self.voxels = self._until_voxels < 0
        self._frames += 1
        self.guesses = self._frames % _GUESSES_STRIDE == 1

    def voxels_taken(self) -> None:
        """Wait for some frames until they are due again."""
        self._until_voxels = _VOXELS_STRIDE - 1
