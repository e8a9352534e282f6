"""The live line of a run: simulated time, state, distance to the goal, real-time factor."""

import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Self

from treadwell.cli.output import write_message

if TYPE_CHECKING:
    from rich.status import Status

SECONDS_A_LINE = 5.0
"""Simulated seconds between two lines where there is no terminal."""


COLUMN = len("look_around")
"""The longest state of the behaviours that come along; those of a user's may be longer."""


def line(
    time_s: float, state: str, distance_m: float, real_time_factor: float, column: int = COLUMN
) -> str:
    """Return the progress line.

    Args:
        time_s: simulated seconds since the start.
        state: what the behaviour is doing.
        distance_m: from the goal, metres.
        real_time_factor: simulated seconds for each second of the clock.
        column: letters that the state has room for.
    """
    return (
        f"{time_s:6.1f} s  {state:<{column}}  {distance_m:5.2f} m to the goal  "
        f"{real_time_factor:5.1f}x"
    )


class ProgressLine:
    """Shows on standard error how a run gets on.

    On a terminal one line renews itself; otherwise a plain line is written every five simulated
    seconds and at every change of state. A context manager: the line vanishes with it.
    """

    def __init__(self, title: str = "", *, terminal: bool | None = None) -> None:
        """Show nothing yet.

        Args:
            title: what runs.
            terminal: whether standard error is one; looked up when None.
        """
        self._title = title
        self._terminal = sys.stderr.isatty() if terminal is None else terminal
        self._status: Status | None = None
        self._state = ""
        self._column = COLUMN
        self._next_s = 0.0

    def __enter__(self) -> Self:
        """Begin."""
        if self._terminal:
            from rich.console import Console
            from rich.text import Text

            self._status = Console(stderr=True).status(Text(self._title))
            self._status.start()
        return self

    def __exit__(self, *raised: object) -> None:
        """Take the line away, whatever happened."""
        if self._status is not None:
            with suppress(OSError):  # the terminal may be gone
                self._status.stop()
            self._status = None

    def update(self, time_s: float, state: str, distance_m: float, real_time_factor: float) -> None:
        """Show where the run is; call it as often as you like.

        Args:
            time_s: simulated seconds since the start.
            state: what the behaviour is doing.
            distance_m: from the goal, metres.
            real_time_factor: simulated seconds for each second of the clock.
        """
        self._column = max(self._column, len(state))
        text = line(time_s, state, distance_m, real_time_factor, self._column)
        if self._status is not None:
            from rich.text import Text

            with suppress(OSError):  # the terminal may be gone
                self._status.update(Text(f"{self._title}  {text}"))
        elif not self._terminal and (time_s >= self._next_s or state != self._state):
            self._next_s = (time_s // SECONDS_A_LINE + 1) * SECONDS_A_LINE
            self._state = state
            write_message(f"{self._title} {text}".lstrip())
