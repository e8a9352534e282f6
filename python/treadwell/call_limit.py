"""A limit on the wall-clock time of a call, so that what never returns ends an episode only."""

import signal
import threading
from time import perf_counter
from types import FrameType
from typing import Any, Self

AGAIN_S = 1.0
"""Seconds after which a call that swallowed the first alarm gets another."""


class CallTimeoutError(BaseException):
    """A call took too long. No `Exception`: the `except Exception` of a component lets it pass."""


class CallLimit:
    """Raises `CallTimeoutError` in the block that it guards when that takes too long.

    In the main thread an alarm goes off amid the block, be it busy or asleep. To other threads no
    signals come: there the time is looked at when the block is over. A timer that somebody else
    has set goes on afterwards; one that goes off sooner is left alone.
    """

    def __init__(self, seconds: float) -> None:
        """Take the limit, seconds of wall-clock time."""
        self._seconds = seconds
        self._begin = 0.0
        self._armed = False
        self._handler: Any = None
        self._other = (0.0, 0.0)

    def __enter__(self) -> Self:
        """Begin to count."""
        self._begin = perf_counter()
        if threading.current_thread() is not threading.main_thread():
            return self
        self._other = signal.getitimer(signal.ITIMER_REAL)
        if not 0.0 < self._other[0] < self._seconds:
            self._handler = signal.signal(signal.SIGALRM, self._late)
            self._armed = True
            signal.setitimer(signal.ITIMER_REAL, self._seconds, AGAIN_S)
        return self

    def __exit__(self, kind: type[BaseException] | None, *raised: object) -> None:
        """Put back what was there, and look at the time."""
        taken = perf_counter() - self._begin
        if self._armed:
            self._armed = False
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, self._handler)
            delay, interval = self._other
            if delay > 0.0:
                signal.setitimer(signal.ITIMER_REAL, max(delay - taken, 1e-6), interval)
        if kind is None and taken > self._seconds:
            self._late()

    def _late(self, _number: int = 0, _frame: FrameType | None = None) -> None:
        raise CallTimeoutError(f"took longer than {self._seconds:g} s")
