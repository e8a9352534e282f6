"""What each joint of a leg does, by geometry: never by its name, its place, or its number."""

from collections.abc import Sequence
from itertools import permutations

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HIP_YAW, HIP_ROLL, HIP_PITCH, KNEE = "hip yaw", "hip roll", "hip pitch", "knee"
ANKLE_PITCH, ANKLE_ROLL, ANKLE_YAW = "ankle pitch", "ankle roll", "ankle yaw"
TURN_RAD = 1.0
"""By how much a joint is turned to see whether it makes the leg shorter."""
LEAST_CHANGE = 0.05
"""Of the leg's length, what a knee changes at least."""
DISTANCE_ROUNDED = 6


def roles(data: mujoco.MjData, joints: Sequence[int], sole: Floats, forward: Floats) -> list[str]:
    """Return what each joint of a leg does, in the order of the joints.

    The knee is the joint that changes the distance between hip and sole most. Of those above it
    and of those below it, each turns about one of the axes up, ahead and across: the choice in
    which the axes fit best. A leg of seven joints has two of one kind on one side of the knee: the
    one that fits less is called as the other, with "second" before it.

    Args:
        data: the posture, its kinematics up to date; nothing in it is changed.
        joints: numbers of the hinges from the hip down.
        sole: (3,) m, the sole's centre in the world.
        forward: (3,) where the robot looks to, level.
    """
    knee = _knee(data, joints, sole)
    across = np.cross([0.0, 0.0, 1.0], forward)
    up = np.array([0.0, 0.0, 1.0])
    hips, ankles = joints[:knee], joints[knee + 1 :]
    hip = _kinds(data, hips, [up, forward, across], [HIP_YAW, HIP_ROLL, HIP_PITCH])
    ankle = _kinds(data, ankles, [across, forward, up], [ANKLE_PITCH, ANKLE_ROLL, ANKLE_YAW])
    return [*hip, KNEE, *ankle]


def nearest_to_axes(data: mujoco.MjData, joints: Sequence[int]) -> Floats:
    """Return the place (3,) that is nearest to the axes of joints, m: of a hip's, its centre."""
    chosen = list(joints)
    anchors, axes = data.xanchor[chosen], data.xaxis[chosen]
    across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    # Axes that are parallel leave a direction open: there it is at the mean of the anchors.
    weak = 1e-9 * np.eye(3)
    right = np.einsum("nij,nj->i", across, anchors) + weak @ anchors.mean(axis=0)
    place: Floats = np.linalg.solve(across.sum(axis=0) + weak, right)
    return place


def _knee(data: mujoco.MjData, joints: Sequence[int], sole: Floats) -> int:
    """Return the place among the joints of the one that changes the leg's length most."""
    hip = data.xanchor[joints[0]]
    length = float(np.linalg.norm(sole - hip))
    changes = []
    for joint in joints:
        anchor, axis = data.xanchor[joint], data.xaxis[joint]
        turned = [_turned(sole - anchor, axis, sign * TURN_RAD) + anchor for sign in (-1.0, 1.0)]
        changes.append(max(abs(float(np.linalg.norm(t - hip)) - length) for t in turned))
    return int(np.argmax(np.round(changes, DISTANCE_ROUNDED)))


def shortens(data: mujoco.MjData, joints: Sequence[int], sole: Floats) -> float:
    """Return by which share of its length a leg's knee can make it shorter or longer."""
    joint, hip = joints[_knee(data, joints, sole)], data.xanchor[joints[0]]
    length = float(np.linalg.norm(sole - hip))
    anchor, axis = data.xanchor[joint], data.xaxis[joint]
    turned = [_turned(sole - anchor, axis, sign * TURN_RAD) + anchor for sign in (-1.0, 1.0)]
    return max(abs(float(np.linalg.norm(t - hip)) - length) for t in turned) / max(length, 1e-9)


def _turned(vector: Floats, axis: Floats, angle: float) -> Floats:
    """Return a vector turned about a unit axis."""
    along = axis * float(axis @ vector)
    result: Floats = (
        along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)
    )
    return result


def _kinds(
    data: mujoco.MjData, joints: Sequence[int], axes: Sequence[Floats], names: Sequence[str]
) -> list[str]:
    """Return a name for each joint: of the axis that is its, as all together fit best."""
    axes, names = list(axes), list(names)
    while len(axes) < len(joints):
        axes, names = [*axes, *axes], [*names, *(f"second {name}" for name in names)]
    fits = np.array([[abs(float(data.xaxis[j] @ axis)) for axis in axes] for j in joints])
    choices = permutations(range(len(axes)), len(joints))
    best = max(choices, key=lambda chosen: sum(fits[i, k] ** 2 for i, k in enumerate(chosen)))
    return [names[k] for k in best]
