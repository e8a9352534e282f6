"""How the believed pose drifts from the true one, frame by frame."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.episode import Episode
from treadwell.judging.ground_truth import wrapped
from treadwell.trace import Sole, Trace

Floats = NDArray[np.float64]

SAME_LEVEL_M = 0.005
"""Soles no further apart than this stand on one level."""


@dataclass(frozen=True, slots=True)
class PoseErrors:
    """Believed minus true, an entry for each camera frame that counts.

    Attributes:
        heights: m, while both soles stand on one level.
        headings: rad, of the estimate.
        turned: rad, how far the robot had truly turned by then, counter-clockwise, beyond a turn.
    """

    heights: tuple[float, ...]
    headings: tuple[float, ...]
    turned: tuple[float, ...]


class PoseWatch:
    """Compares the believed pose with the true one."""

    def __init__(self, _episode: Episode) -> None:
        """Watch this episode."""
        self._heights: list[float] = []
        self._headings: list[float] = []
        self._turned: list[float] = []
        self._yaw: float | None = None

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""
        believed, true = trace.map_from_robot, trace.truth_from_robot
        if trace.soles is not None and all(trace.touch) and _on_one_level(trace.soles):
            self._heights.append(float(believed[2, 3] - true[2, 3]))
        yaw = _yaw(true)
        self._headings.append(wrapped(_yaw(believed) - yaw))
        step = 0.0 if self._yaw is None else wrapped(yaw - self._yaw)
        self._yaw = yaw
        self._turned.append((self._turned[-1] if self._turned else 0.0) + step)

    def findings(self) -> PoseErrors:
        """Return what was seen so far."""
        return PoseErrors(tuple(self._heights), tuple(self._headings), tuple(self._turned))


def _yaw(pose: Floats) -> float:
    return math.atan2(pose[1, 0], pose[0, 0])


def _on_one_level(soles: tuple[Sole, Sole]) -> bool:
    left, right = soles
    return abs(left.z - right.z) <= SAME_LEVEL_M
