"""The experiment `world`: its courses are scenarios, and its tables tell right from wrong."""

import math
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest
from episode_builders import result, scenario
from experiment_builders import rows_of

from treadwell.errors import InputError
from treadwell.experiments.conduct import conduct
from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.experiment import Case, Draw, Experiment
from treadwell.experiments.world import claim, courses, inclines, overhead, parts
from treadwell.experiments.world.claim import GOAL, Claim, always
from treadwell.experiments.world.claims import CLAIMS, COMPLAINTS, OVERHEAD, WORLD_CLAIMS
from treadwell.experiments.world.experiment import WORLD
from treadwell.experiments.world.faults import BREAKAGES, COURSES, case_of
from treadwell.experiments.world.tables import world_tables
from treadwell.judging.result import CollisionEntry
from treadwell.runner import Run
from treadwell.scenario.elements import Ramp
from treadwell.scenario.loading import load_scenario

MADE = scenario()
TABLE = next(one for one in COMPLAINTS if one.case.name == "table_qrio")
CABLE = next(one for one in COMPLAINTS if one.case.name == "cable_open_qrio")


def run(outcome: str, reason: str | None = None, *met: str, **facts: Any) -> Run:  # noqa: ANN401
    """A run that ended so; `met`: links of the robot that touched something."""
    touched = [
        CollisionEntry(time=1.0, robot_part=part, element="top", impulse=0.1) for part in met
    ]
    made = result(MADE, outcome=outcome, reason=reason, collisions=touched, **facts)
    return Run(made, Path("folder"))


def test_what_a_seed_draws_is_a_scenario_and_the_same_again(tmp_path: Path) -> None:
    for case in WORLD.cases:
        if isinstance(case.scenario, str):
            load_scenario(case.scenario, seed=1, overrides=case.overrides)
            continue
        for name, text in case.beside:
            (tmp_path / name).write_text(text)
        drawn = case.scenario(3)
        assert drawn == case.scenario(3)
        load_scenario(write_scenario(tmp_path / f"{case.name}.toml", drawn), seed=3)


def test_the_second_robot_walks_the_same_courses() -> None:
    for one in CLAIMS:
        if not isinstance(one.case.scenario, str):
            assert one.case.scenario(0)["robot"] == one.robot
        elif one in WORLD_CLAIMS:
            assert f"robot={one.robot}" in one.case.overrides


def test_every_boards_file_lies_beside_the_scenario_that_names_it(tmp_path: Path) -> None:
    cases = tuple(case for case in WORLD.cases if case.beside)
    assert {case.name for case in cases} == {"nosing_qrio", "open_risers_qrio"}
    short = [Case(c.name, _cut(c.scenario), beside=c.beside) for c in cases if callable(c.scenario)]
    made = Experiment("boards", "boards", tuple(short), lambda _: ())
    report = conduct(made, range(1), tmp_path / "out")
    assert [done.outcome for _, done in report.runs] == ["timed_out", "timed_out"]


def _cut(draw: Draw) -> Draw:
    return lambda seed: {**draw(seed), "time_limit": 0.1}


def test_more_room_than_a_robot_needs_has_to_be_used_and_less_refused() -> None:
    kinds = set()
    for seed in range(100):
        one = overhead.drawn(seed)
        assert overhead.LEAST <= one.room <= overhead.MOST
        kinds.add(one.kind)
        ends = one.ends(0.58)
        if one.kind in ("desk", "lamp") or one.room >= 0.62:
            assert ends == {GOAL}
        elif one.room < 0.58:
            assert ends == {"too_low"}
        else:
            assert ends == {GOAL, "too_low"}
    assert kinds == set(overhead.KINDS)
    nao = OVERHEAD[1].ends
    assert any(nao(seed) != OVERHEAD[0].ends(seed) for seed in range(100)), "nao is taller"


@pytest.mark.parametrize("band", [inclines.WALKED, inclines.EITHER, inclines.REFUSED])
def test_slopes_are_as_steep_as_their_band_says(band: tuple[float, float], tmp_path: Path) -> None:
    for seed in range(12):
        file = write_scenario(tmp_path / "slope.toml", inclines.incline(band, seed))
        for slope in load_scenario(file, seed=seed).course:
            if isinstance(slope, Ramp):
                degrees = math.degrees(math.atan2(slope.rise, slope.length))
                assert band[0] - 0.1 <= degrees <= band[1] + 0.6
    ends = always(*inclines.incline_ends(band))(0)
    assert (GOAL in ends, "too_steep" in ends) == (band[0] < 12.0, band[0] >= 10.0)


def test_a_run_is_right_that_ends_rightly_without_fall_or_touch() -> None:
    assert TABLE.is_right(run("goal_reached"))
    assert not TABLE.is_right(run("goal_reached", None, "head"))
    assert not TABLE.is_right(run("fell", "fell: tilted", falls=1))
    assert not TABLE.is_right(run("stuck", "stuck: the robot stayed in one place for too long"))
    assert CABLE.is_right(run("goal_reached", None, "left_foot"))


def test_a_refusal_is_right_by_its_word_or_where_there_is_no_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    low = Claim(TABLE.case, "x", "qrio", always("too_low"), judged=True)
    refused = run("refused", "too_low: no room for the head")
    for no_way in (False, True):
        monkeypatch.setattr(claim, "has_no_way", Mock(return_value=no_way))
        assert low.is_right(refused)
        assert low.is_right(run("refused", "no_path: there is no path")) is no_way
        assert not TABLE.is_right(run("refused", "no_path: there is no path"))
    assert not low.is_right(run("goal_reached"))


def test_no_way_is_what_a_search_on_the_true_course_says(tmp_path: Path) -> None:
    shut = parts.scenario("shut", {"position": [1.6, 0.0]}, _shut())
    free = courses.narrow_corridor()
    for name, drawn, no_way in (("shut", shut, True), ("free", free, False)):
        case = Case(name, Mock(return_value=drawn))
        write_scenario(tmp_path / f"{name}-0.toml", drawn)
        done = Run(result(MADE), tmp_path / f"{name}-0")
        assert claim.has_no_way(case, done) is no_way


def _shut() -> list[parts.Part]:
    return [*parts.corridor(2.2), parts.wall("across", (1.0, -0.475), (1.0, 0.475))]


def test_the_tables_count_ends_touches_and_the_words_of_refusals(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(claim, "has_no_way", Mock(return_value=False))
    runs = [
        run("goal_reached"),
        run("goal_reached", None, "head", "left_hand"),
        run("refused", "stuck: no way out"),
        run("fell", "fell: x", falls=1),
    ]
    made = rows_of(world_tables, {"table_qrio": runs}, "Courses after complaints")
    row = made["table"]
    assert row[:8] == ("qrio", "1 of 4", "2", "stuck 1", "0", "1", "2", "1")
    reasons = rows_of(world_tables, {"table_qrio": runs}, "What was refused")
    assert "table_qrio" in reasons


def test_a_fault_counts_as_a_false_success_where_arrival_is_declared_elsewhere() -> None:
    dead = next(one for one in BREAKAGES if one.name == "left_foot_dead")
    knee = next(one for one in BREAKAGES if not one.stands)
    slalom, stairs = (case_of(dead, course).name for course in COURSES)
    results = {
        slalom: [run("goal_reached"), run("stuck", "elsewhere: arrival declared 3 m away")],
        stairs: [run("refused", "sensor: left foot"), run("fell", "fell: x", falls=1)],
        case_of(knee, "slalom").name: [run("fell", "fell: x", falls=1)],
    }
    made = rows_of(world_tables, results, "A sense or a motor breaks")
    assert made["left_foot_dead"][:2] == ("1 / 0 / 0 / 1 / 0 / 2", "0 / 1 / 0 / 0 / 1 / 2")
    assert made[knee.name][-1] == "cannot stand"
    assert made["all that can stand: false successes / falls"][0] == "1 / 1 of 4"


def test_a_case_that_is_not_there_is_named() -> None:
    with pytest.raises(InputError, match="world has no case 'tabel'"):
        WORLD.narrowed(["tabel"])
