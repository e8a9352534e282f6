"""Claims about result.json: its keys, its verdict, and that it is written whole or not at all."""

import json
from pathlib import Path

import pytest
from episode_builders import result, scenario
from pydantic import ValidationError

from treadwell.errors import InputError
from treadwell.judging.result import (
    STAGES,
    CollisionEntry,
    Result,
    Spread,
    SurfaceEntry,
    read_result,
)
from treadwell.judging.result import LocalizationErrors as Errors
from treadwell.scenario.model import Expect

KEYS = [
    "schema",
    "scenario",
    "robot",
    "seed",
    "version",
    "processor",
    "configuration",
    "ablation",
    "outcome",
    "reason",
    "passed",
    "failures",
    "simulated_seconds",
    "wall_seconds",
    "real_time_factor",
    "physics_real_time_factor",
    "falls",
    "collisions",
    "steps_taken",
    "footsteps_planned",
    "footsteps_refused",
    "stairs_climbed",
    "stairs_descended",
    "path_length",
    "replans",
    "localization",
    "surfaces",
    "map",
    "behaviour",
    "footstep_plans",
    "timing_ms",
]
NOTHING = Spread(mean=0.0, std=0.0, max=0.0)


def test_the_file_has_the_contracts_keys_in_its_order(tmp_path: Path) -> None:
    path = tmp_path / "result.json"
    result(scenario()).write(path)
    table = json.loads(path.read_text())
    assert list(table) == KEYS
    assert table["schema"] == "treadwell.result/1"
    assert set(table["map"]) == {
        "floor_cells",
        "floor_cells_right",
        "obstacle_cells",
        "obstacle_cells_right",
        "floor_called_obstacle",
        "obstacle_called_floor",
        "whole_obstacle_cells",
        "whole_obstacle_called_floor",
    }
    assert STAGES[0] == "physics"


def test_what_is_written_is_what_is_read(tmp_path: Path) -> None:
    made = result(
        scenario(),
        collisions=[CollisionEntry(time=1.0, robot_part="head", element="box", impulse=0.4)],
        surfaces=[SurfaceEntry(element="a", part="top", truth=0.03, estimate=None, cells=0)],
    )
    path = tmp_path / "result.json"
    made.write(path)
    assert read_result(path) == made


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_number_that_is_none_is_refused(value: float) -> None:
    with pytest.raises(ValidationError):
        result(scenario(), simulated_seconds=value)


def test_an_unknown_key_is_refused() -> None:
    with pytest.raises(ValidationError):
        result(scenario(), speed=1.0)


def test_a_goal_reached_without_a_fall_passes() -> None:
    judged = result(scenario()).judged_by(Expect())
    assert judged.passed
    assert judged.failures == []


@pytest.mark.parametrize(
    ("changes", "expect", "word"),
    [
        ({"outcome": "fell"}, {}, "outcome"),
        ({"outcome": "goal_reached"}, {"outcome": "refused"}, "outcome"),
        ({"falls": 1}, {}, "max_falls"),
        ({"simulated_seconds": 9.1}, {"max_time": 9.0}, "max_time"),
        ({"localization": None}, {"max_translation_error": 0.1}, "max_translation_error"),
        ({"surfaces": []}, {"max_height_error": 0.004}, "max_height_error"),
    ],
)
def test_each_expectation_that_is_not_met_is_named(
    changes: dict[str, object], expect: dict[str, object], word: str
) -> None:
    judged = result(scenario(), **changes).judged_by(Expect(**expect))
    assert not judged.passed
    assert len(judged.failures) == 1
    assert judged.failures[0].startswith(word)


@pytest.mark.parametrize(
    ("reason", "told"),
    [
        ("stuck: the robot came away no more", "stuck (the robot came away no more)"),
        ("elsewhere: far off", "stuck (elsewhere: far off)"),
        (None, "stuck"),
    ],
)
def test_what_ended_a_run_is_said_once(reason: str | None, told: str) -> None:
    judged = result(scenario(), outcome="stuck", reason=reason).judged_by(Expect())
    assert judged.failures == [f"outcome: {told}, expected goal_reached"]


def test_limits_are_met_at_their_value() -> None:
    errors = Errors(
        translation_error=Spread(mean=0.1, std=0.0, max=0.3),
        heading_error=NOTHING,
        odometry_translation_error=NOTHING,
    )
    surface = SurfaceEntry(element="a", part="top", truth=0.03, estimate=0.034, cells=3)
    made = result(scenario(), localization=errors, surfaces=[surface], simulated_seconds=9.0)
    limits = Expect(max_time=9.0, max_translation_error=0.1, max_height_error=0.0041)
    assert made.judged_by(limits).passed
    assert not made.judged_by(Expect(max_height_error=0.0039)).passed


def test_a_surface_that_was_passed_unseen_meets_no_limit() -> None:
    surface = SurfaceEntry(element="a", part="top", truth=0.03, estimate=None, cells=0)
    made = result(scenario(), surfaces=[surface])
    assert not made.judged_by(Expect(max_height_error=1.0)).passed


def test_a_write_that_fails_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "result.json"
    result(scenario()).write(path)
    before = path.read_text()
    broken = Result.model_construct(**(dict(result(scenario())) | {"wall_seconds": float("nan")}))
    with pytest.raises(ValueError, match="JSON"):
        broken.write(path)
    assert path.read_text() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["result.json"]


@pytest.mark.parametrize("text", ["", "{", '{"schema": "other/1"}', "[]", "\udcff"])
def test_a_broken_file_is_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "result.json"
    path.write_bytes(text.encode(errors="surrogateescape"))
    with pytest.raises(InputError, match=r"result\.json"):
        read_result(path)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("simulated_seconds", 1e308),
        ("simulated_seconds", -1.0),
        ("configuration", {"goal": float("nan")}),
        ("behaviour", [{"time": 1e300, "state": "walking"}]),
    ],
)
def test_a_number_that_nothing_can_be_made_of_is_named(
    tmp_path: Path, key: str, value: object
) -> None:
    table = result(scenario()).model_dump(mode="json", by_alias=True) | {key: value}
    (tmp_path / "result.json").write_text(json.dumps(table))
    with pytest.raises(InputError, match=rf"result\.json: {key}"):
        read_result(tmp_path / "result.json")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nothing here"):
        read_result(tmp_path / "nothing here")
