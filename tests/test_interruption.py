"""A run that is cut short: Ctrl-C, a full disk, a kill. What there is stays readable."""

import errno
import fcntl
import io
import itertools
import json
import os
import resource
import select
import shutil
import signal
import subprocess
import sys
import termios
import threading
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from treadwell import interruption
from treadwell.cli import output
from treadwell.cli.app import execute
from treadwell.interruption import SIGNALS, Interruption
from treadwell.recording.observation_log import read_observations
from treadwell.recording.verification import verify_run

pytestmark = pytest.mark.slow

TWICE = [signal.SIGINT] * 3
"""Ctrl-C, and again at once, and while the files are being closed."""
LONG = ("run", "slalom", "--seed", "1", "--set", "time_limit=60")


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Ctrl-C counts, also where these tests run in the background of a shell that ignores it."""
    before = {one: signal.getsignal(one) for one in SIGNALS}
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@contextmanager
def start(folder: Path, *options: str, limit: int | None = None) -> Iterator[subprocess.Popen[str]]:
    """Start a run in a process of its own, `limit` bytes being the most that a file may have."""

    def tighten() -> None:
        # Ctrl-C counts, also where these tests run in the background of a shell that ignores it.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    arguments: Sequence[str] = (*LONG, "--out", str(folder), *options)
    process = subprocess.Popen(
        [sys.executable, "-m", "treadwell.cli.app", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=tighten,
        # Python would leave half a compiled module behind, and never look at it again.
        env=os.environ | ({} if limit is None else {"PYTHONDONTWRITEBYTECODE": "1"}),
    )
    with process:
        try:
            yield process
        finally:
            process.kill()


def wait_for(process: subprocess.Popen[str], path: Path, size: int) -> None:
    """Wait until a file has grown so far."""
    end = time.monotonic() + 60.0
    while not (path.is_file() and path.stat().st_size > size):
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end, f"{path} did not grow"
        time.sleep(0.02)


def recorded(folder: Path) -> set[str]:
    from rerun.chunk import RrdReader

    with warnings.catch_warnings():
        # A file whose writer was stopped has no table of contents; reading it takes longer.
        warnings.simplefilter("ignore")
        chunks = RrdReader(folder / "recording.rrd").stream().to_chunks()
        return {str(chunk.entity_path) for chunk in chunks}


@pytest.mark.parametrize(
    "numbers",
    [
        [signal.SIGTERM],
        pytest.param([signal.SIGINT], marks=pytest.mark.long),  # as `TWICE` begins
        pytest.param([signal.SIGHUP], marks=pytest.mark.long),
        TWICE,
    ],
)
def test_an_interrupted_run_closes_its_files_says_so_and_leaves_with_130(
    tmp_path: Path, numbers: list[signal.Signals]
) -> None:
    folder = tmp_path / "run"
    with start(folder, "--json") as process:
        wait_for(process, folder / "recording.rrd", 1_500_000)
        for number in numbers:
            process.send_signal(number)
            time.sleep(0.1)
        output, messages = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in messages
    told = json.loads(output)
    assert told == json.loads((folder / "result.json").read_text())
    assert told["outcome"] == "interrupted"
    assert not told["passed"]
    assert 0.5 < told["simulated_seconds"] < 59.0
    assert verify_run(folder).problems == ()
    assert "/camera/depth" in recorded(folder)
    count = sum(1 for _ in read_observations(folder / "observations.mcap"))
    assert count == round(100 * told["simulated_seconds"])


def test_a_disk_that_fills_up_ends_the_run_with_one_message_and_its_result(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with start(folder, limit=22_000_000) as process:
        output, messages = process.communicate(timeout=120)
    assert process.returncode == 3, messages
    (error,) = [line for line in messages.splitlines() if line.startswith("error: ")]
    assert "recording.rrd" in error
    assert "disk is full" in error
    assert "Traceback" not in messages + output
    result = json.loads((folder / "result.json").read_text())
    assert result["outcome"] == "error"
    assert "disk is full" in result["reason"]
    assert "/camera/depth" in recorded(folder)
    assert (folder / "map.png").stat().st_size > 10_000
    assert sum(1 for _ in read_observations(folder / "observations.mcap")) > 100


def test_a_disk_that_is_full_from_the_start_is_one_message(tmp_path: Path) -> None:
    with start(tmp_path / "run", limit=1_000) as process:
        output, messages = process.communicate(timeout=60)
    assert process.returncode == 3
    assert not (tmp_path / "run").exists()
    assert messages.count("error: ") == 1
    assert "Traceback" not in messages + output


def test_a_killed_run_leaves_what_it_recorded(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with start(folder) as process:
        wait_for(process, folder / "observations.mcap", 300_000)
        process.kill()
        process.communicate(timeout=60)
    assert "/camera/depth" in recorded(folder)
    found = read_observations(folder / "observations.mcap")
    assert sum(1 for _ in itertools.islice(found, 50)) == 50
    assert not (folder / "result.json").exists()
    verified = verify_run(folder)
    assert verified.problems == ()
    assert verified.cut is not None


def test_a_signal_waits_for_the_end_of_the_tick_and_handlers_come_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    with Interruption() as asked:
        asked.check()
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            asked.check()
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_signal_waits_too_unless_a_tick_goes_on_and_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = [100.0]
    monkeypatch.setattr(interruption, "monotonic", lambda: now[0])
    with Interruption():
        signal.raise_signal(signal.SIGINT)
        now[0] += 0.3
        signal.raise_signal(signal.SIGINT)
        now[0] += 2.0
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)  # it was told


def test_what_is_being_written_no_signal_cuts_short(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr(interruption, "monotonic", lambda: now[0])
    written = []

    def work() -> None:
        with Interruption() as held:
            held.hold()
            for _ in range(3):
                signal.raise_signal(signal.SIGTERM)
                now[0] += 10.0
            written.append(True)

    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with pytest.raises(KeyboardInterrupt):
        work()
    assert written == [True]


def test_a_run_whose_terminal_is_closed_ends_with_its_result(tmp_path: Path) -> None:
    def own_terminal() -> None:
        # A closed terminal counts, also where `nohup` has these tests ignore it.
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    folder = tmp_path / "run"
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "treadwell.cli.app", *LONG, "--out", str(folder)],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
        preexec_fn=own_terminal,
    )
    os.close(theirs)
    reader = threading.Thread(target=drain, args=(ours, folder / "recording.rrd"))
    reader.start()
    reader.join(60.0)
    os.close(ours)
    status = process.wait(60.0)
    told = json.loads((folder / "result.json").read_text())
    # Nobody can read what the run says: where it ends otherwise, its result tells why.
    assert (status, told["outcome"]) == (130, "interrupted"), told["reason"]
    assert verify_run(folder).problems == ()


def drain(terminal: int, path: Path) -> None:
    """Read what a terminal is told until a recording has grown, be that much or nothing."""
    while not (path.is_file() and path.stat().st_size > 1_500_000):
        if select.select([terminal], [], [], 0.05)[0]:
            os.read(terminal, 10_000)


class ClosedTerminal(io.StringIO):
    """What standard output is once its terminal is closed, and before the signal has come."""

    def write(self, _: str) -> int:
        raise OSError(errno.EIO, "Input/output error")


@pytest.mark.parametrize("arguments", [("list", "robots"), ("list", "robots", "--json")])
def test_a_terminal_that_is_closed_under_a_result_ends_as_by_its_signal(
    arguments: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    left = []
    monkeypatch.setattr(output, "leave_terminal", lambda: left.append(True))
    monkeypatch.setattr(sys, "stdout", ClosedTerminal())
    assert execute(arguments) == 130
    assert left


def test_an_interruption_while_the_folder_is_opened_leaves_a_result(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with start(folder) as process:
        wait_for(process, folder / "scenario.toml", 100)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 130
    assert json.loads((folder / "result.json").read_text())["outcome"] == "interrupted"
    assert verify_run(folder).problems == ()


@pytest.mark.parametrize("removed", [True, False])
def test_a_folder_that_is_removed_or_renamed_is_told_at_once(tmp_path: Path, removed: bool) -> None:
    folder = tmp_path / "run"
    with start(folder) as process:
        wait_for(process, folder / "recording.rrd", 500_000)
        folder.rename(tmp_path / "other")
        if removed:
            shutil.rmtree(tmp_path / "other")
        begin = time.monotonic()
        _, messages = process.communicate(timeout=60)
    assert time.monotonic() - begin < 10.0
    assert process.returncode == 3
    (error,) = [line for line in messages.splitlines() if line.startswith("error: ")]
    assert error.startswith(f"error: {folder}: was removed or renamed while the run wrote into it")
    assert not folder.exists()


def test_in_another_thread_nothing_changes() -> None:
    before = signal.getsignal(signal.SIGINT)
    seen = []

    def work() -> None:
        with Interruption() as asked:
            asked.check()
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [before]
