"""Where a robot's root is when its soles stand at a place: the one answer to where a robot is.

A robot stands where its soles are. Its root may be ahead of them or behind, as the model has it.
"""

from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from treadwell.robot.load import Robot

ROOT: Final = 7
"""Numbers of a root's pose: x, y, z and a quaternion."""


def standing_root(
    robot: "Robot", place: tuple[float, float, float], yaw: float
) -> NDArray[np.float64]:
    """Return the root's pose (7,), m and wxyz, with the robot standing as in its keyframe.

    Args:
        robot: the robot.
        place: world x, y, z of the middle between its soles, m.
        yaw: where its soles point, rad.
    """
    nominal = robot.nominal
    data = mujoco.MjData(nominal)
    data.qpos[:] = robot.stand_qpos
    mujoco.mj_kinematics(nominal, data)
    centres, forward = np.zeros(3), np.zeros(3)
    for leg in (robot.file.legs.left, robot.file.legs.right):
        link = nominal.body(leg.sole.link).id
        rotation = data.xmat[link].reshape(3, 3)
        centres += 0.5 * (data.xpos[link] + rotation @ np.array(leg.sole.position))
        forward += rotation[:, 0]
    turn = yaw - np.arctan2(forward[1], forward[0])
    quat, rotation, root = np.empty(4), np.empty(9), robot.stand_qpos
    mujoco.mju_axisAngle2Quat(quat, np.array([0.0, 0.0, 1.0]), turn)
    mujoco.mju_quat2Mat(rotation, quat)
    pose = np.empty(ROOT)
    pose[:3] = rotation.reshape(3, 3) @ (root[:3] - centres)
    pose[:3] += place
    turned = np.empty(4)
    mujoco.mju_mulQuat(turned, quat, root[3:ROOT])
    pose[3:] = turned
    return pose
