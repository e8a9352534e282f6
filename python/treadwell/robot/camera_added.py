"""A depth camera put on a model that has none, fixed to a link or on a unit that pans and tilts."""

import math
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.robot.camera_file import MountTable
from treadwell.robot.file import RobotFile

PAN, TILT = "camera_pan", "camera_tilt"
"""Joints of the unit that turns an added camera."""
UNIT_KG = 0.05
"""Mass of each of the unit's two links."""
UNIT_RADIUS_M = 0.015
"""They have the inertia of balls of this size."""
PAN_RANGE, TILT_RANGE = (-1.6, 1.6), (-0.9, 1.2)
"""rad; a positive tilt looks down."""
ARMATURE = 0.002
"""Of the unit's motors, kg m²."""


def add_camera(spec: mujoco.MjSpec, file: RobotFile, toml: Path) -> None:
    """Add the camera of `[camera.mount]`, where there is one.

    Args:
        spec: changed.
        file: the parsed `robot.toml`.
        toml: its path, for messages.

    Raises:
        InputError: the model has a camera of that name, or lacks the link.
    """
    mount = file.camera.mount
    if mount is None:
        return
    if spec.camera(file.camera.name) is not None:
        raise InputError(
            f"{toml}: camera.mount: {file.robot.model} has a camera {file.camera.name!r}"
        )
    link = spec.body(mount.link)
    if link is None or link == spec.worldbody:
        raise InputError(f"{toml}: camera.mount.link: there is no link {mount.link!r} in the model")
    axes = np.array(mount.orientation) / np.linalg.norm(mount.orientation)
    place = np.array(mount.position)
    if mount.pan_tilt:
        link, place, axes = _unit(link, place, axes), np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    quat = np.empty(4)
    mujoco.mju_mulQuat(quat, axes, _looking_down(mount))
    fovy = math.degrees(file.camera.vertical_fov)
    link.add_camera(name=file.camera.name, pos=place, quat=quat, fovy=fovy)


def _looking_down(mount: MountTable) -> NDArray[np.float64]:
    """Return the camera's orientation in axes ahead, left and up.

    MuJoCo's camera looks along its -z with y up: x to the robot's right, then tipped down.
    """
    sin, cos = math.sin(mount.down), math.cos(mount.down)
    axes = np.array([[0.0, -1.0, 0.0], [sin, 0.0, cos], [-cos, 0.0, sin]])
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, axes.T.reshape(-1))
    return quat


def _unit(
    link: mujoco.MjsBody, place: NDArray[np.float64], axes: NDArray[np.float64]
) -> mujoco.MjsBody:
    """Add two small links that pan and tilt; return the one that carries the camera."""
    below = link.add_body(name="camera_pan_link", pos=place, quat=axes)
    _add_part(below, PAN, [0.0, 0.0, 1.0], PAN_RANGE)
    above = below.add_body(name="camera_tilt_link")
    _add_part(above, TILT, [0.0, 1.0, 0.0], TILT_RANGE)
    return above


def _add_part(
    body: mujoco.MjsBody, joint: str, axis: list[float], bounds: tuple[float, float]
) -> None:
    body.explicitinertial = True
    body.mass = UNIT_KG
    body.inertia = [0.4 * UNIT_KG * UNIT_RADIUS_M**2] * 3
    hinge = body.add_joint(name=joint, type=mujoco.mjtJoint.mjJNT_HINGE, axis=axis)
    hinge.range = bounds
    hinge.limited = mujoco.mjtLimited.mjLIMITED_TRUE
    hinge.armature = ARMATURE
