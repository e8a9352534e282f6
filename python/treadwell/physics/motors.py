"""What the servos are told; they themselves, and the motors' limits, are the core library's."""

from collections import deque
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from treadwell.protocols import JointTargets

Floats = NDArray[np.float64]


class LateTargets:
    """What the motors are told comes late by a time that may change."""

    def __init__(self) -> None:
        """Begin with nothing under way."""
        self._under_way: deque[tuple[int, JointTargets]] = deque()

    def told(self, targets: JointTargets, time_ns: int, late_s: float) -> JointTargets:
        """Return what reaches the motors now: the oldest targets where none is old enough.

        Args:
            targets: what the core asks for now.
            time_ns: now, nanoseconds since the start.
            late_s: seconds from asking to arrival.
        """
        self._under_way.append((time_ns, targets))
        late_ns = round(1e9 * late_s)
        while len(self._under_way) > 1 and self._under_way[1][0] + late_ns <= time_ns:
            self._under_way.popleft()
        return self._under_way[0][1]


def strengths(joints: Mapping[str, int], weak: Iterable[tuple[str, float]]) -> Floats:
    """Return what share of its torque each motor can still give, (n,) in the joint order.

    Args:
        joints: name -> place in the joint order.
        weak: joint's name, or "all", and the share.
    """
    left = np.ones(len(joints))
    for joint, share in weak:
        at = slice(None) if joint == "all" else joints[joint]
        left[at] *= share
    return left
