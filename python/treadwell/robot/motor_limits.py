"""What the motors of a robot can do, as arrays by its joint order."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.robot.followers import Tie

Floats = NDArray[np.float64]

LEAST_SHARE: Final = 0.1
"""Of all that a joint moves, what turns with its motor at least: a model may say no armature."""


@dataclass(frozen=True, slots=True, eq=False)
class MotorLimits:
    """What the motors are; arrays by the robot's joint order.

    Attributes:
        kp: (n,) N·m/rad, stiffness of the servo.
        kv: (n,) N·m·s/rad, damping of the servo.
        peak_torque: (n,) N·m, never exceeded.
        stall_torque: (n,) N·m, where the torque-speed line starts; at or above the peak.
        no_load_speed: (n,) rad/s, where the line ends.
        friction: (n,) N·m, dry friction of motor, gear and joint.
        inertia: (n,) kg·m², what turns with the motor: friction stops as much within a step.
    """

    kp: Floats
    kv: Floats
    peak_torque: Floats
    stall_torque: Floats
    no_load_speed: Floats
    friction: Floats
    inertia: Floats


def rotors(
    armature: Floats, joint_inertia: Floats, friction: Floats, tied: Mapping[int, Tie]
) -> tuple[Floats, Floats]:
    """Return what turns with each motor, (n,) kg·m², and the dry friction on it, (n,) N·m.

    The friction of a joint without a motor, and what turns with it, are its leader's.

    Args:
        armature: (n,) kg·m², the motor's inertia at its joint, as the model has it.
        joint_inertia: (n,) kg·m², all that the joint moves.
        friction: (n,) N·m.
        tied: joints without a motor, each with how it follows the one whose motor turns it too.
    """
    inertia = np.maximum(armature, LEAST_SHARE * joint_inertia)
    friction = friction.copy()
    for follower, tie in tied.items():
        for array, share in ((inertia, tie.ratio**2), (friction, abs(tie.ratio))):
            array[tie.leader] += share * array[follower]
            array[follower] = 0.0
    return inertia, friction
