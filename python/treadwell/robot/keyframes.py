"""What keyframes of an MJCF say of how the robot stands."""

from collections.abc import Mapping

import mujoco
import numpy as np

from treadwell.robot.anatomy import FoundLeg, place_of
from treadwell.robot.joint_roles import KNEE

STAND = "stand"
"""Name of the keyframe in which the robot stands upright."""
PREFERRED = (STAND, "home")
"""Keyframes that are looked at first for how the arms are held."""
BENT_RAD = 0.3
"""A knee that is bent less is no stance to walk from."""
LEVEL = 1e-3
"""How far soles may be from the ground, m, and from level, rad."""
AHEAD_M = 0.03
"""How far the soles' middle may be from under the centre of mass, times a leg of a metre."""


def names_of(model: mujoco.MjModel) -> list[str]:
    """Return the names of a model's keyframes."""
    return [model.key(number).name for number in range(model.nkey)]


def stands_well(model: mujoco.MjModel, legs: Mapping[str, FoundLeg]) -> bool:
    """Whether the keyframe `stand` is one to walk from: knees bent, soles flat on the ground."""
    if STAND not in names_of(model):
        return False
    data = mujoco.MjData(model)
    data.qpos[:] = model.key(STAND).qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    ahead = []
    for leg in legs.values():
        knee = leg.joint(KNEE)
        bent = knee is not None and abs(float(data.joint(knee).qpos[0])) > BENT_RAD
        link = model.body(leg.foot).id
        rotation = data.xmat[link].reshape(3, 3)
        place = place_of(data, link, leg.sole)
        level = leg.sole.orientation is None and float(np.hypot(*rotation[2, :2])) < LEVEL
        if not (bent and level and abs(float(place[2])) < LEVEL):
            return False
        ahead.append(float(place[0]))
    return abs(float(data.subtree_com[1][0]) - sum(ahead) / len(ahead)) < AHEAD_M


def arms_of_keyframes(model: mujoco.MjModel, but: set[str]) -> dict[str, float]:
    """Return the angles of joints that a keyframe holds away from zero, rad.

    Args:
        model: the compiled model.
        but: joints that do not count, those of the legs.
    """
    names = names_of(model)
    order = [name for name in PREFERRED if name in names]
    for name in order:
        qpos = model.key(name).qpos
        found = {}
        for joint in range(1, model.njnt):
            angle = float(qpos[model.jnt_qposadr[joint]])
            if model.joint(joint).name not in but and abs(angle) > 1e-9:
                low, high = model.jnt_range[joint]
                inside = min(max(angle, float(low)), float(high))
                found[model.joint(joint).name] = inside if model.jnt_limited[joint] else angle
        if found:
            return found
    return {}
