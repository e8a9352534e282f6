"""What recorder and watches are given at each camera frame: plain data of core and judge."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from treadwell.footstep_plan import FootstepPlan
from treadwell.protocols import Footstep

Floats = NDArray[np.float64]
FLOOR_DEPTH: Final = 1.0
"""Metres from front to back from which on a level is floor to look at, not a stair."""


class Sole(NamedTuple):
    """The true pose of a sole.

    Attributes:
        x: m, world, of its centre on the underside.
        y: m, world.
        z: m, world.
        forward: (x, y) of the sole's x axis in the world.
    """

    x: float
    y: float
    z: float
    forward: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class StairTrace:
    """A stair that the core sees or remembers, in the map frame.

    Attributes:
        front: (2, 3) left and right end of the edge that is crossed onto it, m.
        back: (2, 3) the same of the edge that is crossed off it, m.
        front_fitted: whether the front edge was fitted to the disparities.
        back_fitted: whether the back edge was.
        steps_ago: steps taken since it was last seen.
    """

    front: Floats
    back: Floats
    front_fitted: bool
    back_fitted: bool
    steps_ago: int

    def height(self) -> float:
        """Return its height in the map frame, m."""
        (_, _, left), (_, _, right) = self.front.tolist()
        return float((left + right) / 2)

    def depth(self) -> float:
        """Return how far its back edge's middle lies from its front edge's, m."""
        (left_x, left_y, _), (right_x, right_y, _) = (self.back - self.front).tolist()
        return math.hypot((left_x + right_x) / 2, (left_y + right_y) / 2)


@dataclass(frozen=True, slots=True, eq=False)
class SteppingTrace:
    """Footsteps as they were planned last, and over what ground, in the map frame.

    Attributes:
        plan: the steps and what they cost.
        exit: (x, y) where the way leads on over ground that was not seen, m; None at the goal.
        count: how many plans there were, this one too.
        origin: (x, y) lower-left corner of the ground, m.
        cell: side of a cell, m.
        ground: (rows, cols) float32 heights, m, NaN where nothing is known; rows along +y.
    """

    plan: FootstepPlan
    exit: tuple[float, float] | None
    count: int
    origin: tuple[float, float]
    cell: float
    ground: NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Trace:
    """One camera frame. The world frame and the map frame are the same; lengths in metres.

    Attributes:
        time_ns: nanoseconds since the start.
        map_from_robot: (4, 4) where the robot believes to be.
        odometry_from_robot: (4, 4) by leg odometry alone, moved to start where the estimate did.
        truth_from_robot: (4, 4) where it was when it saw that.
        map_from_camera: (4, 4) the camera as the core has it; None before the first frame.
        depth: (h, w) float32, NaN where nothing was seen; None without a frame.
        points_in_robot: (n, 3) float32, robot frame; NaN where nothing was seen.
        labels: (n,) uint16, plane of each point plus one, 0 for none.
        ground: label of the ground's plane, 0 where it was not found.
        view_origin: (x, y) lower-left corner of the map's window, map frame.
        view_cell: side of a cell.
        view_kind: (rows, cols) uint8: 0 unknown, 1 floor, 2 obstacle; rows along +y.
        view_height: (rows, cols) float32, NaN where unknown.
        sightings: (rows, cols) uint16, frames that saw the cell as floor.
        maps_forgotten: how often the robot had found itself elsewhere, and the core had forgotten
            its map.
        map_due: whether the map's window is to be recorded at this frame.
        clearance: (rows, cols) float32, distance to the nearest obstacle; None without one, or
            where the map is not due.
        occupied: (n, 4) float32, middle and side of each cube that was seen to be occupied; empty
            without a map in three dimensions, or where it is not due.
        guesses: (n, 4) float32, where the torso may be, some of many, and its heading, rad; empty
            of a localizer that keeps no guesses, or where they are not due.
        path: (n, 2) the path in the map frame; empty without one.
        climbs: for each leg of the path that is climbed the indices of its first and last point.
        stairs: the stairs that are seen or remembered.
        soles: the true soles, left and right.
        touch: whether the left and the right sole truly stand on something.
        footsteps: steps that the feet are told to take, in the robot's frame of when they were
            listed first; empty while they walk or stand.
        stepping: a plan of footsteps that is new at this frame; None where there is none.
        misstep: why the last listed step was taken back, or "stumbled" where a walk came upon an
            unseen step; None where neither was.
        state: name of the behaviour's state.
        goal: (x, y) of the goal that is pursued now.
        gaze: (pan to the left, down from the horizon) rad.
        body_positions: (nbody, 3) true poses of MuJoCo's bodies (`xpos`).
        body_orientations: (nbody, 4) wxyz (`xquat`).
        timing: stage -> seconds at this frame; NaN where it did not run.
    """

    time_ns: int
    map_from_robot: Floats
    odometry_from_robot: Floats
    truth_from_robot: Floats
    map_from_camera: Floats | None = None
    depth: NDArray[np.float32] | None = None
    points_in_robot: NDArray[np.float32] | None = None
    labels: NDArray[np.uint16] | None = None
    ground: int = 0
    view_origin: tuple[float, float]
    view_cell: float
    view_kind: NDArray[np.uint8]
    view_height: NDArray[np.float32]
    sightings: NDArray[np.uint16]
    maps_forgotten: int = 0
    map_due: bool = True
    clearance: NDArray[np.float32] | None = None
    occupied: NDArray[np.float32] = field(default_factory=lambda: np.empty((0, 4), np.float32))
    guesses: NDArray[np.float32] = field(default_factory=lambda: np.empty((0, 4), np.float32))
    path: Floats
    climbs: tuple[tuple[int, int], ...] = ()
    stairs: tuple[StairTrace, ...] = ()
    soles: tuple[Sole, Sole] | None = None
    touch: tuple[bool, bool] = (False, False)
    footsteps: tuple[Footstep, ...] = ()
    stepping: SteppingTrace | None = None
    misstep: str | None = None
    state: str
    goal: tuple[float, float]
    gaze: tuple[float, float]
    body_positions: Floats
    body_orientations: Floats
    timing: Mapping[str, float] = field(default_factory=dict)

    def points(self, stride: int = 1) -> NDArray[np.float32] | None:
        """Return every so manieth of the points in the map frame, (m, 3) float32."""
        if self.points_in_robot is None:
            return None
        return transformed(self.map_from_robot, self.points_in_robot[::stride])


def transformed(target_from_source: Floats, points: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return points (n, 3) float32 in the target frame."""
    rotation = target_from_source[:3, :3].astype(np.float32)
    moved: NDArray[np.float32] = points @ rotation.T
    moved += target_from_source[:3, 3].astype(np.float32)
    return moved
