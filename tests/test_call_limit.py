"""A call that takes too long is ended, whatever it does, and other timers go on."""

import contextlib
import signal
import threading
import time
from collections.abc import Callable
from types import FrameType

import pytest

from treadwell.call_limit import CallLimit, CallTimeoutError


def loop() -> None:
    while True:
        pass


def swallow() -> None:
    for _ in range(1000):
        with contextlib.suppress(Exception):  # as careless as a user
            time.sleep(60)


@pytest.mark.parametrize("work", [loop, swallow, threading.Event().wait])
def test_a_call_that_does_not_return_is_ended(work: Callable[[], object]) -> None:
    begin = time.perf_counter()
    with pytest.raises(CallTimeoutError, match=r"took longer than 0\.2 s"), CallLimit(0.2):
        work()
    assert time.perf_counter() - begin < 5.0


def test_a_quick_call_is_let_alone_and_the_alarm_is_gone() -> None:
    handler = signal.getsignal(signal.SIGALRM)
    with CallLimit(0.1):
        pass
    assert signal.getsignal(signal.SIGALRM) is handler
    time.sleep(0.15)


def test_a_timer_of_somebody_else_goes_on() -> None:
    rung: list[int] = []

    def ring(number: int, _frame: FrameType | None) -> None:
        rung.append(number)

    handler = signal.signal(signal.SIGALRM, ring)
    before = signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with CallLimit(0.2):
            time.sleep(0.05)
        left, _ = signal.getitimer(signal.ITIMER_REAL)
        assert 0.0 < left < 0.28
        with CallLimit(20.0):  # theirs comes sooner
            time.sleep(0.4)
        assert rung == [signal.SIGALRM]
    finally:
        signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, *before)


def test_in_another_thread_the_time_is_looked_at_afterwards() -> None:
    raised: list[BaseException] = []

    def work() -> None:
        try:
            with CallLimit(0.05):
                time.sleep(0.1)
        except CallTimeoutError as error:
            raised.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(raised) == 1


def test_an_exception_of_the_call_is_not_covered_up() -> None:
    with pytest.raises(ValueError, match="own"), CallLimit(1.0):
        int("own")
