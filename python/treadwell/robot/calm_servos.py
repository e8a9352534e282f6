"""Damping of servos that act together on light links: bounded so that none of them shakes."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STEP_S = 0.002
MOST = 0.8
"""Of the speed of a free motion, what all servos together take away in a physics step at most."""
ROUNDS = 300


def calmed(
    model: mujoco.MjModel,
    qpos: Floats,
    dampings: Mapping[int, float],
    armatures: Mapping[int, float],
) -> dict[int, float]:
    """Return dampings that are no larger, with which no motion of the robot is overdone in a step.

    A servo's torque is held for a step. Where what it moves is light, as a pelvis between three
    joints is, a large damping turns the motion round instead of ending it. Of the motion that is
    braked most, each joint gives up as much as it has a share in it.

    Args:
        model: the compiled model.
        qpos: a posture.
        dampings: N m s/rad, by the joint's number.
        armatures: kg m², of joints that get another one than the model's.
    """
    joints = list(dampings)
    dofs = np.array([int(model.jnt_dofadr[joint]) for joint in joints])
    inverse = _inverse_inertia(model, qpos, armatures)[np.ix_(dofs, dofs)]
    found = np.array([dampings[joint] for joint in joints])
    for _ in range(ROUNDS):
        root = np.sqrt(found)
        taken, motions = np.linalg.eigh(STEP_S * root[:, None] * inverse * root)
        if taken[-1] <= MOST:
            break
        found = found * (1.0 - motions[:, -1] ** 2 * (1.0 - MOST / taken[-1]))
    return {joint: float(value) for joint, value in zip(joints, found, strict=True)}


def _inverse_inertia(model: mujoco.MjModel, qpos: Floats, armatures: Mapping[int, float]) -> Floats:
    """Return (nv, nv) the inverse of the inertia of the free robot in a posture."""
    before = model.dof_armature.copy()
    for joint, armature in armatures.items():
        model.dof_armature[model.jnt_dofadr[joint]] = armature
    try:
        data = mujoco.MjData(model)
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        inverse = np.zeros((model.nv, model.nv))
        mujoco.mj_solveM(model, data, inverse, np.eye(model.nv))
    finally:
        model.dof_armature[:] = before
    return inverse
