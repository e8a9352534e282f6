"""Where the robot truly is: its soles and its frame on the ground, read from the simulator."""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import TrueStance
from treadwell.poses import pose_matrix
from treadwell.robot.load import Robot
from treadwell.trace import Sole

Floats = NDArray[np.float64]


class GroundFrame(NamedTuple):
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
        self.torso = int(model.body(robot.file.body.torso).id)
        soles = [
            (body, leg.sole.position) for body, leg in zip(self.sole_bodies, legs, strict=True)
        ]
        self._stance = TrueStance(soles, self.torso, _upright_axis(robot).tolist())

    def look(self, data: mujoco.MjData) -> tuple[tuple[Sole, Sole], float]:
        """Return the left and the right sole, and by how much the torso leans from upright, rad."""
        left, right, tilt = self._stance.look(data)
        # What `Sole._make` does, in a third of its time.
        return (tuple.__new__(Sole, left), tuple.__new__(Sole, right)), tilt

    def soles(self, data: mujoco.MjData) -> tuple[Sole, Sole]:
        """Return the left and the right sole."""
        return self.look(data)[0]

    def frame(
        self, soles: tuple[Sole, Sole], touching: tuple[bool, bool] = (True, True)
    ) -> GroundFrame:
        """Return the robot frame.

        Args:
            soles: left and right.
            touching: which soles stand on something; the height is theirs, or the lower one's.
        """
        (left_x, left_y, left_z, left), (right_x, right_y, right_z, right) = soles
        if touching[0] == touching[1]:
            z = (left_z + right_z) / 2 if touching[0] else min(left_z, right_z)
        else:
            z = left_z if touching[0] else right_z
        first = math.atan2(left[1], left[0])
        second = math.atan2(right[1], right[0])
        yaw = wrapped(first + 0.5 * wrapped(second - first))
        middle = ((left_x + right_x) / 2, (left_y + right_y) / 2, z, yaw)
        return tuple.__new__(GroundFrame, middle)

    def tilt(self, data: mujoco.MjData) -> float:
        """Return by how much the torso leans from upright, rad."""
        return self.look(data)[1]


def wrapped(angle: float) -> float:
    """Return the same angle within (-pi, pi]."""
    return math.pi - (math.pi - angle) % math.tau


def _upright_axis(robot: Robot) -> Floats:
    """Return the torso's own direction that points up in the robot's upright stance, (3,)."""
    data = mujoco.MjData(robot.nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_kinematics(robot.nominal, data)
    torso = robot.nominal.body(robot.file.body.torso).id
    axis: Floats = data.xmat[torso].reshape(3, 3)[2].copy()
    return axis
