"""What the core is told of a robot, derived from the compiled MJCF and its `robot.toml`."""

import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.file import LegTable, RobotFile
from treadwell.robot.followers import ties
from treadwell.robot.motor_limits import MotorLimits

Floats = NDArray[np.float64]

OPTICAL_FROM_MUJOCO_CAMERA = np.array([0.0, 1.0, 0.0, 0.0])
"""Half a turn about x: MuJoCo's camera looks along -z with y up, the optical frame along z with
y down. Quaternion wxyz; its own inverse up to sign."""


def focal_length(file: RobotFile) -> float:
    """Return the camera's focal length in pixels, which are square.

    The mean of what the two fields of view give; `check_robot` refuses them if they disagree.
    """
    camera = file.camera
    horizontal = 0.5 * camera.width / math.tan(0.5 * camera.horizontal_fov)
    vertical = 0.5 * camera.height / math.tan(0.5 * camera.vertical_fov)
    return 0.5 * (horizontal + vertical)


def describe(
    name: str, model: mujoco.MjModel, file: RobotFile, stand: Floats, limits: MotorLimits
) -> dict[str, Any]:
    """Return the description of a robot as plain data.

    Args:
        name: the robot's name.
        model: the compiled MJCF, alone in an empty world.
        file: its `robot.toml`.
        stand: (n,) rad, joint angles of the upright stance, in joint order.
        limits: the motors, in joint order.
    """
    camera = file.camera
    site = model.site(file.imu.site).id
    camera_id = model.camera(camera.name).id
    optical = np.empty(4)
    mujoco.mju_mulQuat(optical, model.cam_quat[camera_id], OPTICAL_FROM_MUJOCO_CAMERA)
    return {
        "name": name,
        "links": [_link(model, body, limits) for body in range(1, model.nbody)],
        "joints": [model.joint(i).name for i in range(1, model.njnt)],
        "stand": stand.tolist(),
        "torso": file.body.torso,
        "legs": {"left": _leg(file.legs.left), "right": _leg(file.legs.right)},
        "head": file.head.model_dump(),
        "arms_rest": dict(file.arms.rest),
        "arms_raised": dict(file.arms.raised),
        "imu": {
            "link": model.body(model.site_bodyid[site]).name,
            "position": model.site_pos[site].tolist(),
            "orientation": model.site_quat[site].tolist(),
        },
        "camera": {
            "link": model.body(model.cam_bodyid[camera_id]).name,
            "position": model.cam_pos[camera_id].tolist(),
            "orientation": optical.tolist(),
            "width": camera.width,
            "height": camera.height,
            "focal": focal_length(file),
            "period": camera.period,
            "pool": camera.pool,
            "stereo": {
                "baseline": camera.triangulation.baseline,
                "window": camera.triangulation.window,
            },
        },
        "body": file.body.model_dump(exclude={"torso"}),
        "play": file.encoders.play,
        "gait": dict(file.gait),
    }


def _leg(leg: LegTable) -> dict[str, Any]:
    sole = leg.sole
    return {
        "joints": list(leg.joints),
        "sole": {
            "link": sole.link,
            "position": list(sole.position),
            "length": sole.length,
            "width": sole.width,
        },
        "sensors": None if leg.sensors is None else leg.sensors.model_dump(),
    }


def _link(model: mujoco.MjModel, body: int, limits: MotorLimits) -> dict[str, Any]:
    parent = int(model.body_parentid[body])
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, model.body_iquat[body])
    axes = rotation.reshape(3, 3)
    inertia = axes @ np.diag(model.body_inertia[body]) @ axes.T
    root = parent == 0
    return {
        "name": model.body(body).name,
        "parent": None if root else parent - 1,
        "position": [0.0, 0.0, 0.0] if root else model.body_pos[body].tolist(),
        "orientation": [1.0, 0.0, 0.0, 0.0] if root else model.body_quat[body].tolist(),
        "mass": float(model.body_mass[body]),
        "center_of_mass": model.body_ipos[body].tolist(),
        "inertia": [
            float(inertia[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        ],
        "joint": None if root else _joint(model, int(model.body_jntadr[body]), limits),
    }


def _joint(model: mujoco.MjModel, joint: int, limits: MotorLimits) -> dict[str, Any] | None:
    if joint < 0:
        return None
    order = joint - 1
    tie = ties(model).get(joint)
    return {
        "name": model.joint(joint).name,
        "axis": model.jnt_axis[joint].tolist(),
        "anchor": model.jnt_pos[joint].tolist(),
        "range": model.jnt_range[joint].tolist(),
        "peak_torque": float(limits.peak_torque[order]),
        "no_load_speed": float(limits.no_load_speed[order]),
        "kp": float(limits.kp[order]),
        "kv": float(limits.kv[order]),
        "follows": None if tie is None else model.joint(tie.leader).name,
        "ratio": 1.0 if tie is None else tie.ratio,
        "offset": 0.0 if tie is None else tie.offset,
    }
