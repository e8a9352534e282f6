"""Joints without a motor that others move: by gears, and by rods that close a loop."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SAMPLES = 15
"""Angles of the driving joint at which a loop is closed."""
STEPS = 40
CLOSED_M = 1e-6
"""A loop whose ends are nearer than this is closed."""
STRAIGHT_RAD = 0.02
"""By how much a joint may part from a line over the angles of the one that drives it."""
MOST_RAD = 1.2
"""How far from zero the driving joint is turned at most."""


@dataclass(frozen=True, slots=True)
class Tie:
    """A joint that has the angle `offset + ratio * leader`.

    Attributes:
        leader: number of the joint whose motor turns it.
        ratio: of the angles.
        offset: rad.
        loop: whether rods do it, not a gear.
    """

    leader: int
    ratio: float
    offset: float
    loop: bool = False


def drivers(model: mujoco.MjModel) -> set[int]:
    """Return the hinges that have a motor, or could: all that are not tied where none has one."""
    kinds = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    hinge = mujoco.mjtJoint.mjJNT_HINGE
    hinges = {joint for joint in range(model.njnt) if model.jnt_type[joint] == hinge}
    driven = {
        int(model.actuator_trnid[number, 0])
        for number in range(model.nu)
        if int(model.actuator_trntype[number]) in kinds
    }
    return hinges & driven or hinges - {one for one, *_ in _equalities(model)}


def ties_of(model: mujoco.MjModel, motors: set[int] | None = None) -> dict[int, Tie]:
    """Return what each joint without a motor follows, by gears and by loops.

    Args:
        model: the compiled model.
        motors: joints that have one; default: `drivers`.
    """
    motors = drivers(model) if motors is None else motors
    gears = _gears(model, motors)
    return gears | loop_ties(model, motors, gears)


def _equalities(model: mujoco.MjModel) -> list[tuple[int, int, float, float]]:
    """Return (joint1, joint2, ratio, offset) of the linear ties of two joints."""
    found = []
    for number in range(model.neq):
        joint = model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT and model.eq_active0[number]
        if joint and model.eq_obj2id[number] >= 0 and not model.eq_data[number, 2:5].any():
            offset, ratio = (float(value) for value in model.eq_data[number, :2])
            found.append(
                (int(model.eq_obj1id[number]), int(model.eq_obj2id[number]), ratio, offset)
            )
    return found


def _gears(model: mujoco.MjModel, motors: set[int]) -> dict[int, Tie]:
    """Return what is tied to a motor's joint by equalities, however many are between."""
    known = {motor: Tie(motor, 1.0, 0.0) for motor in motors}
    left = _equalities(model)
    while left:
        waiting = []
        for one, other, ratio, offset in left:
            if other in known and one not in known:
                tie = known[other]
                known[one] = Tie(tie.leader, ratio * tie.ratio, offset + ratio * tie.offset)
            elif one in known and other not in known and ratio != 0.0:
                tie = known[one]
                known[other] = Tie(tie.leader, tie.ratio / ratio, (tie.offset - offset) / ratio)
            else:
                waiting.append((one, other, ratio, offset))
        if len(waiting) == len(left):
            break
        left = waiting
    return {joint: tie for joint, tie in known.items() if joint not in motors}


def connects(model: mujoco.MjModel) -> list[int]:
    """Return the equalities that hold two links at one point."""
    kind = mujoco.mjtEq.mjEQ_CONNECT
    return [n for n in range(model.neq) if model.eq_type[n] == kind and model.eq_active0[n]]


def loop_ties(model: mujoco.MjModel, motors: set[int], gears: dict[int, Tie]) -> dict[int, Tie]:
    """Return what the joints follow that are part of a closed loop with one motor.

    The motor's joint is turned, the loop closed at each angle, and a line fitted: what parts from
    a line is left as it is.

    Args:
        model: the compiled model.
        motors: joints that have one.
        gears: what others follow by gears.
    """
    if not connects(model):
        return {}
    data = mujoco.MjData(model)
    model_flags = int(model.opt.disableflags)
    model.opt.disableflags = model_flags | int(
        mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    )
    try:
        found: dict[int, Tie] = {}
        for joints in _loops(model, data):
            passive = sorted(joints - motors - set(gears))
            leaders = sorted(joints & motors)
            if len(leaders) == 1 and passive:
                found |= _fitted(model, data, leaders[0], passive)
        return found
    finally:
        model.opt.disableflags = model_flags


def _rows(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Floats, Floats, NDArray[np.int32]]:
    """Return of the connects' rows errors (n,) m, Jacobian (n, nv), and of which each is."""
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_makeConstraint(model, data)
    kinds = np.array(data.efc_type[: data.nefc])
    identity = np.array(data.efc_id[: data.nefc])
    wanted = (kinds == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)) & np.isin(
        identity, connects(model)
    )
    jacobian = np.zeros((data.nefc, model.nv))
    if mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(
            jacobian, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind
        )
    else:
        jacobian[:] = np.array(data.efc_J).reshape(data.nefc, model.nv)
    return np.array(data.efc_pos[: data.nefc])[wanted], jacobian[wanted], identity[wanted]


def _loops(model: mujoco.MjModel, data: mujoco.MjData) -> list[set[int]]:
    """Return the joints that belong together by connects that share a joint."""
    data.qpos[:] = model.qpos0
    _, jacobian, identity = _rows(model, data)
    found: list[set[int]] = []
    for equality in connects(model):
        moves = np.abs(jacobian[identity == equality]).max(axis=0, initial=0.0) > 1e-9
        joints = {
            joint
            for joint in range(model.njnt)
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
            and moves[model.jnt_dofadr[joint]]
        }
        for other in [loop for loop in found if loop & joints]:
            found.remove(other)
            joints |= other
        found.append(joints)
    return found


def _fitted(
    model: mujoco.MjModel, data: mujoco.MjData, leader: int, passive: list[int]
) -> dict[int, Tie]:
    """Return the lines that passive joints follow over the angles of their leader."""
    low, high = -MOST_RAD, MOST_RAD
    if model.jnt_limited[leader]:
        low, high = max(low, model.jnt_range[leader, 0]), min(high, model.jnt_range[leader, 1])
    middle = min(max(0.0, low), high)
    angles: list[float] = []
    places: list[Floats] = []
    for end in (low, high):
        data.qpos[:] = model.qpos0
        for angle in np.linspace(middle, end, SAMPLES):
            data.qpos[model.jnt_qposadr[leader]] = angle
            if not _close(model, data, passive):
                return {}
            angles.append(float(angle))
            places.append(data.qpos[model.jnt_qposadr[passive]].copy())
    found = {}
    for column, joint in enumerate(passive):
        values = np.array([place[column] for place in places])
        ratio, offset = np.polyfit(angles, values, 1)
        if np.abs(values - offset - ratio * np.array(angles)).max() > STRAIGHT_RAD:
            return {}
        ratio, offset = float(np.round(ratio, 6)) + 0.0, float(np.round(offset, 6)) + 0.0
        found[joint] = Tie(leader, ratio, offset, loop=True)
    return found


def _close(model: mujoco.MjModel, data: mujoco.MjData, passive: list[int]) -> bool:
    """Turn passive joints until the loops are closed; whether they are."""
    dofs, places = model.jnt_dofadr[passive], model.jnt_qposadr[passive]
    for _ in range(STEPS):
        errors, jacobian, _ = _rows(model, data)
        moving = np.abs(jacobian[:, dofs]).max(axis=1) > 1e-9
        errors, rows = errors[moving], jacobian[moving][:, dofs]
        if np.abs(errors).max(initial=0.0) < CLOSED_M:
            return True
        step = np.linalg.lstsq(rows, -errors, rcond=1e-6)[0]
        data.qpos[places] += step * min(1.0, 0.3 / max(float(np.abs(step).max()), 1e-12))
    return False
