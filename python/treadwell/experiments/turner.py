"""A behaviour for experiments on drift: the robot turns on the spot."""

import math

from treadwell._core import Situation
from treadwell.judging.ground_truth import wrapped
from treadwell.protocols import Decision

DOWN_RAD = 0.8
"""Where it looks meanwhile: at the floor before its feet."""


class Turner:
    """Turns counter-clockwise as often as it is told, by its own estimate, stands, and is done.

    In a scenario: `behaviour = "treadwell.experiments.turner:Turner"`, its parameters in
    `[navigation.Turner]`; the goal is where the robot starts.
    """

    def __init__(self, turns: float = 5.0, rate: float = 0.3) -> None:
        """Prepare to turn.

        Args:
            turns: how often it turns about itself.
            rate: rad/s.

        Raises:
            ValueError: no turn, or no rate.
        """
        for name, value in (("turns", turns), ("rate", rate)):
            if not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} must be > 0, got {value}")
        self._left = 2.0 * math.pi * turns
        self._rate = float(rate)
        self._yaw: float | None = None

    def next(self, situation: Situation) -> Decision:
        """Return the decision at a control tick."""
        yaw = situation.estimate[3]
        self._left -= 0.0 if self._yaw is None else wrapped(yaw - self._yaw)
        self._yaw = yaw
        gaze = (0.0, DOWN_RAD)
        if self._left > 0.0:
            return Decision("turn", velocity=(0.0, 0.0, self._rate), gaze=gaze)
        outcome = "goal_reached" if situation.standing else None
        return Decision("stand", gaze=gaze, outcome=outcome)
