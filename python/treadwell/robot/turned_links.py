"""Axes of a foot's link turned to ahead, left and up: what it is made of stays where it is."""

from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.robot.file import LegTable

Floats = NDArray[np.float64]


def turn_foot(spec: mujoco.MjSpec, leg: LegTable, key: str, toml: Path) -> None:
    """Turn the axes of a foot's link by `orientation` of its sole, if that has one.

    Args:
        spec: changed.
        leg: of `robot.toml`.
        key: the leg's table, for messages.
        toml: path of the file, for messages.

    Raises:
        InputError: the link is made in a way that cannot be turned.
    """
    turned = leg.sole.orientation
    body = spec.body(leg.sole.link)
    if turned is None or body is None:
        return
    quat = np.array(turned) / np.linalg.norm(turned)
    back = quat * (1.0, -1.0, -1.0, -1.0)
    if _anchors(spec, leg.sole.link):
        raise InputError(
            f"{toml}: {key}.sole.orientation: an equality holds link {leg.sole.link!r} at a point "
            "of its own: turn its axes in the model"
        )
    parts = [*body.geoms, *body.sites, *body.cameras, *body.lights, *body.joints, *body.bodies]
    # What is in a <frame> turns with that.
    parts = [part for part in [*parts, *body.frames] if getattr(part, "frame", None) is None]
    for part in parts:
        _turn_part(spec, part, back)
    _turn_inertia(spec, body, back)
    body.quat = _product(_quat(spec, body.quat, body.alt), quat)
    body.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT


def _anchors(spec: mujoco.MjSpec, link: str) -> bool:
    """Whether an equality holds a link at a point, or welds it."""
    kinds = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)
    return any(
        equality.type in kinds and link in (equality.name1, equality.name2)
        for equality in spec.equalities
    )


def _turn_part(spec: mujoco.MjSpec, part: object, back: Floats) -> None:
    """Tell a part of a link where it is in axes that were turned."""
    part.pos = _turned(back, part.pos)  # type: ignore[attr-defined]
    if hasattr(part, "axis"):
        part.axis = _turned(back, part.axis)
    if hasattr(part, "dir"):
        part.dir = _turned(back, part.dir)
    if hasattr(part, "fromto") and not np.isnan(part.fromto[0]):
        ends = np.array(part.fromto)
        part.fromto = np.concatenate([_turned(back, ends[:3]), _turned(back, ends[3:])])
    if hasattr(part, "quat"):
        part.quat = _product(back, _quat(spec, part.quat, part.alt))  # type: ignore[attr-defined]
        part.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT  # type: ignore[attr-defined]


def _turn_inertia(spec: mujoco.MjSpec, body: mujoco.MjsBody, back: Floats) -> None:
    if not body.explicitinertial:
        return
    body.ipos = _turned(back, body.ipos)
    if not np.isnan(body.fullinertia[0]):
        xx, yy, zz, xy, xz, yz = body.fullinertia
        full = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, back)
        axes = rotation.reshape(3, 3)
        full = axes @ full @ axes.T
        body.fullinertia = [full[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        return
    body.iquat = _product(back, _quat(spec, body.iquat, body.ialt))
    body.ialt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT


def _quat(spec: mujoco.MjSpec, quat: Floats, other: mujoco.MjsOrientation) -> Floats:
    """Return an orientation as a quaternion, however the model says it."""
    if other.type == mujoco.mjtOrientation.mjORIENTATION_QUAT:
        return np.array(quat)
    compiler = spec.compiler
    return np.array(
        spec.resolve_orientation(
            degree=compiler.degree, sequence=compiler.eulerseq, orientation=other
        )
    )


def _turned(quat: Floats, vector: Floats) -> Floats:
    result = np.empty(3)
    mujoco.mju_rotVecQuat(result, np.array(vector, np.float64), quat)
    return result


def _product(one: Floats, other: Floats) -> Floats:
    result = np.empty(4)
    mujoco.mju_mulQuat(result, one, np.array(other, np.float64))
    return result
