"""The experiment `robots`: who takes part, what is run of each, and what its table counts."""

import json
from pathlib import Path
from typing import Any

import pytest
from episode_builders import result, scenario
from experiment_builders import rows_of
from robot_builders import qrio_copy

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.experiments.catalogue import EXPERIMENTS
from treadwell.experiments.experiment import NOTHING
from treadwell.experiments.robots import (
    COURSES,
    OF_ANY,
    ROBOTS,
    WANTED,
    Entrant,
    robots_experiment,
    robots_tables,
)
from treadwell.judging.result import CollisionEntry
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario

MADE = scenario()
QRIO, T1 = Entrant("qrio", "qrio"), Entrant("booster_t1", "/robots/booster_t1")
TOUCH = CollisionEntry(time=1.0, robot_part="left_foot", element="first", impulse=0.1)


def run(outcome: str = "goal_reached", course: str = "slalom", **facts: Any) -> Run:  # noqa: ANN401
    facts.setdefault("configuration", load_scenario(course).configuration())
    return Run(result(MADE, outcome=outcome, **facts), Path("folder"))


def test_every_robot_that_ships_walks_each_course_multiplied_to_it() -> None:
    assert EXPERIMENTS["robots"] is ROBOTS
    assert {case.name for case in ROBOTS.cases} == {
        f"{course}_{robot}" for course in COURSES for robot in ("qrio", "nao")
    }
    for case in ROBOTS.cases:
        made = load_scenario(str(case.scenario), seed=1, overrides=case.overrides)
        assert made.scale_to_robot
        assert f"{made.name}_{made.robot}" == case.name


def test_robots_of_the_users_take_part_by_name_and_by_folder(tmp_path: Path) -> None:
    first, second = (qrio_copy(tmp_path / name) for name in ("a", "b c"))
    made = robots_experiment(["nao", str(first), str(second), "nao"])
    names = [case.name for case in made.cases if case.scenario == "slalom"]
    assert names == ["slalom_nao", "slalom_qrio", "slalom_qrio_2"]
    last = load_scenario("slalom", overrides=made.cases[-1].overrides)
    assert last.robot == str(second.resolve())


@pytest.mark.parametrize("robot", ["qiro", "/nowhere/robot", ""])
def test_what_is_no_robot_is_told_before_anything_runs(
    robot: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert execute(["experiment", "robots", "--robots", robot, "--out", str(out)]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("error: robot: there is no robot")
    assert len(captured.err.splitlines()) == 1
    assert not out.exists()


def test_an_experiment_about_certain_robots_takes_no_others() -> None:
    with pytest.raises(InputError, match="--robots: stairs has robots of its own"):
        EXPERIMENTS["stairs"].with_robots(["nao"])
    assert EXPERIMENTS["stairs"].with_robots([]) is EXPERIMENTS["stairs"]


@pytest.mark.parametrize(
    ("label", "wanted"),
    [
        ("qrio", WANTED["qrio"]),
        ("robotis_op3", WANTED["op3"]),
        ("toddlerbot_2xc", WANTED["toddlerbot"]),
        ("booster_t1", WANTED["t1"]),
        ("Booster-T1", WANTED["t1"]),
        ("bot10", OF_ANY),
    ],
)
def test_what_is_wanted_goes_by_the_robots_name(label: str, wanted: tuple[int, ...]) -> None:
    assert Entrant(label, label).wanted == wanted


def test_goals_falls_and_touches_are_counted_and_the_steps_in_the_robots_lengths() -> None:
    results = {
        "open_floor_booster_t1": [run(scale=2.0)] * 4,
        "slalom_booster_t1": [run(scale=2.0)] * 2 + [run(scale=2.0, collisions=[TOUCH] * 2)],
        "stairs_up_booster_t1": [
            run(scale=2.0, course="stairs_up"),
            run("fell", scale=2.0, course="stairs_up", falls=1),
            run("refused", scale=2.0, course="stairs_up"),
        ],
        "slalom_qrio": [run()],
    }
    rows = rows_of(robots_tables([QRIO, T1]), results, "Robots")
    assert rows["booster_t1"] == (
        "2",
        "4 of 4",
        "2 of 3 (2 touches)",
        "1 of 3 (1 fall)",
        NOTHING,
        "19, 19, 18, 16",
        "slalom, stairs_up",
        "60",
        "0.12",
    )
    assert rows["qrio"][0] == "1"
    assert rows["qrio"][2] == "1 of 1"
    assert rows["qrio"][-2:] == (NOTHING, NOTHING)


@pytest.mark.parametrize(("good", "short"), [(19, NOTHING), (18, "open_floor")])
def test_the_share_that_is_wanted_holds_for_any_number_of_seeds(good: int, short: str) -> None:
    for times in (1, 2):
        runs = [run()] * (good * times) + [run("timed_out")] * ((20 - good) * times)
        rows = rows_of(robots_tables([T1]), {"open_floor_booster_t1": runs}, "Robots")
        assert rows["booster_t1"][6] == short


def test_of_robots_that_did_not_run_there_is_no_row() -> None:
    assert list(robots_tables([QRIO, T1])({})) == []


def test_the_cases_of_an_experiment_can_be_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["list", "experiments", "robots", "--json"]) == 0
    cases = json.loads(capsys.readouterr().out)["cases"]
    assert [case["name"] for case in cases] == [case.name for case in ROBOTS.cases]
    assert cases[0]["settings"][1] == "scale_to_robot=true"
    assert execute(["list", "experiments", "stairs"]) == 0
    assert "basin_80_mm" in capsys.readouterr().out
    assert execute(["list", "experiments", "stair"]) == 2
    assert "did you mean 'stairs'?" in capsys.readouterr().err
