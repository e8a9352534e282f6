"""Where the robot truly is: its soles and its frame on the ground, read from the simulator."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.poses import pose_matrix
from treadwell.robot.load import Robot
from treadwell.trace import Sole

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GroundFrame:
    """The robot frame: midway between the soles, on what carries them, x along their mean heading.

    Attributes:
        x: m, world.
        y: m, world.
        z: m, world.
        yaw: rad, world.
    """

    x: float
    y: float
    z: float
    yaw: float

    def matrix(self) -> Floats:
        """Return world_from_robot, (4, 4)."""
        return pose_matrix(self.x, self.y, self.z, self.yaw)


class GroundTruth:
    """Reads the soles, the robot frame and the torso's tilt from MuJoCo's data."""

    def __init__(self, model: mujoco.MjModel, robot: Robot) -> None:
        """Look names up once.

        Args:
            model: the compiled course with the robot in it.
            robot: the robot.
        """
        legs = (robot.file.legs.left, robot.file.legs.right)
        left, right = (int(model.body(leg.sole.link).id) for leg in legs)
        self.sole_bodies = (left, right)
        self._offsets = tuple(leg.sole.position for leg in legs)
        self.torso = int(model.body(robot.file.body.torso).id)
        self._up: list[float] = _upright_axis(robot).tolist()

    def soles(self, data: mujoco.MjData) -> tuple[Sole, Sole]:
        """Return the left and the right sole."""
        left, right = self.sole_bodies
        return _sole(data, left, self._offsets[0]), _sole(data, right, self._offsets[1])

    def frame(
        self, soles: tuple[Sole, Sole], touching: tuple[bool, bool] = (True, True)
    ) -> GroundFrame:
        """Return the robot frame.

        Args:
            soles: left and right.
            touching: which soles stand on something; the height is theirs, or the lower one's.
        """
        left, right = soles
        if touching[0] == touching[1]:
            z = (left.z + right.z) / 2 if touching[0] else min(left.z, right.z)
        else:
            z = left.z if touching[0] else right.z
        first = math.atan2(left.forward[1], left.forward[0])
        second = math.atan2(right.forward[1], right.forward[0])
        yaw = first + 0.5 * wrapped(second - first)
        return GroundFrame((left.x + right.x) / 2, (left.y + right.y) / 2, z, wrapped(yaw))

    def tilt(self, data: mujoco.MjData) -> float:
        """Return by how much the torso leans from upright, rad."""
        x, y, z = data.xmat[self.torso, 6:].tolist()
        up = x * self._up[0] + y * self._up[1] + z * self._up[2]
        return math.acos(min(1.0, max(-1.0, up)))


def wrapped(angle: float) -> float:
    """Return the same angle within (-pi, pi]."""
    return math.pi - (math.pi - angle) % (2 * math.pi)


def _sole(data: mujoco.MjData, body: int, offset: tuple[float, float, float]) -> Sole:
    r = data.xmat[body].tolist()
    p = data.xpos[body].tolist()
    a, b, c = offset
    return Sole(
        p[0] + r[0] * a + r[1] * b + r[2] * c,
        p[1] + r[3] * a + r[4] * b + r[5] * c,
        p[2] + r[6] * a + r[7] * b + r[8] * c,
        (r[0], r[3]),
    )


def _upright_axis(robot: Robot) -> Floats:
    """Return the torso's own direction that points up in the robot's upright stance, (3,)."""
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_kinematics(robot.nominal, data)
    torso = robot.nominal.body(robot.file.body.torso).id
    axis: Floats = data.xmat[torso].reshape(3, 3)[2].copy()
    return axis
