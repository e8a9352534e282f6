"""Where a map's frame lies: z up, and near the data, so that its numbers are small."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.map_making.request import Direction
from treadwell.sources.frame import Floats, RangeFrame

_NEAR_M: Final = 1000.0
"""Coordinates up to this keep a tenth of a millimetre in 32 bits."""
_GROUND_SHARE: Final = 5.0
"""Percent of a frame's points that may lie below what is taken for the ground below its sensor."""
_MOST_POINTS: Final = 4000
"""Points of a frame that are looked at to find its ground."""


@dataclass(frozen=True, slots=True, eq=False)
class Placing:
    """How a source's world lies to the map's frame.

    Attributes:
        turn: (3, 3) rotation that brings the source's up to z.
        offset: (3,) m, turned, of the map's origin.
    """

    turn: Floats
    offset: Floats

    def pose(self, world_from_sensor: Floats) -> Floats:
        """Return the sensor's pose (4, 4) in the map's frame."""
        placed = np.eye(4)
        placed[:3, :3] = self.turn @ world_from_sensor[:3, :3]
        placed[:3, 3] = self.turn @ world_from_sensor[:3, 3] - self.offset
        return placed


def placing(up: Direction, world_from_sensor: Floats, cell: float) -> Placing:
    """Return how the map's frame lies: at the world's origin, or at the first sensor far from it.

    Args:
        up: axis of the world that points up, or the direction that does.
        world_from_sensor: (4, 4) of the first frame.
        cell: m; the origin lies at a whole number of cells.
    """
    turn = _turn(up)
    at = turn @ world_from_sensor[:3, 3]
    far = np.abs(at) > _NEAR_M
    return Placing(turn, np.where(far, np.round(at / cell) * cell, 0.0))


def sensed(frame: RangeFrame) -> NDArray[np.float32]:
    """Return some of a frame's points, (n, 3) m in the sensor's frame, evenly out of those seen."""
    if frame.depth is None or frame.camera is None:
        points = frame.points if frame.points is not None else np.zeros((0, 3), np.float32)
        points = points[np.isfinite(points).all(axis=1)]
        return np.asarray(points[:: max(1, len(points) // _MOST_POINTS)], np.float32)
    camera = frame.camera
    step = max(1, int(np.sqrt(frame.depth.size / _MOST_POINTS)))
    depth = frame.depth[::step, ::step].astype(np.float64)
    rows, cols = np.indices(depth.shape) * step
    x = (cols - camera.cx) / camera.fx * depth
    y = (rows - camera.cy) / camera.fy * depth
    seen = np.stack([x, y, depth], axis=-1).reshape(-1, 3)
    return seen[np.isfinite(seen).all(axis=1)].astype(np.float32)


def ground_below(points: NDArray[np.float32], map_from_sensor: Floats) -> float:
    """Return how high the ground lies below a sensor, m in the map: that of its lowest points.

    Args:
        points: (n, 3) m, in the sensor's frame.
        map_from_sensor: (4, 4).
    """
    if not len(points):
        return float(map_from_sensor[2, 3])
    heights = points @ map_from_sensor[2, :3] + map_from_sensor[2, 3]
    return float(np.percentile(heights, _GROUND_SHARE))


def _turn(up: Direction) -> Floats:
    """Return the rotation that brings a direction to z, by the smallest angle."""
    axis = np.zeros(3)
    if isinstance(up, str):
        axis["xyz".index(up[-1])] = -1.0 if up[0] == "-" else 1.0
    else:
        axis[:] = np.array(up) / np.linalg.norm(up)
    cosine = float(axis[2])
    if cosine == -1.0:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.cross(axis, [0.0, 0.0, 1.0])
    skew = np.array(
        [[0.0, -cross[2], cross[1]], [cross[2], 0.0, -cross[0]], [-cross[1], cross[0], 0.0]]
    )
    turned: Floats = np.eye(3) + skew + skew @ skew / (1.0 + cosine)
    return turned
