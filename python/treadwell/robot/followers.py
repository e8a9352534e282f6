"""Joints without a motor of their own: an equality of the MJCF ties each to one that has one."""

from typing import NamedTuple

import mujoco
import numpy as np


class Tie(NamedTuple):
    """How a joint follows the one whose motor turns it, by gears or rods.

    Attributes:
        leader: that joint.
        ratio: how far the follower turns for each radian of the leader.
        offset: rad, the follower's angle where the leader's is 0.
    """

    leader: int
    ratio: float = 1.0
    offset: float = 0.0


def ties(model: mujoco.MjModel) -> dict[int, Tie]:
    """Return how each follower is tied; it and its leader by their numbers in the model.

    Args:
        model: a compiled MJCF whose equalities `check_robot` accepts.
    """
    return {
        int(model.eq_obj1id[i]): Tie(
            int(model.eq_obj2id[i]), float(model.eq_data[i, 1]), float(model.eq_data[i, 0])
        )
        for i in range(model.neq)
        if is_tie(model, i)
    }


def followers(model: mujoco.MjModel) -> dict[int, int]:
    """Return the joint that each follower is tied to, both by their numbers in the model.

    Args:
        model: a compiled MJCF whose equalities `check_robot` accepts.
    """
    return {follower: tie.leader for follower, tie in ties(model).items()}


def is_tie(model: mujoco.MjModel, equality: int) -> bool:
    """Whether an equality says that the angle of one joint follows from another's, by a gear."""
    offset, ratio, *bent = model.eq_data[equality, :5]
    return (
        bool(model.eq_active0[equality])
        and model.eq_type[equality] == mujoco.mjtEq.mjEQ_JOINT
        and model.eq_obj2id[equality] >= 0
        and bool(np.isfinite(offset))
        and bool(np.isfinite(ratio))
        and ratio != 0.0
        and not np.any(bent)
    )
