"""The table of the levels' heights, beside the paper's."""

from pathlib import Path

from episode_builders import result, scenario

from treadwell.experiments.experiment import NOTHING
from treadwell.experiments.level_heights import level_heights
from treadwell.judging.result import SurfaceEntry
from treadwell.runner import Run

MADE = scenario()


def top(truth: float, estimate: float | None) -> SurfaceEntry:
    return SurfaceEntry(element="x", part="y", truth=truth, estimate=estimate, cells=9)


def run(*surfaces: SurfaceEntry) -> Run:
    return Run(result(MADE, surfaces=list(surfaces)), Path("folder"))


def test_heights_of_levels_stand_beside_the_papers() -> None:
    made = level_heights(
        [run(top(0.038, 0.037), top(0.122, None)), run(top(0.038, 0.0384), top(0.061, 0.0625))]
    )
    rows = {row[0]: row[1:] for row in made.rows}
    assert all(len(row) == len(made.header) for row in made.rows)
    assert rows["sill"] == ("38", "37", "37.7", "0.7", "-1.0 to +0.4", "2")
    assert rows["2nd step"] == ("61", "61", "62.5", "1.5", "+1.5 to +1.5", "1")
    assert rows["platform"] == ("122", "126", NOTHING, NOTHING, NOTHING, "0")
    assert rows["mean of the five"][1:4] == ("1.4", NOTHING, "1.1")
    assert rows["worst of the five"][1:4] == ("4.0", NOTHING, "1.5")


def test_where_no_level_is_known_there_is_no_table() -> None:
    assert level_heights([run(top(0.5, 0.5))]).rows == ()
