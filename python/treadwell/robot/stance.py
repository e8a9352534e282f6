"""A stance for a robot whose MJCF has none: on bent knees, the weight over the soles' middle."""

import mujoco
import numpy as np

from treadwell.robot.additions import STAND
from treadwell.robot.anatomy import Anatomy, FoundLeg

KNEE_RAD = 1.0
"""Bend of the knees in the stance."""


def stance(anatomy: Anatomy, legs: dict[str, FoundLeg]) -> dict[str, float]:
    """Return the joints' angles in the model's keyframe `stand`, or else in a guess, rad.

    Args:
        anatomy: of a model with a free root.
        legs: both, by their side.
    """
    model = anatomy.model
    names = [model.key(number).name for number in range(model.nkey)]
    if STAND in names:
        qpos = model.key(STAND).qpos
        return {model.joint(j).name: float(qpos[6 + j]) for j in range(1, model.njnt)}
    low, high, hip = -1.2, 0.3, 0.0
    for _ in range(40):
        hip = 0.5 * (low + high)
        data = posed(model, _bent(anatomy, legs, hip))
        soles = [_sole_x(data, leg) for leg in legs.values()]
        # The further the thighs are ahead, the further the soles.
        low, high = (low, hip) if data.subtree_com[1][0] > sum(soles) / 2 else (hip, high)
    return _bent(anatomy, legs, hip)


def posed(model: mujoco.MjModel, angles: dict[str, float]) -> mujoco.MjData:
    """Return the places of all bodies with the root upright at the origin, the rest at zero."""
    data = mujoco.MjData(model)
    data.qpos[:] = 0.0
    data.qpos[3] = 1.0
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return data


def axis_sign(anatomy: Anatomy, joint: str) -> float:
    """Return 1 where a joint turns about x, y or z ahead, left and up; -1 where against it."""
    axis = anatomy.axis(anatomy.model.joint(joint).id)
    return float(np.sign(axis[int(np.argmax(np.abs(axis)))]))


def _bent(anatomy: Anatomy, legs: dict[str, FoundLeg], hip: float) -> dict[str, float]:
    angles = {}
    for leg in legs.values():
        for slot, angle in ((2, hip), (3, KNEE_RAD), (4, -hip - KNEE_RAD)):
            angles[leg.joints[slot]] = round(angle * axis_sign(anatomy, leg.joints[slot]), 4)
    return angles


def _sole_x(data: mujoco.MjData, leg: FoundLeg) -> float:
    body = data.model.body(leg.foot).id
    offset = data.xmat[body].reshape(3, 3) @ np.array(leg.sole[0])
    return float(data.xpos[body][0] + offset[0])
