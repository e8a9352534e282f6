"""Where a robot with a map believed to be and was, frame by frame, and what it mapped by itself."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.course.course import CourseElement
from treadwell.course.outlines import near, signed_distance
from treadwell.course.static_map import RESOLUTION, static_map
from treadwell.episode import Episode
from treadwell.map_memory import FLOOR, OBSTACLE, MapMemory, RememberedMap
from treadwell.measuring.score import LEAST_SIGHTINGS, true_cells
from treadwell.trace import Trace

Floats = NDArray[np.float64]

CLEAR_M = 0.07
"""Floor this far from everything that is not walked on is clear of it: a cell and a half."""
_SOLE_M = 0.02
"""A voxel whose middle lies no higher than this above the robot's level is its floor."""


@dataclass(frozen=True, slots=True)
class Unmapped:
    """An element that the static map lacks.

    Attributes:
        name: of the element.
        cells: of the map's memory whose centres lie over it.
        found: those of them that are an obstacle in the end, or a floor above half its height.
    """

    name: str
    cells: int
    found: int


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """What was believed and what was so; an entry for each camera frame.

    Attributes:
        times: (n,) s.
        believed: (n, 4) x, y, z m, heading rad.
        true: (n, 4) the same of the robot itself.
        odometry: (n, 4) the same by leg odometry alone.
        carried: s, when it was carried off last; 0.0 where it was not.
        unmapped: what the static map lacks.
        clear: cells of the map's memory that truly are floor, clear of everything.
        clear_wrong: those of them that are an obstacle in the end.
        static: (m, 2) m, centres of the static map's columns at the height of the robot's body,
            above the level that it stood on in the end.
        voxel: m, side of those.
    """

    times: Floats
    believed: Floats
    true: Floats
    odometry: Floats
    carried: float
    unmapped: tuple[Unmapped, ...]
    clear: int
    clear_wrong: int
    static: Floats
    voxel: float

    def errors(self) -> Floats:
        """Return how far the believed place was from the true one in the plane, (n,) m."""
        return _off(self.believed, self.true)

    def odometry_errors(self) -> Floats:
        """Return the same of leg odometry alone, (n,) m."""
        return _off(self.odometry, self.true)

    def heading_errors(self) -> Floats:
        """Return by how much the believed heading was off, either way, (n,) rad."""
        turn = self.believed[:, 3] - self.true[:, 3]
        wrapped: Floats = np.abs((turn + math.pi) % math.tau - math.pi)
        return wrapped


class WalkWatch:
    """Collects the poses, and the map's memory for what stands on the course unmapped."""

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        self._memory = MapMemory()
        self._rows: list[tuple[float, ...]] = []

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        poses = (trace.map_from_robot, trace.truth_from_robot, trace.odometry_from_robot)
        placed = [value for pose in poses for value in _placed(pose)]
        self._rows.append((1e-9 * trace.time_ns, *placed))
        arrays = (trace.view_kind, trace.view_height, trace.sightings)
        self._memory.update(
            trace.view_origin, trace.view_cell, *arrays, forgotten=trace.maps_forgotten
        )

    def findings(self) -> Walk:
        """Return what was seen so far."""
        rows = np.array(self._rows).reshape(-1, 13)
        true = rows[:, 5:9]
        fired = self._episode.events.fired
        elements = self._episode.course.elements
        remembered = self._memory.map()
        clear = self._clear(remembered)
        return Walk(
            times=rows[:, 0],
            believed=rows[:, 1:5],
            true=true,
            odometry=rows[:, 9:13],
            carried=max((time for time, what in fired if what == "kidnap"), default=0.0),
            unmapped=tuple(_found(one, remembered) for one in elements if not one.mapped),
            clear=int(clear.sum()),
            clear_wrong=int((clear & (remembered.kind == OBSTACLE)).sum()),
            static=self._static(float(true[-1, 2]) if len(true) else 0.0),
            voxel=RESOLUTION,
        )

    def _clear(self, remembered: RememberedMap) -> NDArray[np.bool_]:
        """Say which cells are floor, were seen or are taken for an obstacle, and lie clear."""
        course, body = self._episode.course, self._episode.robot.file.body
        if not remembered.kind.size:
            return np.zeros(remembered.kind.shape, dtype=bool)
        seen = (remembered.sightings >= LEAST_SIGHTINGS) | (remembered.kind == OBSTACLE)
        clear: NDArray[np.bool_] = true_cells(course, remembered, body.height).floor & seen
        centres = remembered.centres().reshape(-1, 2)
        for element in course.elements:
            if element.present and not element.walkable:
                for piece in element.pieces:
                    close = near(piece.outline, centres, CLEAR_M)
                    beside = signed_distance(piece.outline, centres[close]) < CLEAR_M
                    clear.flat[close[beside]] = False
        return clear

    def _static(self, level: float) -> Floats:
        """Return the columns of the static map that bar a robot which stands on a level."""
        tree = static_map(self._episode.course, RESOLUTION, self._episode.scenario.name)
        centres, sides = tree.occupied()
        body = self._episode.robot.file.body.height
        bars = (centres[:, 2] > level + _SOLE_M) & (centres[:, 2] < level + body)
        # Occupied leaves above each other are one column; larger ones stand for the voxels in them.
        columns = [_columns(at, side) for at, side in zip(centres[bars], sides[bars], strict=True)]
        return np.unique(np.vstack([np.zeros((0, 2)), *columns]).round(6), axis=0)


def _placed(pose: Floats) -> tuple[float, float, float, float]:
    """Return x, y, z and heading of a pose (4, 4)."""
    x, y, z = pose[:3, 3].tolist()
    return x, y, z, math.atan2(pose[1, 0], pose[0, 0])


def _off(placed: Floats, true: Floats) -> Floats:
    off: Floats = np.hypot(*(placed[:, :2] - true[:, :2]).T)
    return off


def _columns(centre: Floats, side: float) -> Floats:
    """Return the centres of the columns of voxels in a cube, (n, 2)."""
    count = max(1, round(side / RESOLUTION))
    steps = (np.arange(count) + 0.5) * RESOLUTION - 0.5 * count * RESOLUTION
    x, y = np.meshgrid(centre[0] + steps, centre[1] + steps)
    return np.column_stack([x.ravel(), y.ravel()])


def _found(element: CourseElement, remembered: RememberedMap) -> Unmapped:
    """Count the cells over an element that stands where the course has it."""
    centres = remembered.centres().reshape(-1, 2)
    inside = np.zeros(len(centres), dtype=bool)
    for piece in element.pieces:
        close = near(piece.outline, centres, 0.0)
        inside[close] |= signed_distance(piece.outline, centres[close]) <= 0.0
    heights = np.concatenate([piece.vertices[:, 2] for piece in element.pieces])
    with np.errstate(invalid="ignore"):
        lid = remembered.height.ravel() > 0.5 * (heights.min() + heights.max())
    kind = remembered.kind.ravel()
    found = inside & ((kind == OBSTACLE) | ((kind == FLOOR) & lid))
    return Unmapped(element.name, int(inside.sum()), int(found.sum()))
