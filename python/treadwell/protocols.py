"""The six components that a user can replace, as protocols of the same shape as the core's traits.

A component is chosen by name, by `package.module:Class` in a scenario, or given as an object to
`treadwell.run`. Inputs are read-only. What a method raises ends the episode with the outcome
`error` and the component's name. Map frame, metres and radians throughout; a pose is
(x, y, z, yaw).

Each may have a method `begin(setup)`, too: called once, before the first tick, with what the core
is told, a `Setup`. An exception there is bad input: nothing runs. Other methods that a component
may have or not are said with its protocol.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from treadwell._core import (
    BodyState as BodyState,
    Command as Command,
    FloorView as FloorView,
    Goal as Goal,
    Octree as Octree,
    Planes as Planes,
    Proprioception as Proprioception,
    Scan as Scan,
    Situation as Situation,
    Staircase as Staircase,
    Stepping as Stepping,
)

Pose = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Setup:
    """What a component may be told before the first tick; no truth but the start, where it is told.

    Attributes:
        start: the robot's frame in the map; None where it has to find out.
        goals: the places to go to, in their order.
        robot: what the core knows of the body: joints, legs, camera, `body` with its `radius` and
            `height`, m, as `robot.toml` and the MJCF have them.
        static_map: the known map of the place as an octree; None where the robot is told none.
            It is told one where a component that needs it is chosen, or the scenario has a table
            `[navigation.static_map]`.
    """

    start: Pose | None
    goals: tuple[Goal, ...]
    robot: Mapping[str, Any] = field(repr=False)
    static_map: Octree | None


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """What a segmenter finds in a scan.

    Attributes:
        labels: (pixels,) uint16, region of each pixel plus one, 0 for none; row by row.
        floor_heights: for each region its height above the robot's ground in metres, None when it
            is not horizontal.
        robot_from_camera: (4, 4) the camera's pose, corrected where the ground allows it.
        ground: index of the region that is the ground, None when it was not found.
        reliable: whether the heights may be trusted.
    """

    labels: NDArray[np.uint16]
    floor_heights: list[float | None]
    robot_from_camera: NDArray[np.float64]
    ground: int | None
    reliable: bool


class Segmenter(Protocol):
    """Finds planes in a scan."""

    def segment(self, scan: Scan, /) -> Segmentation:
        """Return the regions of one depth image."""


class FloorMap(Protocol):
    """The floor, obstacle and unknown view that planners read; the core's `FloorView` is one.

    It may have `sightings`, too: (rows, cols) uint16, in how many frames a cell was seen as floor.
    Steps are planned, and the map is scored, on cells that were seen three times. Without it every
    cell that is known counts as seen often.
    """

    @property
    def origin(self) -> tuple[float, float]:
        """Lower-left corner of cell (0, 0), m."""

    @property
    def cell(self) -> float:
        """Side of a cell, m."""

    @property
    def kind(self) -> NDArray[np.uint8]:
        """(rows, cols): 0 unknown, 1 floor, 2 obstacle; rows along +y."""

    @property
    def height(self) -> NDArray[np.float32]:
        """(rows, cols): height in the map frame, m; NaN where unknown."""


class WorldModel(Protocol):
    """Keeps a model of the world.

    It may have a method `forget()`, too: called before the next `insert` when the robot found
    itself elsewhere than it had believed, so that what was mapped lies in the wrong place.
    `treadwell.mapping.floor_view` makes a view of heights.
    """

    def insert(self, planes: Planes, pose: Pose, /) -> bool:
        """Take in one frame seen from `pose`; return whether it was used."""

    def view(self) -> FloorMap:
        """Return what planners read, as of the last insertion."""


class Localizer(Protocol):
    """Keeps the robot's pose in the map.

    `BodyState.odometry_from_robot` begins at its own origin, not where the robot starts: that is
    `Setup.start`, which `begin(setup)` is told. It may have a method `see(scan)`, too: called with
    each depth frame, a `Scan`, before it is segmented, for a localizer that reads the picture
    itself.
    """

    def correct(self, body: BodyState, planes: Planes, view: FloorView, /) -> None:
        """Learn from a segmented frame, before the map takes it in."""

    def estimate(self, body: BodyState, /) -> Pose:
        """Return the pose at a control tick."""


class ListedStep(NamedTuple):
    """Where a planner would have a foot put.

    Attributes:
        side: foot that moves, `left` or `right`.
        x: m, in the map, of the middle of its sole.
        y: the same.
        yaw: rad, heading of the sole.
    """

    side: str
    x: float
    y: float
    yaw: float


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """What a planner found.

    Attributes:
        path: (n, 2) points from the robot to the goal, None when there is no way.
        reason: one sentence when there is no way.
        replanned: whether it was planned anew.
        footsteps: where the feet are to go, in this order, from where they stand. The behaviour
            `footsteps` begins them where the robot comes near the first, and takes them while the
            ground bears each of them and the legs reach it; what is not possible is refused, with
            the reason in `result.json`, and it plans steps of its own. Other behaviours follow the
            path.
    """

    path: NDArray[np.float64] | None
    reason: str = ""
    replanned: bool = True
    footsteps: Sequence[ListedStep] = ()

    def __repr__(self) -> str:
        way = self.reason if self.path is None else f"{len(self.path)} points"
        return f"<Plan: {way}, {len(self.footsteps)} footsteps>"


class Planner(Protocol):
    """Finds a way over the floor that the world model shows.

    The stairs are there to be kept away from, or to be chosen from by a behaviour of the user's:
    every leg of the path that is returned is walked. It may have a method `forget()`, too, called
    before the next `plan` when the robot found itself elsewhere than it had believed.

    A flat top that the camera sees from above is floor with a height, and no obstacle.
    `view.passable(z, rise, radius)` tells where a robot may be that stands at height z, and
    `view.clearance()` how far what blocks is; `Setup.robot["body"]["radius"]` is its own.
    """

    def plan(self, view: FloorView, stairs: Staircase, start: Pose, goal: Goal, /) -> Plan:
        """Return a way for the robot at `start` to the goal's disc."""


class Footstep(NamedTuple):
    """One step of a list.

    A `careful` one goes straight up, over, and straight down onto what may be higher or lower; a
    `walked` one goes as the robot walks, which is faster, where the ground is level and no farther
    away than the robot walks, else carefully.

    Attributes:
        side: foot that moves, `left` or `right`.
        x: m, centre of its sole, forward in the robot's frame when the list was given first.
        y: m, the same to the left.
        yaw: rad, heading of the sole in that frame.
        height: m, of the surface there above the robot's ground then.
        bearing_from: m forward of the sole's centre: where the part that bears load begins.
        bearing_to: m forward of the sole's centre: where it ends; the rest overhangs an edge.
        manner: `careful` or `walked`.
        slope: rise of that surface per metre, along the sole and to its left.
    """

    side: str
    x: float
    y: float
    yaw: float
    height: float
    bearing_from: float
    bearing_to: float
    manner: str = "careful"
    slope: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Decision:
    """What a behaviour decides.

    Attributes:
        state: name of the state, for the recording's lane.
        velocity: (forward m/s, left m/s, counter-clockwise rad/s), None to stand.
        footsteps: steps to take one after the other instead, given anew at every tick until
            `Situation.standing`; how they go is in `Situation.stepping`.
        gaze: (pan to the left, down from the horizon), rad.
        goal_passed: go for the next goal.
        outcome: `goal_reached`, or `word: sentence` to refuse; None to go on.
    """

    state: str
    velocity: tuple[float, float, float] | None = None
    footsteps: tuple[Footstep, ...] = ()
    gaze: tuple[float, float] = (0.0, 0.6)
    goal_passed: bool = False
    outcome: str | None = None


class Behaviour(Protocol):
    """Decides what to do next."""

    def next(self, situation: Situation, /) -> Decision:
        """Return the decision at a control tick."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class JointTargets:
    """What the joints are asked for at one control tick; arrays by the robot's joint order.

    Attributes:
        position: (n,) rad.
        velocity: (n,) rad/s.
        torque: (n,) N·m, fed forward: added to what the servo does for position and velocity.
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    torque: NDArray[np.float64]

    @classmethod
    def at(cls, position: NDArray[np.float64]) -> Self:
        """Return targets that hold these angles, (n,) rad: no velocity, nothing fed forward."""
        still = np.zeros(len(position))
        return cls(position, still, still)

    def __repr__(self) -> str:
        largest = float(np.max(np.abs(self.torque), initial=0.0))
        return f"<JointTargets of {len(self.position)} joints, up to {largest:.1f} N m fed forward>"


class Walker(Protocol):
    """Moves all joints as it is told, by what the body feels.

    It may have three more methods, without arguments, each called after every `step`:

    - `standing() -> bool`: whether the robot stands still on both soles. Without it, it stands once
      it was told to and no foot was lifted for as long as a step takes (`gait.step_time`).
    - `steps_taken() -> int`: landings so far. Without it they are counted by the feet's loads.
    - `stepping() -> Stepping`, of `treadwell._core`: how the listed footsteps go. Only a walker
      that has it is given footsteps; with any other, `Situation.takes_footsteps` is False, and
      the robot refuses with `walker: ...` where a behaviour lists footsteps all the same.
    """

    def step(self, command: Command, proprioception: Proprioception, /) -> JointTargets:
        """Return the targets of all joints for one control tick.

        Called at every control tick of 10 ms. What turns the head to where the command looks is in
        `command.head`.
        """
