"""Claims about the thread that writes: in order, all of it, waited for, and its error told once."""

import threading

import pytest

from treadwell.errors import RecordingError
from treadwell.recording import writing_thread
from treadwell.recording.writing_thread import WritingThread


def fail() -> None:
    raise RecordingError("the disk is full")


def test_all_jobs_are_done_in_their_order() -> None:
    thread, done = WritingThread(), list[int]()
    for number in range(100):
        thread.do(lambda number=number: done.append(number))
    thread.close()
    assert done == list(range(100))
    thread.close()


def test_who_hands_over_waits_where_too_many_jobs_do() -> None:
    thread, gate = WritingThread(), threading.Event()
    thread.do(gate.wait)
    handed = list[int]()

    def hand_over() -> None:
        for number in range(2 * writing_thread._MOST_JOBS):
            thread.do(lambda: None)
            handed.append(number)

    other = threading.Thread(target=hand_over)
    other.start()
    other.join(0.3)
    assert other.is_alive()
    assert len(handed) <= writing_thread._MOST_JOBS + 1
    gate.set()
    other.join(10.0)
    assert not other.is_alive()
    thread.close()


def test_an_error_is_told_at_the_next_job_and_not_again() -> None:
    thread, failed, done = WritingThread(), threading.Event(), list[int]()
    thread.do(fail)
    thread.do(failed.set)
    failed.wait(10.0)
    with pytest.raises(RecordingError, match="the disk is full"):
        thread.do(lambda: done.append(0))
    thread.do(lambda: done.append(1))
    thread.close()
    assert done == [0, 1]


def test_an_error_of_the_last_job_is_told_at_the_end() -> None:
    thread, done = WritingThread(), list[int]()
    thread.do(fail)
    thread._jobs.put(lambda: done.append(1))
    with pytest.raises(RecordingError, match="the disk is full"):
        thread.close()
    assert done == [1]
    thread.close()
