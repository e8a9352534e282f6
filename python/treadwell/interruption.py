"""Ctrl-C between two ticks, not amid one: what was done and what was written stay in step."""

import signal
import threading
from types import FrameType
from typing import Any, Self

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interruption:
    """While it is open, the first signal waits for `check`; the second does what it always does.

    Signals that were ignored, or did what the system does, go on to do so. In a thread other than
    the main one, to which no signals come, nothing changes.
    """

    def __init__(self) -> None:
        """Ask for nothing yet."""
        self._asked = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        """Take over from the handlers that there are."""
        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                if callable(signal.getsignal(number)):
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *raised: object) -> None:
        """Put the handlers back."""
        self._restore()

    def check(self) -> None:
        """Raise KeyboardInterrupt where a signal has come."""
        if self._asked:
            raise KeyboardInterrupt

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self._asked = True
        self._restore()

    def _restore(self) -> None:
        while self._before:
            number, handler = self._before.popitem()
            signal.signal(number, handler)
