"""A behaviour for experiments on the map: the robot stands where it is and looks."""

import math
from collections.abc import Sequence

from treadwell._core import Situation
from treadwell.protocols import Decision


class Onlooker:
    """Stands, looks at one direction after the other for equally long, and is done.

    In a scenario: `behaviour = "treadwell.experiments.onlooker:Onlooker"`, its parameters in
    `[navigation.Onlooker]`; the goal is where the robot starts.
    """

    def __init__(
        self, seconds: float = 10.0, gazes: Sequence[Sequence[float]] = ((0.0, 0.8),)
    ) -> None:
        """Prepare to look.

        Args:
            seconds: in all, simulated.
            gazes: (pan to the left, down from the horizon) rad, one or more.

        Raises:
            ValueError: no time, no gaze, or one that is none.
        """
        if not (math.isfinite(seconds) and seconds > 0.0):
            raise ValueError(f"seconds must be > 0, got {seconds}")
        if not gazes or any(len(gaze) != len(("pan", "down")) for gaze in gazes):
            raise ValueError(f"gazes must be pairs (pan, down), one or more, got {gazes}")
        self._seconds = seconds
        self._gazes = [(float(pan), float(down)) for pan, down in gazes]

    def next(self, situation: Situation) -> Decision:
        """Return the decision at a control tick."""
        passed = 1e-9 * situation.time_ns / self._seconds
        gaze = self._gazes[min(int(passed * len(self._gazes)), len(self._gazes) - 1)]
        outcome = "goal_reached" if passed >= 1.0 else None
        return Decision("look", gaze=gaze, outcome=outcome)
