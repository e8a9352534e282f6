"""Claims about `verify`: a whole run passes, and everything that is wrong is named."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from episode_builders import grid, qrio, result, trace, world
from test_cdr import observation

from treadwell.judging.result import Result, read_result
from treadwell.poses import pose_matrix
from treadwell.processor import processor
from treadwell.recording.map_file import write_map
from treadwell.recording.map_picture import caption_of, draw_map
from treadwell.recording.observation_log import ObservationLog
from treadwell.recording.recorder import Recorder
from treadwell.recording.scenario_file import write_scenario
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.trajectory import Trajectory
from treadwell.recording.verification import verify, verify_run

TICKS = 40


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of 0.4 seconds in which the robot stands."""
    folder = tmp_path_factory.mktemp("runs") / "run"
    folder.mkdir()
    made = world()
    recorder = Recorder(folder / "recording.rrd", made.model, made.course, made.scenario, qrio())
    log = ObservationLog(folder, made.scenario, qrio())
    trajectory = Trajectory()
    for tick in range(TICKS):
        log.write(observation(time_ns=tick * 10_000_000))
        if tick % 8 == 0:
            recorder.frame(trace(made, tick * 10_000_000))
            trajectory.add(tick * 10_000_000, pose_matrix(0.0, 0.0, 0.0, 0.0))
        made.stand(0.01)
    log.close()
    recorder.close()
    trajectory.write(folder / "trajectory.tum")
    trajectory.write(folder / "trajectory_truth.tum")
    made.simulation.save_audit(folder)
    facts = {"version": version(), "processor": processor()}
    told = result(made.scenario, simulated_seconds=0.01 * TICKS, **facts)
    draw_map(
        folder / "map.png",
        made.course,
        caption_of(told),
        grid(),
        trajectory,
        trajectory,
        StairMemory(),
    )
    write_map(folder / "map.npz", grid(), np.empty((0, 4), np.float32))
    write_scenario(folder / "scenario.toml", made.scenario)
    told.write(folder / "result.json")
    return folder


def version() -> str:
    import treadwell

    return treadwell.__version__


@pytest.fixture
def copy(run: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(run, tmp_path / "copy"))


def test_a_whole_run_passes(run: Path) -> None:
    (found,) = verify([run])
    assert found.problems == ()
    assert found.passed
    assert found.steps == 5 * TICKS
    assert found.first_difference is None


def test_a_run_without_recordings_passes(copy: Path) -> None:
    (copy / "recording.rrd").unlink()
    (copy / "observations.mcap").unlink()
    assert verify_run(copy).passed


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "result.json",
        "trajectory.tum",
        "trajectory_truth.tum",
        "map.png",
        "map.npz",
        "scenario.toml",
        "model.mjb",
        "physics.npz",
        "recording.rrd",
        "observations.mcap",
    ],
)
@pytest.mark.parametrize("harm", ["missing", "empty", "half", "noise"])
def test_a_broken_file_is_named(copy: Path, name: str, harm: str) -> None:
    path = copy / name
    content = path.read_bytes()
    if harm == "missing":
        path.unlink()
    else:
        half = content[: len(content) // 2]
        path.write_bytes({"empty": b"", "half": half, "noise": b"\xff\x00" * 500}[harm])
    found = verify_run(copy)
    assert not found.passed
    if (name, harm) == ("result.json", "missing"):
        assert found.cut is not None
    else:
        assert any(name in problem for problem in found.problems)


def test_the_first_step_that_differs_is_told(copy: Path) -> None:
    with np.load(copy / "physics.npz") as file:
        arrays = dict(file)
    arrays["qpos"][20, 9] += 1e-12
    np.savez(copy / "physics.npz", **arrays)
    found = verify_run(copy)
    assert found.first_difference == 105
    assert any("step 105" in problem for problem in found.problems)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"processor": "x86_64, Old Chip, avx"}, True),
        ({}, False),
        ({"processor": None}, False),
        ({"processor": "x86_64, Old Chip, avx", "version": "9.9.9"}, False),
    ],
)
def test_another_processor_is_named_as_the_reason_where_only_it_differs(
    copy: Path, changes: dict[str, object], named: bool
) -> None:
    with np.load(copy / "physics.npz") as file:
        arrays = dict(file)
    arrays["qpos"][20, 9] += 1e-12
    np.savez(copy / "physics.npz", **arrays)
    changed(copy, **changes)
    (physics,) = [each for each in verify_run(copy).problems if "physics.npz" in each]
    assert ("another processor: x86_64, Old Chip, avx; here: " in physics) == named
    assert "\n" not in physics


def test_another_processor_alone_is_no_fault(copy: Path) -> None:
    for name in ("recording.rrd", "observations.mcap"):
        (copy / name).unlink()
    changed(copy, processor="x86_64, Old Chip, avx")
    assert verify_run(copy).passed


def test_a_run_of_before_the_processor_was_told_passes(copy: Path) -> None:
    for name in ("recording.rrd", "observations.mcap"):
        (copy / name).unlink()
    text = (copy / "result.json").read_text()
    lines = [line for line in text.splitlines() if '"processor"' not in line]
    assert len(lines) < len(text.splitlines())
    (copy / "result.json").write_text("\n".join(lines))
    assert read_result(copy / "result.json").processor is None
    assert verify_run(copy).passed


def changed(folder: Path, **changes: object) -> None:
    table: Result = read_result(folder / "result.json")
    table.model_copy(update=changes).write(folder / "result.json")


@pytest.mark.parametrize(
    ("harm", "word"),
    [
        (lambda folder: changed(folder, simulated_seconds=7.0), "different runs"),
        (lambda folder: changed(folder, seed=5), "seed"),
        (lambda folder: changed(folder, version="9.9.9"), "version"),
        (lambda folder: (folder / "trajectory.tum").write_text(""), "poses"),
    ],
)
def test_files_of_different_runs_do_not_belong_together(
    copy: Path, harm: Callable[[Path], object], word: str
) -> None:
    harm(copy)
    found = verify_run(copy)
    assert any(word in problem for problem in found.problems)


def test_a_run_that_is_not_there_is_named(tmp_path: Path) -> None:
    (found,) = verify([tmp_path / "nowhere"])
    assert not found.passed
    assert "nowhere" in found.problems[0]


@pytest.mark.parametrize(
    ("outcome", "lacking", "whole"),
    [
        ("goal_reached", 1, False),
        ("interrupted", 1, True),
        ("interrupted", 2, False),
        ("error", 20, True),
    ],
)
def test_only_a_run_that_ended_early_may_lack_its_last_ticks(
    copy: Path, outcome: str, lacking: int, whole: bool
) -> None:
    told = json.loads((copy / "result.json").read_text())
    told |= {"outcome": outcome, "simulated_seconds": 0.01 * (TICKS + lacking)}
    (copy / "result.json").write_text(json.dumps(told))
    assert verify_run(copy).passed == whole


@pytest.mark.parametrize("outcome", ["interrupted", "error"])
def test_half_a_log_is_no_early_end(copy: Path, outcome: str) -> None:
    told = json.loads((copy / "result.json").read_text()) | {"outcome": outcome}
    told["simulated_seconds"] = 0.01 * (TICKS + 400)
    (copy / "result.json").write_text(json.dumps(told))
    assert not verify_run(copy).passed
