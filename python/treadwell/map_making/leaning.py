"""Whether the floor that pictures show is level in the world of their poses."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from treadwell.map_making.request import MapTable
from treadwell.sources.frame import Floats, RangeFrame

_STEEPEST: Final = 1.0
"""Rise over run up to which a surface can be a floor that was taken askew: 45 degrees."""
_BIN: Final = 0.02
"""Rise over run in a bin: a degree, about as exact as a block of pixels is."""
_REACH: Final = 2
"""Bins to either side that are one surface."""
_COLUMNS: Final = 80
"""Pictures are looked at in about so many columns."""
_BLOCK: Final = 8
"""Rows and columns of which a surface is taken to be one. Of two by two, the noise of a narrow
stereo pair made a level floor lean by 4 degrees; of so many it leans by less than one."""
_APART: Final = 4
"""Rows and columns from one block to the next."""


@dataclass(frozen=True, slots=True)
class Lean:
    """How the largest surface that may be floor lies.

    Attributes:
        angle: rad, to the plane of the map.
        up: its normal, (3,), in the map's frame; of length one.
        share: of all that was seen, the part that lies like it.
    """

    angle: float
    up: Floats
    share: float

    @property
    def said(self) -> str:
        """How much it leans, in words."""
        degrees = math.degrees(self.angle)
        return f"the surface that looks like the floor leans by {degrees:.1f} degrees"


class Leaning:
    """Counts which way the surfaces of pictures face."""

    def __init__(self) -> None:
        """Begin with nothing."""
        side = 2 * round(_STEEPEST / _BIN)
        self._counts = np.zeros((side, side))
        self._sums = np.zeros((2, side, side))
        self._seen = 0

    def insert(self, frame: RangeFrame, map_from_sensor: Floats) -> None:
        """Take in a frame; of one that is no picture nothing.

        Args:
            frame: the frame.
            map_from_sensor: (4, 4).
        """
        normals = _normals(frame) @ map_from_sensor[:3, :3].T
        self._seen += len(normals)
        upward = normals[np.abs(normals[:, 2]) > 1e-6]
        slopes = -upward[:, :2] / upward[:, 2:]
        slopes = slopes[np.hypot(*slopes.T) < _STEEPEST]
        at = np.floor((slopes + _STEEPEST) / _BIN).astype(int).T
        np.add.at(self._counts, tuple(at), 1.0)
        for axis in range(2):
            np.add.at(self._sums[axis], tuple(at), slopes[:, axis])

    def notes(self, data: MapTable, map_from_world: Floats) -> list[str]:
        """Return a note where the floor leans, with the setting that makes it level.

        Args:
            data: how the data is taken: how much is too much.
            map_from_world: (3, 3) turn.
        """
        lean = self._too_much(data)
        if lean is None:
            return []
        up = ",".join(f"{part:.4f}" for part in map_from_world.T @ lean.up)
        return [f"{lean.said} in the map; if the real floor is level, add --set 'map.up=[{up}]'"]

    def of_poses(self, data: MapTable) -> tuple[str, ...]:
        """Return a note where the floor leans, for those who make the poses.

        Args:
            data: how the data is taken: how much is too much.
        """
        lean = self._too_much(data)
        if lean is None:
            return ()
        up = ", ".join(f"{part:.4f}" for part in lean.up)
        return (f"{lean.said}; if the real floor is level, turn the poses so that ({up}) is up",)

    def _too_much(self, data: MapTable) -> Lean | None:
        lean = self.found()
        if lean is None or lean.share <= data.floor_share or lean.angle <= data.level_within:
            return None
        return lean

    def found(self) -> Lean | None:
        """Return how the largest surface lies; None where none was seen that may be floor."""
        near = _summed(self._counts)
        # Summed twice, the greatest is in the middle of what is there, not at its rim.
        at = np.unravel_index(int(_summed(near).argmax()), near.shape)
        if not near[at]:
            return None
        x, y = (float(_summed(sums)[at] / near[at]) for sums in self._sums)
        up = np.array([-x, -y, 1.0])
        steep = math.hypot(x, y)
        return Lean(math.atan(steep), up / math.hypot(steep, 1.0), float(near[at] / self._seen))


def _normals(frame: RangeFrame) -> Floats:
    """Return normals (n, 3) of a picture's surfaces, in the sensor's frame, evenly out of all.

    Each is of the plane that is fitted to the inverse depths of a block that was seen whole. Those
    of a plane are linear in row and column, and a camera's noise is alike all over them: of depths
    themselves it would turn the normal.
    """
    if frame.depth is None or frame.camera is None:
        return np.zeros((0, 3))
    camera, step = frame.camera, max(1, frame.depth.shape[1] // _COLUMNS)
    inverse = 1.0 / frame.depth[::step, ::step].astype(np.float64)
    if min(inverse.shape) < _BLOCK:
        return np.zeros((0, 3))
    blocks = sliding_window_view(inverse, (_BLOCK, _BLOCK))[::_APART, ::_APART]
    from_middle = step * (np.arange(_BLOCK) - 0.5 * (_BLOCK - 1))
    squares = _BLOCK * float(from_middle @ from_middle)
    along = np.einsum("ijrc,c->ij", blocks, from_middle) / squares
    down = np.einsum("ijrc,r->ij", blocks, from_middle) / squares
    rows, cols = step * (_APART * np.indices(along.shape) + 0.5 * (_BLOCK - 1))
    at_axis = blocks.mean(axis=(2, 3)) + along * (camera.cx - cols) + down * (camera.cy - rows)
    normals = np.stack([along * camera.fx, down * camera.fy, at_axis], axis=-1).reshape(-1, 3)
    lengths = np.linalg.norm(normals, axis=1)
    known = np.isfinite(lengths) & (lengths > 0.0)
    found: Floats = normals[known] / lengths[known, None]
    return found


def _summed(bins: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the sums over the bins around each."""
    padded = np.pad(bins, _REACH)
    rows, cols = bins.shape
    reach = range(2 * _REACH + 1)
    total: NDArray[np.float64] = sum(
        (padded[i : i + rows, j : j + cols] for i in reach for j in reach), np.zeros_like(bins)
    )
    return total
