"""The error of the camera's pose: how far it looks from where the robot's joints say."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.senses.depth import MUJOCO_FROM_OPTICAL, Mount

Floats = NDArray[np.float64]

SAME_AXIS = 0.2
"""Sine of the angle from the plane of the neck's axes within which a trunk's joint turns alike."""


@dataclass(frozen=True)
class CameraErrorBounds:
    """How wrong the camera's pose may be; each value is drawn uniformly within its bound.

    Attributes:
        roll_pitch: rad, about the robot's forward and left axes.
        yaw: rad, about the vertical axis.
        position: metres, in any direction.
    """

    roll_pitch: float
    yaw: float
    position: float


@dataclass(frozen=True)
class CameraError:
    """One episode's error of the camera's pose.

    Attributes:
        offsets: rad, what the encoder of each joint given reads too much.
        mount: what no joint of the chain can explain; the core is not told either.
    """

    offsets: Floats
    mount: Mount


def rotation_of(roll: float, pitch: float, yaw: float) -> Floats:
    """Return the rotation (3, 3) about x by roll, then y by pitch, then z by yaw."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x, np.float64)


def draw_camera_error(
    model: mujoco.MjModel,
    camera: str,
    joints: Sequence[str],
    weights: Sequence[float],
    bounds: CameraErrorBounds,
    rng: np.random.Generator,
) -> CameraError:
    """Draw an error and share it between the joints' encoders and the mounting.

    The pose that the joints' readings give for the camera is the true one turned by the drawn
    angles and shifted by the drawn vector, in the model's first keyframe (zero pose without one),
    seen from the robot's base. The joints take what their axes allow, the mounting the rest.

    Args:
        model: the compiled world with the robot.
        camera: name of the camera.
        joints: hinges between the robot's base and the camera whose encoders may be wrong.
        weights: for each of them, how much of what several could take it takes.
        bounds: how wrong the pose may be.
        rng: where the error is drawn from.
    """
    roll, pitch = rng.uniform(-bounds.roll_pitch, bounds.roll_pitch, 2)
    yaw = rng.uniform(-bounds.yaw, bounds.yaw)
    direction = rng.standard_normal(3)
    shift = direction / np.linalg.norm(direction) * rng.uniform(0.0, bounds.position)

    data = mujoco.MjData(model)
    if model.nkey > 0:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    position, rotation, axes, base = _posture(model, data, camera, joints)
    turn = base @ rotation_of(roll, pitch, yaw) @ base.T
    shift = base @ shift

    wanted = np.empty(3)
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, turn.reshape(-1))
    mujoco.mju_quat2Vel(wanted, quaternion, 1.0)
    taking = np.diag(np.asarray(weights, np.float64))
    offsets = taking @ axes.T @ np.linalg.pinv(axes @ taking @ axes.T, rcond=1e-6) @ wanted

    for joint, offset in zip(joints, offsets, strict=True):
        data.qpos[model.jnt_qposadr[model.joint(joint).id]] += offset
    read_position, read_rotation, _, _ = _posture(model, data, camera, joints)
    mount = Mount(
        rotation=rotation.T @ turn.T @ read_rotation,
        translation=rotation.T @ (read_position - shift - position),
    )
    return CameraError(offsets, mount)


def turning_as(
    model: mujoco.MjModel, camera: str, trunk: Sequence[str], neck: Sequence[str]
) -> tuple[str, ...]:
    """Return the joints of the trunk that turn the camera as those of the neck can, too.

    Where no joint of the neck turns it so, the camera's error is none of the trunk's encoders: the
    robot stands by these, and they are set as well as the legs'.
    """
    data = mujoco.MjData(model)
    if model.nkey > 0:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    _, _, of_trunk, _ = _posture(model, data, camera, trunk)
    _, _, of_neck, _ = _posture(model, data, camera, neck)
    beside = of_trunk - of_neck @ np.linalg.pinv(of_neck) @ of_trunk
    apart = np.linalg.norm(beside, axis=0)
    return tuple(joint for joint, far in zip(trunk, apart, strict=True) if far < SAME_AXIS)


def _posture(
    model: mujoco.MjModel, data: mujoco.MjData, camera: str, joints: Sequence[str]
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the camera's position and optical rotation, the joints' axes (3, n), the base's."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_camlight(model, data)
    at = model.camera(camera).id
    rotation = data.cam_xmat[at].reshape(3, 3) @ MUJOCO_FROM_OPTICAL
    ids = [model.joint(joint).id for joint in joints]
    axes = np.array([data.xaxis[i] for i in ids]).reshape(-1, 3).T
    root = model.body_rootid[model.cam_bodyid[at]]
    return data.cam_xpos[at].copy(), rotation, axes, data.xmat[root].reshape(3, 3).copy()
