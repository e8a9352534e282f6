"""The tables of slopes, of surfaces over each other and of beams."""

import math
from pathlib import Path

import pytest
from episode_builders import result
from experiment_builders import MADE, rows_of, watched

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog import fog_tables
from treadwell.measuring.ceiling_watch import CeilingErrors
from treadwell.measuring.element_watch import ElementCells
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario


def test_what_the_map_has_of_elements_is_summed_over_runs() -> None:
    one = ElementCells("slope", 10, 6, 2, (0.001,) * 6, math.radians(1.0))
    other = ElementCells("slope", 10, 0, 10, (), None)
    rows = rows_of(fog_tables, {cases.SLOPE: watched((one,), (other,))}, "A slope of")
    assert rows == {"slope": ("20", "30.0", "60.0", "1.0", "1.00", "no floor")}


def test_ceilings_are_measured_and_decisions_counted() -> None:
    runs = watched(CeilingErrors(4, (0.02, -0.03), 2), CeilingErrors(3, (0.01,), 0))
    rows = rows_of(fog_tables, {cases.BEAM_HIGH: runs}, "A beam over")
    decided = sum(run.passed for run in runs)
    assert rows == {cases.BEAM_HIGH: (f"{decided} of 2", "3", "20.0", "30", "66.7")}
    none = rows_of(fog_tables, {cases.BEAM_LOW: watched(CeilingErrors(0, (), 0))}, "A beam over")
    assert none[cases.BEAM_LOW][1:] == ("0", "-", "-", "0.0")


def test_slopes_that_were_walked_refused_and_fallen_on_are_counted() -> None:
    def ended(outcome: str, falls: int = 0) -> Run:
        made = result(MADE).model_copy(update={"outcome": outcome, "falls": falls})
        return Run(made, Path("folder"))

    runs = {
        cases.slope_up(8): [ended("goal_reached"), ended("goal_reached"), ended("refused")],
        cases.slope_down(15): [ended("fell", falls=1), ended("refused")],
    }
    rows = rows_of(fog_tables, runs, "Slopes of one metre")
    assert rows == {"8": ("2 / 1 / 0 / 3", "-"), "15": ("-", "0 / 1 / 1 / 2")}


@pytest.mark.parametrize("angle", cases.SLOPES)
def test_the_slopes_of_the_cases_have_their_angle_and_too_steep_ones_are_to_be_refused(
    angle: int,
) -> None:
    for name in (cases.slope_up(angle), cases.slope_down(angle)):
        case = next(case for case in cases.CASES if case.name == name)
        assert isinstance(case.scenario, str)
        made = load_scenario(case.scenario, overrides=case.overrides)
        ramp = next(piece for piece in made.course if piece.kind == "ramp")
        assert math.degrees(math.atan(ramp.rise / ramp.length)) == pytest.approx(angle, abs=0.01)
        assert made.expect.outcome == ("goal_reached" if angle <= 10 else "refused")
