"""The tables of the pose's drift."""

import math

from experiment_builders import rows_of, watched

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog import fog_tables
from treadwell.measuring.pose_watch import PoseErrors


def test_the_heights_drift_is_the_largest_of_each_run() -> None:
    def walked(*heights: float) -> PoseErrors:
        return PoseErrors(heights, (), ())

    runs = watched(walked(0.001, -0.004, 0.002), walked(0.002, 0.001))
    rows = rows_of(fog_tables, {cases.WALKED_FILTERED: runs}, "Error of the robot's height")
    assert rows == {cases.WALKED_FILTERED: ("2", "3.0", "4.0", "1.5", "significantly smaller")}


def test_the_headings_error_is_taken_after_each_whole_turn() -> None:
    turned = tuple(math.radians(degrees) for degrees in range(0, 721, 10))
    headings = tuple(math.radians(degrees / 360.0) for degrees in range(0, 721, 10))
    rows = rows_of(
        fog_tables, {cases.TURNS: watched(PoseErrors((), headings, turned))}, "Error of the heading"
    )
    assert rows == {
        "turns, after 1": ("0.9", "0.9"),
        "turns, after 2": ("1.9", "1.9"),
        "turns, at any time": ("2.0", "2.0"),
    }
