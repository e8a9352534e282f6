"""Parts as a user writes them: one class a protocol, none of them clever."""

from typing import Any

import numpy as np

from treadwell._core import (
    BodyState,
    Command,
    FloorView,
    Goal,
    Planes,
    Proprioception,
    Scan,
    Situation,
    Staircase,
)
from treadwell.protocols import (
    Behaviour,
    Decision,
    FloorMap,
    JointTargets,
    Localizer,
    Plan,
    Planner,
    Pose,
    Segmentation,
    Segmenter,
    Walker,
    WorldModel,
)


class Straight:
    """A planner: straight ahead, whatever is in the way."""

    def __init__(self, points: int = 2) -> None:
        if points < 2:
            raise ValueError("points must be 2 or more")
        self.points = points
        self.seen: list[tuple[FloorView, Staircase, Pose, Goal]] = []

    def plan(self, view: FloorView, stairs: Staircase, start: Pose, goal: Goal) -> Plan:
        self.seen.append((view, stairs, start, goal))
        return Plan(np.linspace(start[:2], goal.position, self.points), replanned=False)


class Still:
    """A behaviour: stands and looks to the left."""

    def __init__(self) -> None:
        self.seen: list[Situation] = []

    def next(self, situation: Situation) -> Decision:
        self.seen.append(situation)
        return Decision("idle", gaze=(0.3, 0.5))


class Legs:
    """A localizer: what the legs say, from the start on."""

    def __init__(self) -> None:
        self.corrections = 0
        self.seen: list[BodyState] = []

    def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:
        assert body.time_ns >= planes.exposure_ns
        assert view.cell > 0.0
        self.corrections += 1

    def estimate(self, body: BodyState) -> Pose:
        self.seen.append(body)
        matrix = body.odometry_from_robot
        x, y, z = matrix[:3, 3]
        return float(x), float(y), float(z), float(np.arctan2(matrix[1, 0], matrix[0, 0]))


class AllGround:
    """A segmenter: everything that is seen is the ground."""

    def __init__(self) -> None:
        self.seen: list[Scan] = []

    def segment(self, scan: Scan) -> Segmentation:
        self.seen.append(scan)
        labels = np.isfinite(scan.disparity).ravel().astype(np.uint16)
        return Segmentation(labels, [0.0], scan.robot_from_camera, ground=0, reliable=True)


class Meadow:
    """A world model: floor wherever one looks."""

    class View:
        origin = (-2.0, -1.5)
        cell = 0.05
        kind = np.ones((60, 80), dtype=np.uint8)
        height = np.zeros((60, 80), dtype=np.float32)

    def __init__(self) -> None:
        self.seen: list[tuple[Planes, Pose]] = []

    def insert(self, planes: Planes, pose: Pose) -> bool:
        self.seen.append((planes, pose))
        return True

    def view(self) -> FloorMap:
        return self.View()


class Statue:
    """A walker: holds the upright stance, whatever it is told, and turns the head."""

    def __init__(self) -> None:
        self.seen: list[tuple[Command, Proprioception]] = []

    def step(self, command: Command, proprioception: Proprioception) -> JointTargets:
        self.seen.append((command, proprioception))
        position = proprioception.stand
        for joint, angle in command.head.items():
            position[joint] = angle
        return JointTargets.at(position)


PARTS: dict[str, type[Any]] = {
    "planner": Straight,
    "behaviour": Still,
    "localizer": Legs,
    "segmenter": AllGround,
    "world_model": Meadow,
    "walker": Statue,
}

# The types say the same as the protocols.
_planner: Planner = Straight()
_behaviour: Behaviour = Still()
_localizer: Localizer = Legs()
_segmenter: Segmenter = AllGround()
_world_model: WorldModel = Meadow()
_walker: Walker = Statue()
