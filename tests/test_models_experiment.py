"""The experiment `models`: its suite, its tables, recorded data, and a small one whole."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from episode_builders import grid, result, scenario
from experiment_builders import rows_of
from PIL import Image

from treadwell.cli.app import execute
from treadwell.components import COMPONENTS
from treadwell.experiments import conduct as conducting
from treadwell.experiments.catalogue import EXPERIMENTS
from treadwell.experiments.conduct import conduct
from treadwell.experiments.experiment import Beside, Case, Table
from treadwell.experiments.models.experiment import MODELS
from treadwell.experiments.models.recorded import (
    RECORDED,
    Recorded,
    mapped,
    recorded,
    recorded_tables,
    told,
)
from treadwell.experiments.models.suite import CASES, SCENES, WORLD_MODELS, case_name
from treadwell.experiments.models.tables import frames_until_clear, models_tables
from treadwell.judging.result import Timing
from treadwell.measuring.ground_watch import GroundErrors, GroundFindings, GroundWatch
from treadwell.measuring.map_watch import MapFrame
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario

MADE = scenario()
SOME = GroundErrors(100, 0.001, 0.002, 20, 19, 1)
FLAT = """
schema = 1
name = "flat"
time_limit = 0.4
[start]
[goal]
position = [1.0, 0.0]
"""


def frame(stale: int) -> MapFrame:
    return MapFrame(0.0, 0, 0, 40, stale, 0, 0)


def run(
    outcome: str = "goal_reached",
    *,
    errors: GroundErrors = SOME,
    frames: tuple[MapFrame, ...] = (),
    milliseconds: float = 1.0,
    **changes: Any,  # noqa: ANN401 - as `Result` takes them
) -> Run:
    timing = Timing(median=milliseconds, p99=milliseconds, max=milliseconds, count=1)
    facts = {"outcome": outcome, "passed": outcome == "goal_reached", "timing_ms": {"map": timing}}
    made = result(MADE, **{**facts, **changes})
    return Run(made, Path("folder"), findings=GroundFindings(errors, frames))


# --- the suite


def test_every_world_model_there_is_is_run_on_every_scene() -> None:
    assert tuple(COMPONENTS["world_model"]) == WORLD_MODELS
    assert len(CASES) == len(SCENES) * len(WORLD_MODELS)
    assert all(case.watch is GroundWatch for case in CASES)


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.name)
def test_no_model_is_told_what_stands_there(scene: Any) -> None:  # noqa: ANN401 - a scene
    case = next(case for case in CASES if case.scenario == scene.name)
    made = load_scenario(scene.name, overrides=case.overrides)
    if scene.elements:
        assert [element.mapped for element in made.course] == [False] * len(scene.elements)
    else:
        assert made.navigation.localizer == "monte_carlo"


# --- tables


def test_who_did_it_in_every_run_is_named_the_quickest_first() -> None:
    results = {
        "sill_fog": [run(milliseconds=3.0)] * 2,
        "sill_points": [run(milliseconds=1.0)] * 2,
        "sill_octree": [run(), run("refused", reason="blocked: no way")],
    }
    rows = rows_of(models_tables, results, "Which model for what")
    assert rows == {"a sill": ("points, fog", "octree")}
    counts = rows_of(models_tables, results, "Runs as expected")["sill: a sill"]
    by_model = dict(zip(WORLD_MODELS, counts, strict=True))
    assert (by_model["fog"], by_model["octree"]) == ("2 of 2", "1 of 2")
    assert by_model["elevation"] == "-"
    ends = next(one for one in models_tables(results) if one.title.startswith("Runs that ended"))
    assert ends.rows == (("sill", "octree", "refused: blocked", "1", "0"),)


def test_a_goal_that_was_reached_against_expectations_says_which() -> None:
    hit = run(passed=False, failures=["collisions: 2, at most 0"])
    ends = models_tables({"rubble_fog": [hit]})
    told_of = next(one for one in ends if one.title.startswith("Runs that ended")).rows
    assert told_of[0][2] == "collisions: 2, at most 0"


def test_errors_are_of_all_cells_together() -> None:
    few, many = (
        GroundErrors(100, 0.001, 0.003, 10, 10, 0),
        GroundErrors(300, 0.002, 0.001, 30, 20, 2),
    )
    nothing = GroundErrors(0, math.nan, math.nan, 0, 0, 0)
    results = {
        "sill_fog": [run(errors=few), run(errors=nothing)],
        "slope_up_fog": [run(errors=many)],
    }
    row = rows_of(models_tables, results, "The map in the end")["fog"]
    rms = math.sqrt((100 * 9.0 + 300 * 1.0) / 400)
    assert row[:6] == ("400", "1.5", f"{rms:.1f}", "40", "75.0", "5.0")
    assert rows_of(models_tables, results, "Error on planes")["sill"][0] == "1.0"


def test_what_is_gone_is_counted_and_stale_cells_are_no_success() -> None:
    gone = (frame(40), frame(7), frame(0), frame(0))
    results = {
        "box_removed_fog": [run(frames=gone, scenario="box_removed")],
        "box_removed_averaging": [run(frames=gone[:2], scenario="box_removed")],
    }
    made = next(one for one in models_tables(results) if one.title == "What is gone")
    assert made.rows == (
        ("box_removed", "fog", "0", "0 of 1", "2, at most 2"),
        ("box_removed", "averaging", "7", "1 of 1", "-"),
    )
    rows = rows_of(models_tables, results, "Which model for what")
    assert rows["a box that is taken away"] == ("fog", "averaging")
    assert frames_until_clear((frame(0),)) == 0


def test_of_what_was_not_run_there_is_no_table(tmp_path: Path) -> None:
    assert models_tables({}) == []
    assert list(MODELS.pictures({}, tmp_path)) == []
    assert recorded_tables([]) == []


def test_one_scene_is_drawn_as_every_model_has_it(tmp_path: Path) -> None:
    known = grid()
    known.kind[10:20, 10:30] = 1
    known.height[10:20, 10:30] = 0.1
    results = {
        case_name("bridge_under", model): [replace(run(), remembered=seen)]
        for model, seen in (("fog", known), ("elevation", known), ("points", grid()))
    }
    (picture,) = MODELS.pictures(results, tmp_path)
    assert picture.path == tmp_path / "bridge_under.png"
    with Image.open(picture.path) as drawn:
        assert drawn.width > drawn.height > 200


# --- recorded data


def test_without_a_folder_of_data_nothing_is_mapped(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("TREADWELL_DATA", raising=False)
    assert recorded(tmp_path) == []
    monkeypatch.setenv("TREADWELL_DATA", str(tmp_path))
    assert recorded(tmp_path) == []
    (tmp_path / "rgbd_room").mkdir()
    assert [one.model for one in recorded(tmp_path)] == list(WORLD_MODELS)


def cloud(folder: Path) -> Path:
    points = np.stack(np.meshgrid(np.linspace(-1, 1, 40), np.linspace(-1, 1, 40)), -1).reshape(
        -1, 2
    )
    lines = "".join(f"{x:.3f} {y:.3f} 0\n" for x, y in points)
    path = folder / "flat.ply"
    path.write_text(
        f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
        f"property float z\nend_header\n{lines}"
    )
    return path


def test_a_map_of_data_has_its_cells_time_and_memory_and_a_refusal_its_reason(
    tmp_path: Path,
) -> None:
    path = cloud(tmp_path)
    made = mapped(Recorded("a floor", path, "elevation"))
    refused = mapped(Recorded("a floor", path, "fog"))
    assert (made.frames, made.used, made.refused) == (1, 1, "")
    assert made.cells[0] > 100
    assert made.milliseconds > 0.0
    assert "pictures" in refused.refused
    (table,) = recorded_tables([made, refused])
    assert all(len(row) == len(table.header) for row in table.rows)
    assert table.rows[1][:3] == ("a floor", "fog", "finds its floors in pictures")
    assert "1 of 1 frames" in told(made)
    assert RECORDED.work is mapped


# --- the whole of a small one


def double(number: int) -> int:
    return 2 * number


def pieces(_folder: Path) -> list[int]:
    return [3, 4]


def doubled(done: Any) -> list[Table]:  # noqa: ANN401 - as `Beside` has it
    return [Table("Twice", ("what",), tuple((str(one),) for one in done))]


def small(folder: Path) -> Any:  # noqa: ANN401 - an experiment
    path = folder / "flat.toml"
    path.write_text(FLAT)
    cases = tuple(
        Case(f"sill_{model}", str(path), (f"navigation.world_model={model}",), watch=GroundWatch)
        for model in ("fog", "elevation")
    )
    return replace(MODELS, cases=cases, beside=Beside(pieces, double, str, doubled))


def test_a_small_one_leaves_tables_of_runs_and_of_what_is_beside_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(EXPERIMENTS, "models", small(tmp_path))
    arguments = ["experiment", "models", "--seeds", "1", "--workers", "1", "--json"]
    assert execute([*arguments, "--out", str(tmp_path / "out")]) == 1
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    titles = [table["title"] for table in document["tables"]]
    assert titles[0] == "Which model for what"
    assert document["tables"][-1]["rows"] == [["6"], ["8"]]
    assert "2 of 2: 8" in captured.err
    page = (tmp_path / "out" / "experiment.md").read_text()
    assert "## Twice" in page
    assert not document["interrupted"]


def test_after_an_interruption_nothing_is_begun_beside_and_what_there_is_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(conducting, "run_episode", stop)
    report = conduct(small(tmp_path), range(1), tmp_path / "out")
    assert report.interrupted
    assert report.tables == ()
    assert (tmp_path / "out" / "experiment.md").is_file()


def test_cases_that_are_named_are_run_alone(tmp_path: Path) -> None:
    assert small(tmp_path).narrowed(["sill_fog"]).beside is None
    assert small(tmp_path).narrowed([]).beside is not None
