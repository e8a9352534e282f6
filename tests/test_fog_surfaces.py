"""The tables of slopes, of surfaces over each other and of beams."""

import math

from experiment_builders import rows_of, watched

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog import fog_tables
from treadwell.judging.ceiling_watch import CeilingErrors
from treadwell.judging.element_watch import ElementCells


def test_what_the_map_has_of_elements_is_summed_over_runs() -> None:
    one = ElementCells("slope", 10, 6, 2, (0.001,) * 6, math.radians(1.0))
    other = ElementCells("slope", 10, 0, 10, (), None)
    rows = rows_of(fog_tables, {cases.SLOPE: watched((one,), (other,))}, "A slope of")
    assert rows == {"slope": ("20", "30.0", "60.0", "1.0", "1.00")}


def test_ceilings_are_measured_and_decisions_counted() -> None:
    runs = watched(CeilingErrors(4, (0.02, -0.03), 2), CeilingErrors(3, (0.01,), 0))
    rows = rows_of(fog_tables, {cases.BEAM_HIGH: runs}, "A beam over")
    decided = sum(run.passed for run in runs)
    assert rows == {cases.BEAM_HIGH: (f"{decided} of 2", "3", "20.0", "30", "66.7")}
    none = rows_of(fog_tables, {cases.BEAM_LOW: watched(CeilingErrors(0, (), 0))}, "A beam over")
    assert none[cases.BEAM_LOW][1:] == ("0", "-", "-", "0.0")
