"""The experiment `footsteps`: its cases are scenarios, its tables tell right from wrong."""

from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest
from episode_builders import qrio, result, scenario
from experiment_builders import rows_of
from test_scenarios import FOOT_BY_FOOT

from treadwell.course.build import build_course
from treadwell.experiments.catalogue import EXPERIMENTS
from treadwell.experiments.conduct import conduct
from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.experiment import Experiment
from treadwell.experiments.footsteps import tables as tables_module
from treadwell.experiments.footsteps.experiment import FOOTSTEPS, footsteps_experiment
from treadwell.experiments.footsteps.suite import BEHAVIOUR, SCENARIOS, suite_of
from treadwell.experiments.footsteps.tables import footsteps_tables
from treadwell.judging.result import CollisionEntry
from treadwell.measuring.level_watch import LevelTimes, LevelWatch
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario

MADE = scenario()
WALKER = "stair_climbing"
SUITE = suite_of(WALKER)
TABLES = footsteps_tables(SUITE)
TOUCH = CollisionEntry(time=1.0, robot_part="left_foot", element="bar", impulse=0.1)


def run(outcome: str = "goal_reached", *times: float, **facts: Any) -> Run:  # noqa: ANN401
    """A run that ended so; `times`: when both feet had made each change of level."""
    made = result(MADE, outcome=outcome, **facts)
    return Run(made, Path("folder"), findings=LevelTimes(times))


def test_every_case_is_a_scenario_for_its_robot_with_the_behaviour_asked_for(
    tmp_path: Path,
) -> None:
    for claim in (*SUITE.walks, *SUITE.families, *SUITE.bars):
        case = claim.case
        name = case.scenario
        if not isinstance(name, str):
            name = write_scenario(tmp_path / f"{case.name}.toml", name(3))
        made = load_scenario(name, seed=3, overrides=case.overrides)
        assert (made.robot, made.navigation.behaviour) == (claim.robot, WALKER)
    assert len({case.name for case in SUITE.cases}) == len(SUITE.cases)


def test_the_shipped_experiment_asks_for_planned_steps_and_differs_in_nothing_else() -> None:
    """The name need not be registered: a run is refused by it, and by nothing else."""
    assert EXPERIMENTS["footsteps"] is FOOTSTEPS
    assert BEHAVIOUR == "footsteps"
    ours = [
        (case.name, [one.replace(WALKER, BEHAVIOUR) for one in case.overrides], case.share)
        for case in SUITE.cases
    ]
    assert [(case.name, [*case.overrides], case.share) for case in FOOTSTEPS.cases] == ours
    assert set(SCENARIOS) == set(FOOT_BY_FOOT)


def test_a_small_one_runs_whole(tmp_path: Path) -> None:
    made = footsteps_experiment(WALKER).narrowed(["l_stairs_qrio", "stairs_behind_nao"])
    short = [replace(case, overrides=(*case.overrides, "time_limit=0.4")) for case in made.cases]
    report = conduct(
        Experiment(made.name, made.description, tuple(short), made.tables),
        range(1),
        tmp_path / "out",
    )
    assert [done.outcome for _, done in report.runs] == ["timed_out", "timed_out"]
    assert [done.findings for _, done in report.runs] == [LevelTimes(()), LevelTimes(())]
    assert "| l_stairs | qrio | 0 of 1 |" in (tmp_path / "out" / "experiment.md").read_text()


def test_goals_times_and_stairs_of_a_scenario_are_counted() -> None:
    results = {
        "l_stairs_qrio": [
            run("goal_reached", 5.0, 6.0, 9.0, simulated_seconds=30.0, steps_taken=40,
                path_length=2.0),
            run("goal_reached", 5.0, 6.5, simulated_seconds=50.0, steps_taken=60, path_length=2.0,
                collisions=[TOUCH]),
            run("refused", reason="lost: x"),
            run("fell", 1.0, falls=1),
            run("stuck"),
        ]
    }  # fmt: skip
    row = rows_of(TABLES, results, "Scenarios")["l_stairs"]
    assert row == (
        "qrio", "2 of 5", "19 of 20, no fall", "lost 1", "1", "1", "1", "40.0", "1.5", "25.0"
    )  # fmt: skip
    assert rows_of(TABLES, results, "Seconds to the goal")["l_stairs"] == (
        "71 to 200",
        "35",
        "40.0",
    )


def test_a_refusal_of_drawn_flights_is_right_where_there_is_no_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ways = iter([True, False])
    monkeypatch.setattr(tables_module, "has_no_way", Mock(side_effect=lambda *_: next(ways)))
    ends = [
        run(simulated_seconds=20.0),
        run(simulated_seconds=40.0),
        run("refused"),
        run("refused"),
    ]
    row = rows_of(TABLES, {"random_flights_nao": ends}, "Flights")["random_flights"]
    assert row == ("nao", "3 of 4 (75.0 %)", "2", "1", "1", "0", "30.0")


def test_a_bar_is_crossed_or_refused_but_never_touched() -> None:
    ends = [
        run(),
        run("refused", reason="blocked: x"),
        run(collisions=[TOUCH]),
        run("refused", reason="lost: x"),
    ]
    row = rows_of(TABLES, {"bar_qrio": ends}, "A bar")["qrio"]
    assert row == ("2 of 4", "2", "blocked 1, lost 1", "1", "0")


def test_what_was_not_run_has_no_table() -> None:
    assert TABLES({}) == []


def test_the_watch_notes_each_change_of_level_that_is_not_taken_back() -> None:
    judge = Mock(stairs_climbed=0, stairs_descended=0)
    watch = LevelWatch(Mock(judge=judge))
    for second, (up, down) in enumerate([(0, 0), (1, 0), (2, 0), (1, 0), (2, 1)]):
        judge.stairs_climbed, judge.stairs_descended = up, down
        watch.frame(Mock(time_ns=second * 10**9))
    found = watch.findings()
    assert found.times == (1.0, 4.0, 4.0)
    assert found.intervals() == [3.0, 0.0]


@pytest.mark.parametrize("name", sorted(set(FOOT_BY_FOOT) - {"slabs", "stepping_stones"}))
def test_a_scenario_for_planned_steps_has_steps_within_what_both_robots_can_do(name: str) -> None:
    """15 to 50 mm from level to level, as they are drawn; the goal is where a level is."""
    for seed in range(5):
        made = load_scenario(name, seed=seed)
        course = build_course(made, qrio())
        tops = sorted({round(top.height, 6) for _, top in course.tops()})
        rises = [after - before for before, after in zip([0.0, *tops], tops, strict=False)]
        assert all(0.015 <= rise <= 0.050 for rise in rises), rises
        assert {course.start.height, course.goal_height} == {0.0, tops[-1]}
