"""Worker processes: what one piece of work does to itself, it does to no other."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

import pytest

from treadwell.errors import InputError
from treadwell.workers import pool as pool_module
from treadwell.workers.answers import Answer, Died, Done, Raised
from treadwell.workers.child import one_line
from treadwell.workers.pool import Limits, Pool

MEGABYTE = 1_000_000
COUNTER = [0]


def work(item: Any) -> object:  # noqa: ANN401 - whatever a test asks for
    """Do what the item says; in a worker process."""
    what, value = item
    if what == "count":
        COUNTER[0] += 1
        return os.getpid(), COUNTER[0]
    if what == "sleep":
        time.sleep(value)
    elif what == "exit":
        os._exit(value)
    elif what == "signal":
        sys.stderr.write("the last word\n")
        sys.stderr.flush()
        os.kill(os.getpid(), value)
    elif what == "take":
        return len(bytearray(value))
    elif what == "raise":
        raise value
    elif what == "function":
        return lambda: None
    elif what == "child":
        return subprocess.Popen(["sleep", "60"]).pid
    elif what == "print":
        print("to standard output")
    return value


def answers(items: list[tuple[str, Any]], count: int = 1, **limits: Any) -> dict[Any, Answer]:  # noqa: ANN401
    with Pool(work, count) as pool:
        for item in items:
            pool.submit(item, Limits(**limits))
        return {item[0]: answer for item, answer in pool.answers()}


@pytest.mark.slow
def test_work_that_dies_hangs_or_raises_takes_nothing_along() -> None:
    begin = time.monotonic()
    found = answers(
        [
            ("exit", 7),
            ("signal", signal.SIGSEGV),
            ("sleep", 60),
            ("raise", ValueError("no\nway")),
            ("function", None),
            ("return", 3),
        ],
        count=2,
        seconds=1.0,
    )
    assert time.monotonic() - begin < 30.0
    assert found["return"] == Done(3)
    assert found["exit"] == Died("its process ended with status 7")
    died = found["signal"]
    assert isinstance(died, Died)
    assert "signal 11 (SIGSEGV)" in died.reason
    assert "Segmentation fault" in died.reason
    assert found["sleep"] == Died("took longer than 1 s", timed_out=True)
    assert found["raise"] == Raised("ValueError: no way")
    assert isinstance(found["function"], Raised)


def found_together(monkeypatch: pytest.MonkeyPatch, ended: Callable[[list[Any]], None]) -> None:
    """Let the pool look at its workers for the first time when `ended` returns."""
    first = iter([True])

    def wait_(watched: list[Any], patience: float) -> list[Any]:
        if next(first, False):
            ended(watched)
        return list(wait(watched, patience))

    monkeypatch.setattr(pool_module, "wait", wait_)


@pytest.mark.slow
def test_workers_that_die_in_the_same_moment_are_both_replaced(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def died(watched: list[Any]) -> None:
        for sentinel in watched[1::2]:
            wait([sentinel])

    found_together(monkeypatch, died)
    with Pool(work, 2) as pool:
        for item in (("exit", 1), ("exit", 2), ("return", 3), ("return", 4)):
            pool.submit(item)
        found = {value: answer for (_, value), answer in pool.answers()}
    assert found == {
        1: Died("its process ended with status 1"),
        2: Died("its process ended with status 2"),
        3: Done(3),
        4: Done(4),
    }


@pytest.mark.slow
def test_a_worker_that_did_something_fresh_is_given_nothing_more_when_another_ends_with_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def answered(watched: list[Any]) -> None:
        for connection in watched[::2]:
            wait([connection])
        time.sleep(1.0)  # they say first that they have begun

    found_together(monkeypatch, answered)
    with Pool(work, 2) as pool:
        for value in (1, 2):
            pool.submit(("return", value), fresh=True)
        for value in (3, 4):
            pool.submit(("return", value), Limits(seconds=20.0))
        found = {value: answer for (_, value), answer in pool.answers()}
    assert found == {value: Done(value) for value in (1, 2, 3, 4)}


def test_an_error_of_treadwells_comes_back_as_it_is() -> None:
    found = answers([("raise", InputError("that key"))])["raise"]
    assert isinstance(found, Raised)
    assert isinstance(found.error, InputError)
    assert str(found.error) == "that key"


def test_memory_is_limited_for_each_piece_of_work() -> None:
    with Pool(work, 1) as pool:
        pool.submit(("take", 300 * MEGABYTE), Limits(memory=200 * MEGABYTE))
        pool.submit(("take", 300 * MEGABYTE), Limits(memory=500 * MEGABYTE))
        pool.submit(("take", 300 * MEGABYTE))
        first, second, third = (answer for _, answer in pool.answers())
    assert isinstance(first, Raised)
    assert first.reason.startswith("out of memory")
    assert second == third == Done(300 * MEGABYTE)


@pytest.mark.slow
def test_a_process_is_used_again_but_not_for_what_has_to_be_fresh() -> None:
    with Pool(work, 1) as pool:
        for fresh in (False, False, True, True, False):
            pool.submit(("count", 0), fresh=fresh)
        found = [answer.value for _, answer in pool.answers() if isinstance(answer, Done)]
    assert [count for _, count in found] == [1, 2, 1, 1, 1]
    assert len({process for process, _ in found}) == 4


def test_more_work_can_be_asked_for_on_the_way_and_go_before_the_rest() -> None:
    order = []
    with Pool(work, 1) as pool:
        for value in (1, 2, 3):
            pool.submit(("return", value))
        for (_, value), _ in pool.answers():
            order.append(value)
            if value == 1:
                pool.submit(("return", 10), next_=True)
    assert sorted(order) == [1, 2, 3, 10]
    assert order.index(10) < order.index(3)


def test_what_work_writes_does_not_reach_the_output(capfd: pytest.CaptureFixture[str]) -> None:
    assert answers([("print", 1)])["print"] == Done(1)
    assert capfd.readouterr() == ("", "")


def test_what_work_started_ends_with_it() -> None:
    with Pool(work, 1) as pool:
        pool.submit(("child", 0), fresh=True)
        (found,) = [answer for _, answer in pool.answers()]
    assert isinstance(found, Done)
    assert ends(found.value)


def test_of_a_parent_that_is_killed_neither_workers_nor_files_are_left(tmp_path: Path) -> None:
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from test_pool import work\n"
        "from treadwell.workers.pool import Pool\n"
        "with Pool(work, 1) as pool:\n"
        "    pool.submit(('count', 0)); pool.submit(('sleep', 60))\n"
        "    for _, answer in pool.answers(): print(answer.value[0], flush=True)\n"
    )
    command = [sys.executable, "-c", code, str(Path(__file__).parent)]
    places = os.environ | {"TMPDIR": str(tmp_path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, env=places) as parent:
        assert parent.stdout is not None
        worker = int(parent.stdout.readline())
        time.sleep(0.2)
        parent.kill()
    assert ends(worker)
    assert not list(tmp_path.iterdir())


def ends(process: int) -> bool:
    """Whether a process is gone, or only its entry is left, within five seconds."""
    for _ in range(100):
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.05)
    return False


def test_an_error_is_told_on_one_line() -> None:
    assert one_line(ValueError("a\n b")) == "ValueError: a b"
    assert one_line(ValueError()) == "ValueError"
