"""What the motors of the legs bear when a robot stands still on one leg: statics, nothing moves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Load:
    """What a joint bears.

    Attributes:
        joint: its name.
        torque_nm: that it takes to hold still.
        share: of its motor's peak torque.
    """

    joint: str
    torque_nm: float
    share: float


def load_on(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    joints: Sequence[str],
    sole: tuple[str, Floats],
    peaks: Mapping[str, float],
) -> list[Load]:
    """Return what each joint of a leg bears when all the weight is on its sole.

    The weight is taken to act where the centre of mass would be over the sole: the robot leans over
    it, which turns its hip and ankle little.

    Args:
        model: alone in an empty world.
        data: the stance; velocities are set to zero, and forces are computed.
        joints: of the leg.
        sole: its link, and its centre in that link's frame, m.
        peaks: peak torques, N m, by joint.
    """
    data.qvel[:] = 0.0
    mujoco.mj_forward(model, data)
    link = model.body(sole[0]).id
    place = data.xpos[link] + data.xmat[link].reshape(3, 3) @ sole[1]
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, place, link)
    weight = float(model.body_subtreemass[0]) * -float(model.opt.gravity[2])
    torques = data.qfrc_bias - weight * jacobian[2]
    found = []
    for name in joints:
        torque = abs(float(torques[model.joint(name).dofadr[0]]))
        found.append(Load(name, torque, torque / max(peaks[name], 1e-9)))
    return found
