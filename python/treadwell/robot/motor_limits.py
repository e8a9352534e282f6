"""What the motors of a robot can do, as arrays by its joint order."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class MotorLimits:
    """What the motors are; arrays by the robot's joint order.

    Attributes:
        kp: (n,) N·m/rad, stiffness of the servo.
        kv: (n,) N·m·s/rad, damping of the servo.
        peak_torque: (n,) N·m, never exceeded.
        stall_torque: (n,) N·m, where the torque-speed line starts; at or above the peak.
        no_load_speed: (n,) rad/s, where the line ends.
    """

    kp: Floats
    kv: Floats
    peak_torque: Floats
    stall_torque: Floats
    no_load_speed: Floats
