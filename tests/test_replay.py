"""Claims about `replay`: the same answers bit for bit, and a word where they part."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import user_parts
from numpy.typing import NDArray

import treadwell
from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.protocols import Plan
from treadwell.recording.observation_log import NAME
from treadwell.replaying import replay as replay_module
from treadwell.replaying.findings import Findings
from treadwell.replaying.replay import Replay
from treadwell.replaying.result import ReplayResult
from treadwell.replaying.source import open_source
from treadwell.scenario.model import Scenario

CASES = {
    "stairs_up": {"robot": "qrio", "seed": 3},
    "obstacle_course": {"robot": "nao", "seed": 1},
    "nao_2": {"robot": "nao", "seed": 2},
}
"""The last one localizes by Monte Carlo on an octree that it is told."""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Two seconds of each case, recorded."""
    folder = tmp_path_factory.mktemp("runs")
    made = {}
    for name, how in CASES.items():
        limit = ("time_limit=2",)
        made[name] = treadwell.run(name, **how, overrides=limit, out=folder / name).folder  # type: ignore[arg-type]
    return made


@pytest.fixture
def run(runs: dict[str, Path]) -> Path:
    return runs["stairs_up"]


def replayed(run_dir: Path, out: Path, *settings: str, **components: object) -> Replay:
    return treadwell.replay(run_dir, overrides=settings, out=out, **components)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_core_answers_the_same_bit_for_bit(
    runs: dict[str, Path], name: str, tmp_path: Path
) -> None:
    done = replayed(runs[name], tmp_path / "out")
    facts = done.result.replay
    assert (facts.observations, facts.compared, facts.first_difference) == (200, 200, None)
    assert done.passed
    for file in ("trajectory.tum",):
        assert (done.folder / file).read_bytes() == (runs[name] / file).read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_on_a_processor_that_can_less_the_core_answers_the_same_bit_for_bit(
    runs: dict[str, Path], name: str, tmp_path: Path
) -> None:
    command = [sys.executable, "-m", "treadwell.cli.app", "replay", str(runs[name])]
    masked = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
    out = ["--out", str(tmp_path / "again")]
    done = subprocess.run([*command, *out], env=masked, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "the same in all 200 ticks, bit for bit" in done.stdout + done.stderr


def test_the_result_is_the_runs_without_what_only_the_simulator_knows(
    run: Path, tmp_path: Path
) -> None:
    done = replayed(run, tmp_path / "out")
    mine = json.loads((done.folder / "result.json").read_text())
    runs = json.loads((run / "result.json").read_text())
    assert set(mine) - set(runs) == {"replay"}
    for key in ("schema", "scenario", "robot", "seed", "configuration", "simulated_seconds"):
        assert mine[key] == runs[key]
    for key in ("steps_taken", "replans", "behaviour"):
        assert mine[key] == runs[key]
    assert not {"outcome", "falls", "collisions", "surfaces", "path_length"} & set(mine)
    ours, theirs = mine["localization"], runs["localization"]
    for name, spread in ours.items():
        assert spread == pytest.approx(theirs[name], abs=1e-12)


def test_each_pose_of_the_believed_way_is_known_to_be_climbed_or_not(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The last tick of a run has a pose, but no picture."""
    seen = []
    write = replay_module.write_folder

    def look(
        folder: Path,
        scenario: Scenario,
        result: ReplayResult,
        found: Findings,
        voxels: NDArray[np.float32],
    ) -> None:
        seen.append((len(found.estimate.positions()), len(found.stairs.climbing)))
        write(folder, scenario, result, found, voxels)

    monkeypatch.setattr(replay_module, "write_folder", look)
    replayed(run, tmp_path / "out")
    [(poses, told)] = seen
    assert poses == told


def test_another_component_gets_the_same_data_and_the_first_difference_is_told(
    run: Path, tmp_path: Path
) -> None:
    done = replayed(run, tmp_path / "out", "navigation.behaviour=walking")
    facts = done.result.replay
    assert facts.changed
    assert done.passed
    assert facts.observations == 200
    assert facts.first_difference is not None
    assert done.result.configuration["navigation"]["behaviour"] == "walking"


def test_a_parameter_can_be_another(run: Path, tmp_path: Path) -> None:
    done = replayed(run, tmp_path / "out", "navigation.fog.cell=0.05")
    assert done.result.configuration["navigation"]["fog"] == {"cell": 0.05}


def test_a_map_is_made_for_a_localizer_that_asks_for_one(run: Path, tmp_path: Path) -> None:
    done = replayed(run, tmp_path / "out", "navigation.localizer=monte_carlo")
    assert done.result.replay.observations == 200


def test_a_class_of_the_users_replays(run: Path, tmp_path: Path) -> None:
    done = replayed(run, tmp_path / "out", "navigation.planner=user_parts:Straight")
    assert done.passed
    again = replayed(run, tmp_path / "again", planner=user_parts.Straight())
    assert again.result.replay.changed
    assert again.result.replay.first_difference == done.result.replay.first_difference


def test_an_exception_of_a_users_class_ends_the_replay_with_its_name(
    run: Path, tmp_path: Path
) -> None:
    class Broken(user_parts.Straight):
        def plan(self, *_: object) -> Plan:
            raise ArithmeticError("of all things")

    done = replayed(run, tmp_path / "out", planner=Broken())
    assert not done.passed
    error = str(done.result.replay.error)
    assert error.startswith("error: planner: Broken: ArithmeticError")
    assert "of all things" in error
    assert "test_replay.py:" in error


def test_a_call_that_takes_too_long_ends_the_replay(run: Path, tmp_path: Path) -> None:
    class Slow(user_parts.Straight):
        def plan(self, *_: object) -> Plan:
            time.sleep(60.0)
            raise AssertionError

    done = replayed(run, tmp_path / "out", "navigation.call_limit=0.2", planner=Slow())
    assert not done.passed
    assert "planner: Slow: took longer than 0.2 s" in str(done.result.replay.error)


def test_without_answers_to_compare_with_it_is_no_success(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from treadwell.replaying import replay as module

    monkeypatch.setattr(module, "read_answers", lambda _: iter(()))
    assert not replayed(run, tmp_path / "out").passed
    monkeypatch.setattr(module, "read_observations", lambda _: iter(()))
    with pytest.raises(InputError, match="not one observation"):
        replayed(run, tmp_path / "empty")
    assert not (tmp_path / "empty").exists()


@pytest.mark.parametrize(
    ("setting", "word"),
    [
        ("physics.friction=0.2", "navigation"),
        ("navigation=3", "navigation"),
        ("seed=4", "navigation"),
        ("navigation.localizer=truth", "simulator"),
        ("navigation.planner=a_sta", "did you mean 'a_star'"),
        ("navigation.fog.cel=1", "cel"),
        ("navigation.fog.cell=-1", "cell"),
        ("nonsense", "KEY=VALUE"),
        ("navigation.planner=no_such_module:Class", "no_such_module"),
    ],
)
def test_a_setting_that_cannot_be_is_bad_input_and_leaves_nothing(
    run: Path, tmp_path: Path, setting: str, word: str
) -> None:
    with pytest.raises(InputError, match=word):
        replayed(run, tmp_path / "out", setting)
    assert not (tmp_path / "out").exists()


@pytest.fixture(scope="module")
def by_truth(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run whose localizer was given the truth, and whose planner was an object."""
    settings = ("time_limit=0.2", "navigation.localizer=truth")
    out = tmp_path_factory.mktemp("truth") / "run"
    planner = user_parts.Straight()
    return treadwell.run("slalom", overrides=settings, out=out, planner=planner).folder


def test_what_a_recording_does_not_hold_is_refused_by_name(by_truth: Path, tmp_path: Path) -> None:
    out, odometry = tmp_path / "out", "navigation.localizer=odometry"
    with pytest.raises(InputError, match=r"planner was an object of user_parts:Straight"):
        replayed(by_truth, out)
    with pytest.raises(InputError, match=r"localizer: found 'truth'"):
        replayed(by_truth, out, planner=user_parts.Straight())
    assert replayed(by_truth, out, odometry, "navigation.planner=a_star").passed


def test_a_log_that_was_cut_is_replayed_up_to_the_cut(run: Path, tmp_path: Path) -> None:
    copy = tmp_path / "cut"
    copy.mkdir()
    content = (run / NAME).read_bytes()
    (copy / NAME).write_bytes(content[: len(content) // 2])
    done = replayed(copy, tmp_path / "out")
    facts = done.result.replay
    assert done.passed
    assert 10 < facts.observations < 200
    assert facts.compared >= facts.observations - 1
    assert f"{facts.observations} observations" in str(facts.broken)
    assert "bytes of the file are lost" in str(facts.broken)


@pytest.mark.parametrize("kept", [0.0, 0.001, 0.02])
def test_a_log_of_which_nothing_is_left_is_bad_input(
    run: Path, tmp_path: Path, kept: float
) -> None:
    copy = tmp_path / "cut"
    copy.mkdir()
    content = (run / NAME).read_bytes()
    (copy / NAME).write_bytes(content[: int(kept * len(content))])
    with pytest.raises(InputError, match=NAME):
        replayed(copy, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_core_is_given_no_truth(run: Path) -> None:
    source = open_source(run)
    told = json.loads(source.core.settings)
    assert set(told) == {"robot", "start", "goals", "navigation"}


WITHOUT_MUJOCO = """
import sys
from pathlib import Path
sys.modules["mujoco"] = None
import treadwell
assert treadwell.replay(Path(sys.argv[1]), out=Path(sys.argv[2])).passed
"""


def test_no_mujoco_is_needed(runs: dict[str, Path], tmp_path: Path) -> None:
    command = [sys.executable, "-c", WITHOUT_MUJOCO, str(runs["nao_2"]), str(tmp_path / "out")]
    subprocess.run(command, check=True)


def call(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    status = execute(arguments)
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def test_the_command_says_what_came_of_it(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = call(capsys, "replay", str(run), "--out", str(tmp_path / "out"))
    assert status == 0
    assert "the same in all 200 ticks, bit for bit" in out
    assert str(tmp_path / "out") in err
    status, out, _ = call(capsys, "replay", str(run), "--out", str(tmp_path / "out"), "--json")
    assert status == 2
    assert "exists already" in json.loads(out)["error"]
    status, _, err = call(capsys, "replay", str(tmp_path / "nowhere"))
    assert status == 2
    assert "no recording to replay" in err


def test_a_replay_lies_beside_its_run_and_overwrites_nothing(run: Path) -> None:
    first, second = treadwell.replay(run), treadwell.replay(run)
    assert first.folder.parent == second.folder.parent == run.parent
    assert first.folder.name == f"{run.name}-replay"
    assert second.folder != first.folder
