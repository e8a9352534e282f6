"""What the servos are told; they themselves, and the motors' limits, are the core library's."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class JointTargets:
    """What the core asks of the joints at one control tick; arrays by the robot's joint order.

    Attributes:
        position: (n,) rad.
        velocity: (n,) rad/s.
        torque: (n,) N·m, fed forward.
    """

    position: Floats
    velocity: Floats
    torque: Floats
