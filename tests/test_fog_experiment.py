"""The tables of the experiment `fog`, from runs whose outcome is known."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from episode_builders import result
from experiment_builders import MADE, rows_of, watched

from treadwell.components import COMPONENTS
from treadwell.core_settings import MAPPED
from treadwell.episode import Episode
from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog import FOG, fog_tables
from treadwell.judging.result import MapCounts, SurfaceEntry
from treadwell.map_memory import RememberedMap
from treadwell.measuring.map_watch import MapFrame, MapHistory
from treadwell.measuring.regions import RegionCounts
from treadwell.runner import Run, run_episode


def frame(covered: int = 0, found: int = 0, stale: int = 0, between: int = 0) -> MapFrame:
    left = 0 if covered else 20
    return MapFrame(0.0, covered, found, left, stale, covered + left, between)


def history(*frames: MapFrame) -> MapHistory:
    return MapHistory(frames, ())


def test_no_map_is_told_the_course_that_it_is_to_find() -> None:
    told = {f"navigation.{slot}={name}" for slot in COMPONENTS for name in MAPPED}
    assert not [case.name for case in cases.CASES if told & set(case.overrides)]


def test_what_is_stale_after_a_box_was_removed_is_counted_until_none_is() -> None:
    forgets = history(frame(20, 18), *[frame(stale=9)] * 3, frame(), frame())
    keeps = history(frame(20, 20), *[frame(stale=5)] * 6)
    rows = rows_of(fog_tables, {cases.removed("fog"): watched(forgets, keeps)}, "A box is removed")
    assert rows == {"fog": ("95.0", "2", "1 of 2", "3, at most 3", "none stale")}
    rows = rows_of(fog_tables, {cases.removed("fog"): watched(keeps)}, "A box is removed")
    assert rows["fog"][1:4] == ("5", "1 of 1", "never")
    rows = rows_of(
        fog_tables, {cases.removed("fog"): watched(history(frame(20, 20), frame()))}, "A box is"
    )
    assert rows["fog"][1:4] == ("0", "0 of 1", "0, at most 0")


def test_heights_of_neither_box_nor_floor_are_a_share_of_the_floor() -> None:
    one = history(frame(20, 20), frame(20, 18, between=2))
    rows = rows_of(
        fog_tables, {cases.moved("fog"): watched(one, history(frame(20)))}, "A box moves"
    )
    assert rows["fog"][:2] == ("2.50", "5.00")


def test_segmenters_are_counted_over_all_frames_of_all_runs() -> None:
    found = RegionCounts(true=10, correct=6, over=1, under=1, merged=2, missed=1, noise=3)
    rows = rows_of(fog_tables, {cases.seen("scan_line"): watched(found, found)}, "Level surfaces")
    assert rows["scan_line"] == ("20", "60.0", "10.0", "20.0", "10.0", "6")


def test_cells_of_the_course_and_of_the_levels_stand_beside_what_is_wanted() -> None:
    counts = MapCounts(
        floor_cells=100,
        floor_cells_right=0.97,
        floor_called_obstacle=0.01,
        obstacle_cells_right=1.0,
        whole_obstacle_cells=20,
        whole_obstacle_called_floor=0.05,
    )
    top = SurfaceEntry(element="low", part="top", truth=0.04, estimate=0.0385, cells=9)
    runs = [Run(result(MADE, map=counts, surfaces=[top]), Path("folder"))]
    rows = rows_of(fog_tables, {cases.course("fog"): runs}, "Cells of")
    assert rows["floor called obstacle, %"] == ("0.5", "1.00", "1.00")
    assert rows["the same of cells that lie in an obstacle whole, %"] == ("0", "5.00", "5.00")
    assert rows["floor at the wrong height, %"][1:] == ("2.00", "2.00")
    rows = rows_of(fog_tables, {cases.levels("fog"): runs}, "Three levels")
    assert rows[cases.levels("fog")] == ("97.00", "100.00", "96.67", "1.50", "1.50", "-")


def test_of_what_was_not_run_there_is_no_table() -> None:
    assert fog_tables({}) == []
    assert fog_tables({case.name: [] for case in FOG.cases}) == []


@pytest.mark.slow
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
    rows = rows_of(fog_tables, {case.name: [done]}, "A box is removed")
    assert rows["fog"][1:3] == ("0", "0 of 1")
    assert max(one.stale for one in seen.frames) > 0
