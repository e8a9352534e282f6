"""A run from start to verdict: its result, its folder, and what it says when it cannot go on."""

import json
from pathlib import Path
from typing import Any

import pytest
from user_parts import Legs

import treadwell
from treadwell._core import BodyState, Pilot
from treadwell.errors import InputError, RecordingError
from treadwell.judging.result import read_result
from treadwell.map_memory import UNKNOWN
from treadwell.physics.simulation import Simulation
from treadwell.protocols import Pose
from treadwell.recording.map_file import read_map
from treadwell.recording.observation_log import read_observations
from treadwell.recording.trajectory import read_trajectory
from treadwell.recording.verification import verify_run
from treadwell.runner import Run

ALWAYS = {
    "result.json", "trajectory.tum", "trajectory_truth.tum", "map.png", "model.mjb", "physics.npz",
    "map.npz", "scenario.toml",
}  # fmt: skip
RECORDED = {"recording.rrd", "observations.mcap"}
SECONDS = ("time_limit=2",)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Run:
    out = tmp_path_factory.mktemp("runs") / "run"
    return treadwell.run("slalom", seed=4, overrides=SECONDS, out=out)


def test_a_run_leaves_all_its_files_and_they_belong_together(recorded: Run) -> None:
    assert {path.name for path in recorded.folder.iterdir()} == ALWAYS | RECORDED
    found = verify_run(recorded.folder)
    assert found.problems == ()
    assert found.steps == 1000


class Relocated(Legs):
    """A localizer that finds by its sixth frame that it had been 12 m to the side all along."""

    def estimate(self, body: BodyState) -> Pose:
        x, y, z, yaw = super().estimate(body)
        return x, y + 12.0 * (self.corrections > 5), z, yaw


def test_who_finds_itself_elsewhere_has_no_map_left_of_where_it_was_not(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    treadwell.run(
        "open_floor", localizer=Relocated, overrides={"time_limit": 1.5}, out=folder, record=False
    )
    found = read_map(folder / "map.npz").surface
    known = found.centres()[found.kind != UNKNOWN]
    assert len(known) > 20
    assert known[:, 1].min() > 8.0


def test_without_recording_the_rest_stays(tmp_path: Path) -> None:
    out = tmp_path / "run"
    treadwell.run("slalom", overrides=("time_limit=0.5",), out=out, record=False)
    assert {path.name for path in out.iterdir()} == ALWAYS
    assert verify_run(out).passed


def test_recording_changes_nothing_of_the_result(recorded: Run, tmp_path: Path) -> None:
    plain = treadwell.run("slalom", seed=4, overrides=SECONDS, out=tmp_path / "run", record=False)
    assert untimed(plain.document) == untimed(recorded.document)


def untimed(document: dict[str, Any]) -> dict[str, Any]:
    timed = {"wall_seconds", "real_time_factor", "physics_real_time_factor", "timing_ms"}
    assert timed <= set(document)
    return {key: value for key, value in document.items() if key not in timed}


def test_the_result_says_what_was_run_and_how_it_ended(recorded: Run) -> None:
    document = json.loads((recorded.folder / "result.json").read_text())
    assert document == recorded.document
    assert read_result(recorded.folder / "result.json") == recorded.result
    assert document["schema"] == "treadwell.result/1"
    assert (document["scenario"], document["robot"], document["seed"]) == ("slalom", "qrio", 4)
    assert document["version"] == treadwell.__version__
    assert document["configuration"]["time_limit"] == 2.0
    assert document["configuration"]["start"]["yaw"] != 0.0  # drawn from the seed
    assert document["outcome"] == recorded.outcome == "timed_out"
    assert document["reason"] == "timed_out: 2 s were over"
    assert document["passed"] is recorded.passed is False
    assert document["failures"]
    assert document["simulated_seconds"] == pytest.approx(2.0)
    assert document["behaviour"][0]["time"] == 0.0
    assert document["localization"]["translation_error"]["max"] < 0.05
    assert document["map"]["floor_cells"] > 20
    assert document["surfaces"] == []


def test_timing_has_every_stage_with_its_count(recorded: Run) -> None:
    timing = recorded.document["timing_ms"]
    assert set(timing) == {"physics", "depth", *Pilot.stages}
    assert timing["physics"]["count"] == timing["walk"]["count"] == 200
    assert 10 < timing["segment"]["count"] <= 26
    for entry in timing.values():
        assert 0.0 <= entry["median"] <= entry["p99"] <= entry["max"]


def test_trajectories_and_observations_cover_the_run(recorded: Run) -> None:
    for name in ("trajectory.tum", "trajectory_truth.tum"):
        poses = read_trajectory(recorded.folder / name)
        assert poses[0, 0] == 0.0
        assert poses[-1, 0] == pytest.approx(2.0, abs=0.1)
    seen = list(read_observations(recorded.folder / "observations.mcap"))
    assert [one.time_ns for one in seen] == [i * 10_000_000 for i in range(200)]
    assert 20 < sum(one.depth is not None for one in seen) < 27


def test_bad_input_writes_nothing(tmp_path: Path) -> None:
    out = tmp_path / "run"
    for overrides in (("navigation.fog.cell=0",), ("physics.friction=nan",), ("nothing=1",)):
        with pytest.raises(InputError):
            treadwell.run("slalom", overrides=overrides, out=out)
        assert not out.exists()


def test_without_a_folder_it_makes_one_that_latest_leads_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = treadwell.run("slalom", seed=9, overrides=("time_limit=0.1",), record=False)
    assert done.folder.parent == Path("runs")
    assert done.folder.name.startswith("slalom-qrio-9-")
    assert (tmp_path / "runs" / "latest" / "result.json").is_file()


def test_an_interruption_amid_a_run_is_its_outcome(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    advance, ticks = Simulation.advance, [0]

    def interrupted(self: Simulation, targets: Any) -> None:  # noqa: ANN401 - handed on
        ticks[0] += 1
        if ticks[0] == 30:
            raise KeyboardInterrupt
        advance(self, targets)

    monkeypatch.setattr(Simulation, "advance", interrupted)
    done = treadwell.run("slalom", out=tmp_path / "run", record=False)
    assert done.outcome == "interrupted"
    assert done.result.simulated_seconds == pytest.approx(0.29)
    assert verify_run(done.folder).passed


def test_physics_that_diverge_are_an_error_and_not_a_fall(tmp_path: Path) -> None:
    class Wild:
        def next(self, _: object) -> Any:  # noqa: ANN401 - nothing sensible
            from treadwell.protocols import Decision

            return Decision("wild", velocity=(1e300, -1e300, 1e300))

    out = tmp_path / "run"
    done = treadwell.run("slalom", overrides=SECONDS, out=out, record=False, behaviour=Wild())
    assert done.outcome in {"fell", "error", "timed_out"}
    assert (out / "result.json").is_file()


def test_a_file_that_cannot_be_written_does_not_keep_the_others_from_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("treadwell.recording.map_picture.draw_map", full)
    out = tmp_path / "run"
    with pytest.raises(RecordingError, match=r"not everything could be written: .*No space left"):
        treadwell.run("slalom", overrides=("time_limit=0.2",), out=out, record=False)
    assert {path.name for path in out.iterdir()} == ALWAYS - {"map.png"}


def test_progress_is_told_how_the_run_gets_on(tmp_path: Path) -> None:
    seen: list[tuple[float, str, float, float]] = []

    class Listener:
        def update(self, *facts: Any) -> None:  # noqa: ANN401 - kept as they are
            seen.append(facts)

    listener: Any = Listener()
    treadwell.run(
        "slalom", overrides=SECONDS, out=tmp_path / "run", record=False, progress=listener
    )
    times = [facts[0] for facts in seen]
    assert times == sorted(times)
    assert times[-1] == pytest.approx(2.0, abs=0.1)
    assert seen[-1][2] == pytest.approx(2.8, abs=0.3)
