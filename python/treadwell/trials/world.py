"""A robot with all the noise of its senses, and its walker, on a course."""

import json
import math
from dataclasses import dataclass
from typing import Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import Walker
from treadwell.course.build import build_course
from treadwell.physics.simulation import Simulation, Start
from treadwell.protocols import JointTargets
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario
from treadwell.senses.sensors import Sensors

Floats = NDArray[np.float64]
Footstep = tuple[str, float, float, float, float, float, float, str, tuple[float, float]]
Motion = tuple[float, float, float] | list[Footstep] | None

TICK_S: Final = 0.01
PUSH_S: Final = 0.1
FALLEN_RAD: Final = 0.8
LOOKS_DOWN_RAD: Final = 0.6
SIDEWAYS_SHARE: Final = 0.6
"""A fall whose lean is more than this share to the side is called one to the side."""


@dataclass(frozen=True, slots=True)
class Size:
    """The lengths that a task is measured by.

    Attributes:
        scale: of the robot: lengths by it, times by its root.
        mass_kg: of the whole robot.
        stance_m: between the soles' middles in the stance.
        sole_m: length of a sole.
    """

    scale: float
    mass_kg: float
    stance_m: float
    sole_m: float

    @staticmethod
    def of(robot: Robot) -> "Size":
        """Read a robot's sizes."""
        model = robot.nominal
        data = mujoco.MjData(model)
        data.qpos[:] = robot.stand_qpos
        mujoco.mj_kinematics(model, data)
        places = [sole_place(model, data, robot, side) for side in (0, 1)]
        return Size(
            scale=float(robot.description().get("scale", 1.0)),
            mass_kg=float(model.body_subtreemass[0]),
            stance_m=float(places[0][1] - places[1][1]),
            sole_m=robot.file.legs.left.sole.length,
        )


class World:
    """A robot on a course, and what it is told."""

    def __init__(self, robot: Robot, course: list[dict[str, Any]], seed: int) -> None:
        """Put the robot at the origin.

        Args:
            robot: loaded.
            course: elements as in a scenario.
            seed: of all that is random.

        Raises:
            InputError: the walker refuses the robot.
        """
        scenario = Scenario.model_validate(
            {
                "schema": 1,
                "name": "trial",
                "robot": str(robot.folder),
                "seed": seed,
                "start": {"position": [0.0, 0.0]},
                "goal": {"position": [50.0, 0.0]},
                "course": course,
            }
        )
        built = build_course(scenario, robot)
        self._robot, self._model = robot, built.model
        self.start_height = built.start.height
        self._simulation = Simulation(self._model, robot, Start(height=self.start_height))
        self._sensors = Sensors(self._model, robot, scenario.sensors, RandomStreams(seed))
        self._sensors.blind(2**62)
        self._simulation.motors.encoder_offsets = self._sensors.encoder_offsets
        self.walker = Walker(json.dumps(robot.description()))
        self._torso = self._model.body(robot.file.body.torso).id
        self._upright = self._simulation.data.xmat[self._torso].reshape(3, 3)[2].copy()
        legs = (robot.file.legs.left, robot.file.legs.right)
        self._soles = [self._model.body(leg.sole.link).id for leg in legs]

    def tick(self, motion: Motion, force: tuple[float, float] = (0.0, 0.0)) -> None:
        """Let a control tick pass.

        Args:
            motion: velocity (m/s, m/s, rad/s), footsteps, or None to stand.
            force: on the torso, (x, y) N.
        """
        simulation = self._simulation
        simulation.data.xfrc_applied[self._torso, :2] = force
        seen = self._sensors.observe(simulation.data, simulation.time_ns, simulation.motors)
        told = self.walker.step(seen, motion, 0.0, LOOKS_DOWN_RAD)
        simulation.advance(JointTargets(*told))

    def pose(self) -> tuple[float, float, float]:
        """Return the soles' middle (x, y), m, and the feet's mean heading, rad."""
        data = self._simulation.data
        places = [sole_place(self._model, data, self._robot, side) for side in (0, 1)]
        x, y, _ = 0.5 * (places[0] + places[1])
        forward = data.xmat[self._soles].reshape(2, 3, 3)[:, :, 0].sum(axis=0)
        return float(x), float(y), math.atan2(forward[1], forward[0])

    def fall(self) -> str | None:
        """Return how the robot has fallen; None while it has not."""
        data = self._simulation.data
        lean = data.xmat[self._torso].reshape(3, 3) @ self._upright
        if lean[2] < math.cos(FALLEN_RAD):
            yaw = self.pose()[2]
            ahead = math.cos(yaw) * lean[0] + math.sin(yaw) * lean[1]
            aside = math.cos(yaw) * lean[1] - math.sin(yaw) * lean[0]
            if abs(aside) > SIDEWAYS_SHARE * math.hypot(ahead, aside):
                return "falls to the side"
            return "falls forwards" if ahead > 0.0 else "falls backwards"
        touching = self._model.geom_bodyid[data.contact.geom]
        root = self._model.body_rootid
        own = root[touching] == root[self._torso]
        parts = touching[own.sum(axis=1) == 1]
        others = [int(part) for part in parts[own[own.sum(axis=1) == 1]]]
        hit = [part for part in others if part not in self._soles]
        return f"{self._model.body(hit[0]).name} touches something" if hit else None


def sole_place(model: mujoco.MjModel, data: mujoco.MjData, robot: Robot, side: int) -> Floats:
    """Return where the middle of a sole is, (3,) m; side 0 is the left one."""
    sole = (robot.file.legs.left, robot.file.legs.right)[side].sole
    link = model.body(sole.link).id
    place: Floats = data.xpos[link] + data.xmat[link].reshape(3, 3) @ np.array(sole.position)
    return place
