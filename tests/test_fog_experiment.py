"""The tables of the experiment `fog`, from runs whose outcome is known."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from episode_builders import result, scenario

from treadwell.episode import Episode
from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import Results
from treadwell.experiments.fog import FOG, fog_tables
from treadwell.judging.ceiling_watch import CeilingErrors
from treadwell.judging.element_watch import ElementCells
from treadwell.judging.map_memory import RememberedMap
from treadwell.judging.map_watch import MapFrame, MapHistory
from treadwell.judging.pose_watch import PoseErrors
from treadwell.judging.regions import RegionCounts
from treadwell.judging.result import MapCounts, SurfaceEntry
from treadwell.runner import Run, run_episode

MADE = scenario()


def table(results: Results, title: str) -> dict[str, tuple[str, ...]]:
    """The table whose title begins so, its rows by their first cell."""
    made = next(one for one in fog_tables(results) if one.title.startswith(title))
    assert all(len(row) == len(made.header) for row in made.rows)
    return {row[0]: row[1:] for row in made.rows}


def watched(*findings: object) -> list[Run]:
    return [Run(result(MADE), Path("folder"), findings=one) for one in findings]


def frame(covered: int = 0, found: int = 0, stale: int = 0, between: int = 0) -> MapFrame:
    left = 0 if covered else 20
    return MapFrame(0.0, covered, found, left, stale, covered + left, between)


def history(*frames: MapFrame) -> MapHistory:
    return MapHistory(frames, ())


def test_what_is_stale_after_a_box_was_removed_is_counted_until_none_is() -> None:
    forgets = history(frame(20, 18), *[frame(stale=9)] * 3, frame(), frame())
    keeps = history(frame(20, 20), *[frame(stale=5)] * 6)
    rows = table({cases.removed("fog"): watched(forgets, keeps)}, "A box is removed")
    assert rows == {"fog": ("95.0", "2", "1 of 2", "3, at most 3")}
    rows = table({cases.removed("fog"): watched(keeps)}, "A box is removed")
    assert rows["fog"][1:] == ("5", "1 of 1", "never")
    rows = table({cases.removed("fog"): watched(history(frame(20, 20), frame()))}, "A box is")
    assert rows["fog"][1:] == ("0", "0 of 1", "0, at most 0")


def test_heights_of_neither_box_nor_floor_are_a_share_of_the_floor() -> None:
    one = history(frame(20, 20), frame(20, 18, between=2))
    rows = table({cases.moved("fog"): watched(one, history(frame(20)))}, "A box moves")
    assert rows["fog"][:2] == ("2.50", "5.00")


def test_segmenters_are_counted_over_all_frames_of_all_runs() -> None:
    found = RegionCounts(true=10, correct=6, over=1, under=1, merged=2, missed=1, noise=3)
    rows = table({cases.seen("scan_line"): watched(found, found)}, "Level surfaces")
    assert rows["scan_line"] == ("20", "60.0", "10.0", "20.0", "10.0", "6")


def test_cells_of_the_course_and_of_the_levels_stand_beside_what_is_wanted() -> None:
    counts = MapCounts(floor_cells_right=0.97, floor_called_obstacle=0.01, obstacle_cells_right=1.0)
    top = SurfaceEntry(element="low", part="top", truth=0.04, estimate=0.0385, cells=9)
    runs = [Run(result(MADE, map=counts, surfaces=[top]), Path("folder"))]
    rows = table({cases.course("fog"): runs}, "Cells of")
    assert rows["floor called obstacle, %"] == ("0.5", "1.00", "1.00")
    assert rows["floor at the wrong height, %"][1:] == ("2.00", "2.00")
    rows = table({cases.levels("fog"): runs}, "Three levels")
    assert rows[cases.levels("fog")] == ("97.00", "100.00", "1.50", "1.50")


def test_with_worse_senses_labels_and_heights_stand_beside_those_with_the_robots_own() -> None:
    counts = MapCounts(floor_cells_right=0.9, obstacle_cells_right=1.0)
    top = SurfaceEntry(element="low", part="top", truth=0.04, estimate=0.035, cells=9)
    runs = [Run(result(MADE, map=counts, surfaces=[top]), Path("folder"))]
    results: Results = {case.name: runs for case in cases.WORSE} | {cases.levels("fog"): runs}
    rows = table(results, "Three levels with worse senses")
    assert set(rows) == set(results)
    assert set(rows.values()) == {("90.00", "100.00", "5.00", "5.00")}
    assert "Three levels with worse" not in {
        made.title for made in fog_tables({cases.levels("fog"): runs})
    }


def test_the_heights_drift_is_the_largest_of_each_run() -> None:
    def walked(*heights: float) -> PoseErrors:
        return PoseErrors(heights, (), ())

    runs = watched(walked(0.001, -0.004, 0.002), walked(0.002, 0.001))
    rows = table({cases.WALKED_FILTERED: runs}, "Error of the robot's height")
    assert rows == {cases.WALKED_FILTERED: ("2", "3.0", "4.0", "1.5")}


def test_the_headings_error_is_taken_after_each_whole_turn() -> None:
    turned = tuple(math.radians(degrees) for degrees in range(0, 721, 10))
    headings = tuple(math.radians(degrees / 360.0) for degrees in range(0, 721, 10))
    rows = table({cases.TURNS: watched(PoseErrors((), headings, turned))}, "Error of the heading")
    assert rows == {
        "after 1": ("0.9", "0.9"),
        "after 2": ("1.9", "1.9"),
        "at any time": ("2.0", "2.0"),
    }


def test_what_the_map_has_of_elements_is_summed_over_runs() -> None:
    one = ElementCells("slope", 10, 6, 2, (0.001,) * 6, math.radians(1.0))
    other = ElementCells("slope", 10, 0, 10, (), None)
    rows = table({cases.SLOPE: watched((one,), (other,))}, "A slope of")
    assert rows == {"slope": ("20", "30.0", "60.0", "1.0", "1.00")}


def test_ceilings_are_measured_and_decisions_counted() -> None:
    runs = watched(CeilingErrors(4, (0.02, -0.03)), CeilingErrors(3, (0.01,)))
    rows = table({cases.BEAM_HIGH: runs}, "A beam across")
    decided = sum(run.passed for run in runs)
    assert rows == {cases.BEAM_HIGH: (f"{decided} of 2", "3", "20.0", "30")}
    none = table({cases.BEAM_LOW: watched(CeilingErrors(0, ()))}, "A beam across")
    assert none[cases.BEAM_LOW][1:] == ("0", "-", "-")


def test_of_what_was_not_run_there_is_no_table() -> None:
    assert fog_tables({}) == []
    assert fog_tables({case.name: [] for case in FOG.cases}) == []


def test_a_removed_box_vanishes_from_the_map_of_a_robot_that_stands(tmp_path: Path) -> None:
    case = next(case for case in FOG.cases if case.name == cases.removed("fog"))
    episode = Episode(str(case.scenario), seed=0, overrides=case.overrides)
    done = run_episode(episode, out=tmp_path / "run", record=False, watch=case.watch)
    assert done.passed
    seen: Any = done.findings
    before, end = seen.pictures
    assert isinstance(before, RememberedMap)
    assert np.nanmax(before.height) > 0.05 > np.nanmax(end.height)
    pictures = FOG.pictures({case.name: [done]}, tmp_path)
    assert [one.path.name for one in pictures] == ["removed.png"]
    assert pictures[0].path.read_bytes().startswith(b"\x89PNG")
    rows = table({case.name: [done]}, "A box is removed")
    assert rows["fog"][1:3] == ("0", "0 of 1")
    assert max(one.stale for one in seen.frames) > 0
