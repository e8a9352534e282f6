"""What is told how a run gets on; the command line shows it."""

from typing import Protocol


class Progress(Protocol):
    """Is told how a run gets on."""

    def update(self, time_s: float, state: str, distance_m: float, real_time_factor: float) -> None:
        """Take in where the run is; called at every camera frame.

        Args:
            time_s: simulated seconds since the start.
            state: what the behaviour is doing.
            distance_m: from the goal, metres.
            real_time_factor: simulated seconds for each second of the clock.
        """
        ...
