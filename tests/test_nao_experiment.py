"""The tables and pictures of the experiment `nao`, from runs whose outcome is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from episode_builders import result
from experiment_builders import MADE, rows_of, watched

from treadwell.episode import Episode
from treadwell.errors import RecordingError
from treadwell.experiments import conduct as conducting
from treadwell.experiments import nao_cases as cases
from treadwell.experiments.experiment import Case, Experiment
from treadwell.experiments.nao import NAO, nao_tables
from treadwell.experiments.nao_filters import with_other_draws
from treadwell.experiments.nao_localization import binned, filter_walks, found_after, in_hallway
from treadwell.experiments.nao_maps import local_map
from treadwell.experiments.nao_pictures import draw_errors, nao_pictures
from treadwell.judging.result import CollisionEntry, MapCounts, Timing
from treadwell.measuring.visitor_watch import Avoidance
from treadwell.measuring.walk_watch import Unmapped, Walk, WalkWatch
from treadwell.runner import Run, run_episode
from treadwell.scenario.loading import load_scenario


def walk(*errors: float, y: float = 2.0, odometry: float = 0.0) -> Walk:
    """A walk along x, a frame and 0.1 m a second, with errors of the belief along y, m."""
    count = len(errors)
    true = np.column_stack([2.0 + 0.1 * np.arange(count), np.full(count, y), *np.zeros((2, count))])
    off = np.zeros((count, 4))
    off[:, 1] = errors
    return Walk(
        times=np.arange(count, dtype=np.float64),
        believed=true + off,
        true=true,
        odometry=true + np.array([odometry, 0.0, 0.0, 0.0]),
        carried=0.0,
        unmapped=(),
        clear=400,
        clear_wrong=1,
        static=np.array([[2.0, 1.0]]),
        voxel=0.04,
    )


def test_errors_of_all_frames_of_all_runs_stand_beside_the_papers() -> None:
    runs = {cases.walked(2, "octree"): watched(walk(0.02, 0.04, odometry=0.3), walk(0.0, 0.6))}
    row = rows_of(nao_tables, runs, "Error of the believed place")["2, octree"]
    assert row[:2] == ("0.09 ± 0.07", "0.05")
    assert row[2:6] == ("0.165 ± 0.252", "0.300", "0.600", "1 of 2")
    assert row[6:] == ("0.15", "0.15", "1", "2 of 2")


def test_the_rise_in_the_hallway_is_that_of_the_frames_in_it() -> None:
    first, second = walk(0.01, 0.01), walk(0.03, 0.03, y=0.5)
    assert not in_hallway(first).any()
    assert in_hallway(second).all()
    runs = {cases.walked(1, "octree"): watched(first, first), cases.filtered(1): watched(second)}
    row = rows_of(nao_tables, runs, "Error in the hallway")["ours, 2 filters"]
    assert row == ("30", "10", "+20", "20 to 20", "10")


@pytest.mark.long
def test_other_filters_see_the_data_of_one_walk(tmp_path: Path) -> None:
    overrides = ("navigation.world_model=octree", "time_limit=45.0")
    episode = Episode("nao_1", seed=0, overrides=overrides)
    done = run_episode(episode, out=tmp_path / "run", watch=WalkWatch)
    same = with_other_draws(done, 0)
    np.testing.assert_allclose(same.findings.believed, done.findings.believed, atol=1e-8)
    (tmp_path / "run-replayed").rename(tmp_path / "run-replayed-0")
    other = with_other_draws(done, 7)
    assert np.abs(other.findings.believed - done.findings.believed).max() > 1e-6
    np.testing.assert_array_equal(other.findings.true, done.findings.true)
    np.testing.assert_array_equal(other.findings.odometry, done.findings.odometry)


def test_bins_have_the_mean_of_their_frames_over_all_runs() -> None:
    long = walk(*[0.01] * 10, *[0.05] * 2)
    (first, second) = binned([long, long]).tolist()
    assert first == pytest.approx([5.0, 0.01, 0.0])
    assert second == pytest.approx([15.0, 0.05, 0.0])
    assert binned([long, walk(*[0.03] * 10)])[0].tolist() == pytest.approx([5.0, 0.02, 0.01])


def test_found_is_what_stays_so_and_only_walking_counts() -> None:
    assert found_after(walk(0.0, 0.0)) == (0.0, 0.0)
    assert found_after(walk(0.3, 0.1, 0.3, 0.1)) == (3.0, 3.0)
    assert found_after(walk(0.1, 0.3)) is None
    stood = walk(0.3, 0.3, 0.3, 0.0)
    stood.true[:2, 0] = stood.believed[:2, 0] = 2.2
    assert found_after(stood) == (3.0, 1.0)
    # Two seconds after it was carried off; what was before does not count.
    assert found_after(replace(walk(0.0, 0.3, 0.3, 0.3, 0.0), carried=2.0)) == (2.0, 2.0)


def test_on_the_wrong_level_or_the_wrong_way_round_is_not_found() -> None:
    for axis, off in ((2, 0.36), (3, 3.0)):
        wrong = walk(0.0, 0.0, 0.0)
        wrong.believed[:2, axis] += off
        assert found_after(wrong) == (2.0, 2.0)
    runs = {cases.KIDNAPPED: watched(walk(0.0), walk(0.3), walk(*[0.3] * 25, 0.0))}
    row = rows_of(nao_tables, runs, "Finding out")[cases.KIDNAPPED]
    assert row[1:5] == ("1 of 3", "2 of 3", "12.5", "12.5")


def test_unmapped_things_that_were_not_found_are_named() -> None:
    found = replace(walk(0.0), unmapped=(Unmapped("ball", 9, 4), Unmapped("books", 9, 0)))
    counts = MapCounts(floor_called_obstacle=0.002)
    run = Run(result(MADE, map=counts), Path("folder"), findings=found)
    rows = rows_of(nao_tables, {cases.walked(2, "fog"): [run]}, "The local map")
    assert rows["2, fog"] == ("1 of 2", "books", "0.20", "0.20", "0.25", "0.25", "0.25")


def test_contacts_and_the_time_to_a_new_way_are_counted_where_one_was_needed() -> None:
    hit = CollisionEntry(time=1.0, robot_part="torso", element="visitor", impulse=1.0)
    quick, free = Avoidance(2.0, 3.0, 3.2, 4.0), Avoidance(None, 3.0, None, None)
    bumped = Run(result(MADE, collisions=[hit]), Path("folder"), findings=free)
    runs = {cases.VISITOR: [*watched(quick), bumped]}
    row = rows_of(nao_tables, runs, "Somebody")[cases.VISITOR]
    assert row[1:5] == ("1 of 2", "2 of 2", "1 of 2", "2 of 2")
    assert row[5:9] == ("0.20", "0.20", "1.00", "1.00")


def test_of_what_was_not_run_there_is_no_table_and_no_picture(tmp_path: Path) -> None:
    assert nao_tables({}) == []
    assert nao_tables({case.name: [] for case in NAO.cases}) == []
    assert NAO.pictures({case.name: [] for case in NAO.cases}, tmp_path) == []


def test_every_case_can_be_loaded_with_its_settings() -> None:
    for case in NAO.cases:
        assert isinstance(case.scenario, str)
        made = load_scenario(case.scenario, seed=0, overrides=case.overrides)
        assert made.name == case.scenario
    below = next(case for case in NAO.cases if case.name == cases.UNKNOWN_BELOW)
    starts = [
        load_scenario("two_levels_unknown", seed=i, overrides=below.overrides) for i in (1, 2)
    ]
    (x, y), other = (made.start.position for made in starts)
    assert (x, y) != other
    assert 0.5 <= x <= 1.6
    assert 1.5 <= y <= 2.6


def test_the_error_over_time_is_drawn_of_the_runs_of_one_seed(tmp_path: Path) -> None:
    runs = {cases.walked(1, "fog"): watched(walk(0.1)), cases.filtered(2): watched(walk(0.1, 0.2))}
    (picture,) = nao_pictures(runs, tmp_path)
    assert picture.title.startswith("Error of 1 filters")
    assert picture.path.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(RecordingError, match="cannot be written"):
        draw_errors(tmp_path / "no folder" / "errors.png", [walk(0.1)])


@pytest.mark.slow
def test_a_walk_of_half_a_second_is_drawn_and_stands_in_the_tables(tmp_path: Path) -> None:
    name = cases.walked(2, "octree")
    case = next(case for case in NAO.cases if case.name == name)
    assert isinstance(case.scenario, str)
    episode = Episode(case.scenario, seed=0, overrides=(*case.overrides, "time_limit=0.5"))
    done = run_episode(episode, out=tmp_path / "run", record=False, watch=case.watch)
    (picture,) = nao_pictures({name: [done]}, tmp_path)
    assert picture.path.read_bytes().startswith(b"\x89PNG")
    row = rows_of(nao_tables, {name: [done]}, "Error of the believed place")["2, octree"]
    assert row[5] == "0 of 1"
    assert 0.0 <= float(row[4]) < 0.1
    (row,) = local_map({name: [done]}).rows
    assert row[1].endswith("of 6")


def test_the_time_of_a_frame_is_the_sum_of_its_stages_where_all_are_known() -> None:
    times = {
        stage: Timing(median=ms, p99=3.0 * ms, max=9.0, count=5)
        for stage, ms in (("segment", 1.0), ("localize", 0.5), ("map", 2.0), ("stairs", 0.1))
    }
    for plan, whole in ((Timing(median=4.0, p99=9.0, max=9.0, count=5), "8.6"), (None, "-")):
        made = times if plan is None else times | {"plan": plan}
        run = Run(result(MADE, timing_ms=made), Path("folder"), findings=walk(0.1))
        rows = rows_of(nao_tables, {cases.walked(1, "octree"): [run]}, "Planes, localization")
        assert rows["167 in all, 4 cores"][-1] == whole


@pytest.mark.slow
def test_a_walk_with_other_frames_than_its_replay_is_an_error(tmp_path: Path) -> None:
    overrides = ("navigation.world_model=octree", "time_limit=0.5")
    episode = Episode("nao_1", seed=0, overrides=overrides)
    done = run_episode(episode, out=tmp_path / "run", watch=WalkWatch)
    short = replace(done, findings=walk(0.0))
    failed = with_other_draws(short, 1)
    assert failed.outcome == "error"
    assert failed.result.reason == "error: 5 camera frames replayed of 1"
    assert not failed.passed
    runs = {cases.filtered(1): [failed], cases.filtered(2): [done]}
    assert len(filter_walks(runs)) == 1


def test_an_interrupted_walk_is_not_replayed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(_run: Run) -> Run:
        raise AssertionError

    stopped = Run(result(MADE).model_copy(update={"outcome": "interrupted"}), Path("folder"))
    monkeypatch.setattr(conducting, "run_episode", lambda *_args, **_kwargs: stopped)
    case = Case("one", "slalom", afterwards=never)
    experiment = Experiment("one", "one", (case,), tables=lambda _results: ())
    report = conducting.conduct(experiment, range(1), tmp_path / "report")
    assert report.interrupted
    assert (tmp_path / "report" / "experiment.json").is_file()
