"""Joints without a motor of their own: an equality of the MJCF ties each to one that has one."""

import mujoco
import numpy as np

SAME_ANGLE = (0.0, 1.0, 0.0, 0.0, 0.0)
"""Coefficients of the polynomial that says: as the other joint."""


def followers(model: mujoco.MjModel) -> dict[int, int]:
    """Return the joint that each follower is tied to, both by their numbers in the model.

    Args:
        model: a compiled MJCF whose equalities `check_robot` accepts.
    """
    kind = mujoco.mjtEq.mjEQ_JOINT
    ties = [i for i in range(model.neq) if model.eq_type[i] == kind]
    return {int(model.eq_obj1id[i]): int(model.eq_obj2id[i]) for i in ties}


def is_tie(model: mujoco.MjModel, equality: int) -> bool:
    """Whether an equality only says that one joint has the angle of another."""
    same: bool = np.array_equal(model.eq_data[equality, : len(SAME_ANGLE)], SAME_ANGLE)
    return (
        bool(model.eq_active0[equality])
        and model.eq_type[equality] == mujoco.mjtEq.mjEQ_JOINT
        and model.eq_obj2id[equality] >= 0
        and same
    )
