"""Claims about runs that were cut off: they are called so, and what they left can be had."""

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from treadwell.cli.app import execute
from treadwell.recording import cut_off, recorder
from treadwell.recording.cut_off import cut_run, is_cut_off
from treadwell.recording.log_file import Front
from treadwell.recording.map_file import read_map
from treadwell.recording.observation_log import ROBOT
from treadwell.recording.trajectory import read_trajectory
from treadwell.recording.verification import verify_run

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was killed after some seconds."""
    folder = tmp_path_factory.mktemp("runs") / "run"
    command = [sys.executable, "-m", "treadwell.cli.app", "run", "slalom", "--out", str(folder)]
    log = folder / "observations.mcap"
    with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
        end = time.monotonic() + 60.0
        while not (log.is_file() and log.stat().st_size > 700_000):
            assert time.monotonic() < end
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
    return folder


@pytest.fixture
def cut(killed: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(killed, tmp_path / "cut"))


def test_it_is_called_so_in_one_line_with_the_time(
    cut: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = cut_run(cut)
    assert told is not None
    assert told.seconds is not None
    assert told.seconds > 1.0
    when = f"cut off at {told.seconds:.2f} s, killed or without power"
    assert execute(["verify", str(cut)]) == 1
    (line,) = capsys.readouterr().out.splitlines()
    assert line.startswith(f"{cut}: {when}")
    assert "what it left is whole" in line
    assert execute(["report", str(cut)]) == 0
    page = (cut / "report.html").read_text()
    assert when in page
    assert page.count("is missing") == 0


def test_what_it_left_is_whole_and_loses_half_a_second_at_most(cut: Path) -> None:
    found = verify_run(cut)
    assert found.problems == ()
    assert not found.passed
    assert found.cut is not None
    assert found.cut.seconds is not None
    assert abs(found.steps * 0.002 - found.cut.seconds) <= 0.5


@pytest.mark.parametrize(
    ("asks", "told", "scale"),
    [
        (True, b'{"scale": 2.5}', 2.5),
        (False, b'{"scale": 2.5}', 1.0),
        (True, b"{}", 1.0),
        (True, b'{"scale": -1.0}', 1.0),
        (True, b"no json", 1.0),
    ],
)
def test_of_a_course_made_to_the_robot_the_log_says_by_what_it_was_multiplied(
    cut: Path, monkeypatch: pytest.MonkeyPatch, *, asks: bool, told: bytes, scale: float
) -> None:
    file = cut / "scenario.toml"
    text = file.read_text(encoding="utf-8")
    assert "scale_to_robot = false" in text
    file.write_text(text.replace("scale_to_robot = false", f"scale_to_robot = {str(asks).lower()}"))
    front = Front({}, {ROBOT: told})
    monkeypatch.setattr(cut_off, "read_front", lambda _: front)
    found = cut_run(cut)
    assert found is not None
    assert found.scale == scale


def test_inspect_says_it(
    cut: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    done = subprocess.CompletedProcess([], 0)
    monkeypatch.setattr(recorder.subprocess, "run", lambda *_, **__: done)
    assert execute(["inspect", str(cut), "--json"]) == 0
    told = capsys.readouterr()
    assert told.err.startswith(f"{cut}: cut off at ")
    assert json.loads(told.out)["cut"] > 1.0


def test_trajectories_film_and_messages_come_out_of_its_log(cut: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert execute(["export", str(cut), "--to", "tum", "--out", str(out)]) == 0
    estimate, truth = (read_trajectory(out / name) for name in ("trajectory.tum",) * 2)
    assert len(estimate) > 10
    assert np.abs(estimate[:, 1:4] - truth[:, 1:4]).max() < 0.05
    film = tmp_path / "film.gif"
    assert execute(["report", str(cut), "--video", str(film)]) == 0
    assert film.stat().st_size > 10_000


def test_its_map_comes_of_a_replay_and_the_export_says_so(
    cut: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["export", str(cut), "--to", "map_server"]) == 2
    assert f"`treadwell replay {cut}` makes its map" in capsys.readouterr().err
    again = tmp_path / "again"
    assert execute(["replay", str(cut), "--out", str(again)]) == 0
    assert (read_map(again / "map.npz").surface.kind > 0).sum() > 100
    assert (again / "map.png").stat().st_size > 10_000
    assert execute(["export", str(again), "--to", "map_server"]) == 0
    ways = cut_run(cut)
    assert ways is not None
    replayed = read_trajectory(again / "trajectory.tum")
    assert np.abs(replayed[: len(ways.estimate)] - ways.estimate)[:, :4].max() < 1e-8


@pytest.fixture
def begun(tmp_path: Path) -> Path:
    folder = tmp_path / "begun"
    folder.mkdir()
    (folder / "scenario.toml").write_text("schema = 1\n")
    return folder


def test_of_a_run_that_had_only_begun_nothing_is_expected(begun: Path) -> None:
    assert is_cut_off(begun)
    found = verify_run(begun)
    assert found.problems == ()
    assert found.cut is not None
    assert found.cut.sentence() == (
        "cut off, killed or without power unless it still runs: it has no result.json"
    )
    (begun / "result.json").write_text("{}")
    assert not is_cut_off(begun)
    assert cut_run(begun) is None


@pytest.mark.parametrize("share", [0.0, 1e-5, 0.001, 0.02, 0.3, 0.9])
def test_wherever_its_files_break_off_it_is_no_fault(cut: Path, share: float) -> None:
    for name in ("observations.mcap", "recording.rrd"):
        content = (cut / name).read_bytes()
        (cut / name).write_bytes(content[: int(share * len(content))])
    found = verify_run(cut)
    assert found.problems == ()
    assert found.cut is not None
    assert execute(["report", str(cut)]) == 0
