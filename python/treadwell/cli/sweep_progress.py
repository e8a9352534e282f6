"""The live bar of a sweep: episodes done, successes so far, time left."""

import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Self

from treadwell.cli.output import write_message

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

    from treadwell.sweeps.row import Row

SECONDS_A_LINE: Final = 10.0
"""Of the clock between two lines where there is no terminal."""


class SweepProgress:
    """Shows on standard error how a sweep gets on; a context manager.

    On a terminal a bar; otherwise a line now and then, and one for each episode that failed.

    Attributes:
        done: episodes that are.
    """

    def __init__(self, of: int, *, terminal: bool | None = None) -> None:
        """Show nothing yet.

        Args:
            of: episodes in all.
            terminal: whether standard error is one; looked up when None.
        """
        self.done = 0
        self._of = of
        self._terminal = sys.stderr.isatty() if terminal is None else terminal
        self._bar: Progress | None = None
        self._task: TaskID | None = None
        self._next_s = 0.0
        self._begin: tuple[int, float] | None = None

    def __enter__(self) -> Self:
        """Begin."""
        if self._terminal:
            from rich.console import Console
            from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

            self._bar = Progress(
                BarColumn(),
                MofNCompleteColumn(),
                TextColumn("{task.description}"),
                console=Console(stderr=True),
            )
            self._task = self._bar.add_task("", total=self._of)
            self._bar.start()
        return self

    def __exit__(self, *raised: object) -> None:
        """Leave the last state on the screen, whatever happened."""
        if self._bar is not None:
            with suppress(OSError):  # the terminal may be gone
                self._bar.stop()
            self._bar = None

    def update(self, done: int, successes: int, row: "Row | None") -> None:
        """Show where the sweep is.

        Args:
            done: episodes that are.
            successes: of them.
            row: of the last one; None before the first.
        """
        self.done = done
        now = time.monotonic()
        if self._begin is None:
            self._begin = (done, now)
        text = f"{successes} of {done} succeeded{self._left(done, now)}"
        if self._bar is not None and self._task is not None:
            with suppress(OSError):  # the terminal may be gone
                self._bar.update(self._task, completed=done, description=text)
            return
        if row is not None and not row.success:
            write_message(f"{row.key.text}: {row.outcome} {row.reason or ''}")
        if now >= self._next_s or done == self._of:
            self._next_s = now + SECONDS_A_LINE
            write_message(f"{done} of {self._of} episodes, {text}")

    def _left(self, done: int, now: float) -> str:
        """Return the time left, by what was done since the beginning; nothing where unknown."""
        before, begin = self._begin or (0, now)
        if done <= before or done >= self._of:
            return ""
        seconds = round((now - begin) / (done - before) * (self._of - done))
        return f", {seconds // 3600}:{seconds // 60 % 60:02}:{seconds % 60:02} left"
