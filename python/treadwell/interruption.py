"""Ctrl-C, TERM and a closed terminal: a run ends between two ticks, and with what it has."""

import os
import signal
import stat
import threading
from time import monotonic
from types import FrameType
from typing import Any, Final, Self

SIGNALS: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
PATIENCE_S: Final = 2.0
"""Seconds of the clock after which a tick that goes on is cut short by another signal."""


class Interruption:
    """While it is open, a signal waits for `check`, and those that follow it change nothing.

    Only where a tick goes on and on does another signal, `PATIENCE_S` after the first, raise
    KeyboardInterrupt at once. What is written after `hold` no signal cuts short: one that comes
    first then is raised when all is over.

    Signals that were ignored, or did what the system does, go on to do so. In a thread other than
    the main one, to which no signals come, nothing changes.
    """

    def __init__(self) -> None:
        """Ask for nothing yet."""
        self._asked_s: float | None = None
        self._told = self._held = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        """Take over from the handlers that there are."""
        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                if callable(signal.getsignal(number)):
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, kind: type[BaseException] | None, *raised: object) -> None:
        """Put the handlers back, and raise what nobody was told."""
        while self._before:
            number, handler = self._before.popitem()
            signal.signal(number, handler)
        if kind is None and not self._told:
            self.check()

    def check(self) -> None:
        """Raise KeyboardInterrupt where a signal has come."""
        if self._asked_s is not None:
            self._told = True
            raise KeyboardInterrupt

    def hold(self) -> None:
        """Let every signal wait for the end: what was done is being written."""
        self._held = True

    def _note(self, number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGHUP:
            leave_terminal()
        now = monotonic()
        if self._asked_s is None:
            self._asked_s = now
        elif now - self._asked_s > PATIENCE_S and not (self._held or self._told):
            self.check()


def leave_terminal() -> None:
    """Let what this process says go nowhere where it went to a terminal, which is closed."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        # Whether it is a terminal cannot be asked any more: it is a device.
        if stat.S_ISCHR(os.fstat(stream).st_mode):
            os.dup2(nowhere, stream)
    os.close(nowhere)
