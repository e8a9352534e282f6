"""`treadwell serve` as a program: the example against it, its ends, its misuse."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest
from serving_builders import GOAL

import treadwell
from treadwell.cli.app import execute
from treadwell.serving.client import Client
from treadwell.serving.framing import ProtocolError

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "serve_replay.py"
PROGRAM = [sys.executable, "-c", "from treadwell.cli.app import main; main()", "serve"]
pytestmark = pytest.mark.slow


@contextmanager
def serving(
    folder: Path, *options: str, robot: str = "qrio"
) -> Iterator[tuple[subprocess.Popen[str], list[str]]]:
    """The program, listening, and what it said until then."""

    def heed() -> None:
        # Ctrl-C counts, also where these tests run in the background of a shell that ignores it.
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    program = subprocess.Popen(
        [*PROGRAM, "--robot", robot, "--timeout", "60", *options],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heed,
    )
    try:
        assert program.stderr is not None
        said = [program.stderr.readline()]
        while said[-1] and not said[-1].startswith("serving: "):
            said.append(program.stderr.readline())
        assert said[-1].startswith(f"serving:   {robot} at "), said
        yield program, said
    finally:
        program.kill()
        program.communicate()


def place(said: list[str]) -> str:
    """Where it listens."""
    return said[-1].split(" at ")[1].split(";")[0]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four seconds of a walk over an open floor."""
    folder = tmp_path_factory.mktemp("runs") / "run"
    treadwell.run("open_floor", seed=2, overrides=("time_limit=4",), out=folder)
    return folder


def play(run: Path, server: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(EXAMPLE), str(run), server],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("options", [("--socket", "core.sock"), ("--tcp", "0"), ()])
def test_a_recorded_run_played_through_a_server_has_the_same_targets_bit_for_bit(
    run: Path, tmp_path: Path, options: Sequence[str]
) -> None:
    with serving(tmp_path, *options, "--once", "--json") as (program, said):
        where = place(said)
        assert where.startswith("127.0.0.1:") == ("--tcp" in options)
        done = play(run, where.removeprefix("127.0.0.1:"), tmp_path)
        assert done.stdout == "the same in all 400 ticks, bit for bit\n", done.stderr
        out, err = program.communicate(timeout=60)
        assert program.returncode == 0
        assert err.startswith("client 1: hello, qrio\nclient 1: goodbye after 400 ticks (3.99 s, ")
    document = json.loads(out)
    assert document["robot"] == "qrio"
    assert document["client"]["ticks"] == 400
    assert document["client"]["error"] is None
    assert list(tmp_path.iterdir()) == []


IDLE = """
from treadwell.protocols import Decision

class Idle:
    def next(self, situation):
        return Decision("idle")
"""


def test_the_example_names_the_first_difference_of_another_core(run: Path, tmp_path: Path) -> None:
    (tmp_path / "idle_part.py").write_text(IDLE)
    part = "navigation.behaviour=idle_part:Idle"
    with serving(tmp_path, "--socket", "s", "--set", part) as (_, said):
        assert said[0].startswith("python:    runs behaviour idle_part:Idle (")
        done = play(run, place(said), tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("first difference at tick 0 (0.00 s): state: 'idle' ")
    assert len(done.stderr.splitlines()) == 1


def test_the_example_says_what_is_wrong_in_one_line(run: Path, tmp_path: Path) -> None:
    done = play(run, str(tmp_path / "none"), tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"error: {tmp_path / 'none'}: no server answers there")
    assert len(EXAMPLE.read_text().splitlines()) <= 60


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_it_with_130_and_takes_the_socket_away(tmp_path: Path, number: int) -> None:
    with serving(tmp_path, "--socket", "s") as (program, said):
        client = Client(tmp_path / place(said), goal=GOAL)
        program.send_signal(number)
        with pytest.raises(ProtocolError, match="the server: the server was ended"):
            client._asked("goodbye", {"type": "goodbye"}, {})
        client.abandon()
        out, err = program.communicate(timeout=30)
        assert program.returncode == 130
        assert err.endswith("treadwell: interrupted\n")
        assert "Traceback" not in err
        assert out == ""
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_ends_it_while_it_waits(tmp_path: Path) -> None:
    with serving(tmp_path, "--json") as (program, said):
        assert (tmp_path / place(said)).is_socket()
        program.send_signal(signal.SIGINT)
        out, err = program.communicate(timeout=30)
        assert program.returncode == 130
        assert err == "treadwell: interrupted\n"
        assert json.loads(out)["status"] == 130
    assert list(tmp_path.iterdir()) == []


def test_the_socket_of_a_killed_server_is_taken_and_that_of_a_live_one_is_not(
    tmp_path: Path,
) -> None:
    with serving(tmp_path, "--socket", "s") as (program, _):
        program.send_signal(signal.SIGKILL)
        program.wait(30)
        assert (tmp_path / "s").is_socket()
    with serving(tmp_path, "--socket", "s") as (program, _):
        done = subprocess.run(
            [*PROGRAM, "--robot", "qrio", "--socket", "s", "--once"],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 2
        assert done.stderr == (
            "error: --socket: s: a server listens there already; end it, or name another file\n"
        )
        Client(tmp_path / "s", goal=GOAL).close()
        assert program.poll() is None


def test_once_ends_with_2_where_the_client_was_wrong(tmp_path: Path) -> None:
    with serving(tmp_path, "--socket", "s", "--once", "--json") as (program, _):
        with socket.socket(socket.AF_UNIX) as client:
            client.connect(str(tmp_path / "s"))
            client.sendall(os.urandom(2000))
            client.shutdown(socket.SHUT_WR)
            out, err = program.communicate(timeout=30)
        assert program.returncode == 2
        assert err.startswith("client 1: error: ")
        assert len(err.splitlines()) == 1
        assert json.loads(out)["client"]["error"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--robot", "qiro"], "did you mean 'qrio'?"),
        ([], "--robot"),
        (["--robot", "qrio", "--timeout", "0"], "--timeout: found 0.0; must be more than 0 s"),
        (["--robot", "qrio", "--timeout", "nan"], "--timeout: found nan"),
        (["--robot", "qrio", "--tcp", "70000"], "--tcp"),
        (["--robot", "qrio", "--tcp", "1", "--socket", "s"], "listens at one of them"),
        (["--robot", "qrio", "--set", "navigation.fog.sell=1"], "sell"),
        (["--robot", "qrio", "--set", "goal.radius=1"], "sets navigation.* alone"),
        (["--robot", "qrio", "--set", "navigation.planner=no.such:Thing"], "no.such"),
        (["--robot", "qrio", "--socket", "no/such/s"], "cannot listen there: No such file"),
    ],
)
def test_a_misuse_is_one_message_and_status_2(
    options: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert execute(["serve", *options]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("error: ")
    assert message in captured.err
    assert captured.out == ""


def test_help_has_an_example_and_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["serve", "--help"]) == 0
    shown = capsys.readouterr().out
    assert "Example: treadwell serve" in shown
    for option in ("--json", "--timeout", "--tcp", "--once"):
        assert option in shown
