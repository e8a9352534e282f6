"""What the core is told before the first tick: robot, start, goals, navigation."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from core_builders import settings_text
from robot_builders import qrio_copy
from user_parts import Straight

from treadwell.core_settings import core_settings, user_components
from treadwell.course.build import build_course
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario


def told(*overrides: str, seed: int | None = None, scenario: str = "slalom") -> dict[str, Any]:
    robot = load_robot("qrio")
    made = load_scenario(scenario, seed=seed, overrides=overrides)
    document: dict[str, Any] = json.loads(core_settings(made, robot, build_course(made, robot)))
    return document


def test_nothing_of_course_events_physics_or_noise_is_told() -> None:
    document = told()
    assert set(document) == {"robot", "start", "goals", "navigation"}
    text = settings_text()
    for word in ("second", "cylinder", "friction", "noisy", "mass_scale", "seed"):
        assert f'"{word}"' not in text


def test_the_start_is_the_true_one() -> None:
    made = load_scenario("slalom", seed=5)
    start = told(seed=5)["start"]
    assert start["position"] == pytest.approx(made.start.position)
    assert start["yaw"] == pytest.approx(made.start.yaw)
    assert start["height"] == pytest.approx(0.0)
    assert start != told(seed=6)["start"]


@pytest.mark.parametrize("localizer", ["odometry", "scan_match"])
def test_a_start_that_is_not_known_is_not_told_and_odometry_cannot_do_without(
    localizer: str,
) -> None:
    document = told("start.known=false", seed=5)
    assert document["start"] is None
    overrides = ("start.known=false", f"navigation.localizer={localizer}")
    made = load_scenario("slalom", overrides=overrides)
    expected = rf"start\.known: found false; the localizer {localizer}"
    with pytest.raises(InputError, match=expected):
        user_components(made, {})


def test_goals_come_in_order_the_via_points_first() -> None:
    document = told("goal.via=[[0.4, 0.5], [1.0, 0.6]]", "goal.radius=0.2", "goal.height=0.0")
    assert [goal["position"] for goal in document["goals"]] == [[0.4, 0.5], [1.0, 0.6], [2.8, 0.0]]
    assert {goal["radius"] for goal in document["goals"]} == {0.2}
    assert document["goals"][-1]["height"] == 0.0


def test_a_goal_without_a_height_lies_on_the_highest_surface_there() -> None:
    rises = [told(scenario="random_stairs", seed=seed)["goals"][-1]["height"] for seed in (1, 2)]
    for seed, height in zip((1, 2), rises, strict=True):
        made = load_scenario("random_stairs", seed=seed)
        stairs = made.course[0].model_dump()
        assert height == pytest.approx(stairs["steps"] * stairs["rise"], abs=1e-6)
    assert rises[0] != rises[1]
    on_the_floor = told("goal.position=[0.3, 0.4]", scenario="random_stairs", seed=1)
    assert on_the_floor["goals"][-1]["height"] is None
    under = told("goal.height=0.0", "goal.position=[0.3, 0.4]", scenario="random_stairs", seed=1)
    assert under["goals"][-1]["height"] == 0.0


def test_a_table_of_parameters_goes_through_untouched() -> None:
    document = told("navigation.fog.cell=0.05", "navigation.self_filter.margin=0.02")
    assert document["navigation"]["fog"] == {"cell": 0.05}
    assert document["navigation"]["self_filter"] == {"margin": 0.02}
    assert document["navigation"]["planner"] == "a_star"


_BOTH = ("navigation.fog.cell=0.05", "navigation.climbing.ascend={step_max_z=0.03}")


def test_a_robots_own_parameters_lie_under_the_scenarios() -> None:
    robot = load_robot("qrio")
    ascend = {"step_max_z": 0.04, "approach_x": 0.0}
    tables = {"fog": {"cell": 0.03, "headroom": 0.7}, "climbing": {"ascend": ascend}}
    file = robot.file.model_copy(update={"navigation": tables})
    made = load_scenario("slalom", overrides=_BOTH)
    settings = core_settings(made, replace(robot, file=file), build_course(made, robot))
    navigation = json.loads(settings)["navigation"]
    assert navigation["fog"] == {"cell": 0.05, "headroom": 0.7}
    assert navigation["climbing"] == {"ascend": {"step_max_z": 0.03, "approach_x": 0.0}}


def test_components_of_the_users_are_loaded_and_given_ones_beat_the_files() -> None:
    named = load_scenario("slalom", overrides=("navigation.planner=user_parts:Straight",))
    assert type(user_components(named, {})["planner"]).__name__ == "Straight"
    mine = Straight()
    assert user_components(named, {"planner": mine}) == {"planner": mine}
    assert user_components(load_scenario("slalom"), {}) == {}


@pytest.mark.parametrize(
    ("gait", "said"),
    [
        ("step_time = 1e-300", "step_time must be > 0 and <= 60"),
        ("step_time = 1e308", "step_time must be > 0 and <= 60"),
        ("step_time = -0.0", "step_time must be > 0 and <= 60"),
        ("step_time = 0.5\nreference_pull = 1e9", "reference_pull must be from 0 to 100"),
        ("step_time = 0.5\nmax_extension = 0.001", "max_extension must be >= 0.5 and < 1"),
    ],
)
def test_a_gait_that_cannot_be_is_bad_input_of_the_robots(
    tmp_path: Path, gait: str, said: str
) -> None:
    toml = qrio_copy(tmp_path) / "robot.toml"
    text = toml.read_text(encoding="utf-8")
    toml.write_text(text.replace("step_time = 0.5", gait), encoding="utf-8")
    with pytest.raises(InputError, match=rf"robot .*qrio: walker: gait\.{said}"):
        Episode("open_floor", robot=str(toml.parent))
