"""What is gathered of a camera frame for recorder and score."""

from dataclasses import fields

import numpy as np
import pytest

import treadwell
from treadwell.poses import pose_matrix
from treadwell.recording.rhythm import Rhythm
from treadwell.recording.tracing import trace_of
from treadwell.trace import Trace, transformed


@pytest.fixture(scope="module")
def traced() -> tuple[treadwell.Episode, Trace]:
    episode = treadwell.Episode("slalom", seed=1, overrides=("time_limit=2",))
    last = None
    for step in episode:
        last = trace_of(episode, step)
    assert last is not None
    return episode, last


def test_estimate_and_truth_are_near_each_other_and_not_the_same(
    traced: tuple[treadwell.Episode, Trace],
) -> None:
    episode, trace = traced
    assert trace.truth_from_robot[:3, 3] == pytest.approx(trace.map_from_robot[:3, 3], abs=0.02)
    assert (trace.truth_from_robot != trace.map_from_robot).any()
    step = episode.tick()
    assert (trace_of(episode, step).truth_from_robot == episode.judge.observed.matrix()).all()


def test_what_is_not_due_is_not_asked_of_the_core(
    traced: tuple[treadwell.Episode, Trace],
) -> None:
    episode, _ = traced
    step, rhythm = episode.tick(), Rhythm()
    whole, first = trace_of(episode, step), trace_of(episode, step, rhythm)
    for field in fields(Trace):
        np.testing.assert_equal(getattr(first, field.name), getattr(whole, field.name))
    second = trace_of(episode, step, rhythm)
    assert (second.map_due, second.clearance) == (False, None)


def test_points_that_are_ground_lie_on_the_floor_of_the_map(
    traced: tuple[treadwell.Episode, Trace],
) -> None:
    _, trace = traced
    points = trace.points()
    assert points is not None
    assert trace.labels is not None
    assert trace.ground > 0
    ground = points[trace.labels == trace.ground]
    assert len(ground) > 500
    assert np.nanmedian(ground[:, 2]) == pytest.approx(0.0, abs=0.01)
    seen = points[np.isfinite(points[:, 0])]
    assert np.median(seen[:, 0]) > 0.3  # ahead of the robot


def test_the_camera_stands_where_the_head_is(traced: tuple[treadwell.Episode, Trace]) -> None:
    _, trace = traced
    assert trace.map_from_camera is not None
    offset = trace.map_from_camera[:3, 3] - trace.map_from_robot[:3, 3]
    assert 0.4 < offset[2] < 0.6
    assert np.hypot(*offset[:2]) < 0.12


def test_arrays_of_one_grid_have_one_shape(traced: tuple[treadwell.Episode, Trace]) -> None:
    _, trace = traced
    shape = trace.view_kind.shape
    assert trace.view_height.shape == trace.sightings.shape == shape
    assert trace.clearance is None or trace.clearance.shape == shape
    assert trace.depth is not None
    assert trace.points_in_robot is not None
    assert trace.points_in_robot.shape == (trace.depth.size, 3)
    assert trace.path.shape[1] == 2


def test_before_the_first_frame_there_is_a_trace_too() -> None:
    episode = treadwell.Episode("slalom", seed=1)
    trace = trace_of(episode, episode.tick())
    assert {field.name for field in fields(Trace)} >= {"timing", "state"}
    assert trace.path.shape == (0, 2) or trace.path.shape[1] == 2
    assert trace.time_ns == 0


def test_transformed_points_are_rotated_and_moved_and_unknown_stays_unknown() -> None:
    points = np.array([[1.0, 0.0, 0.0], [np.nan, np.nan, np.nan]], dtype=np.float32)
    moved = transformed(pose_matrix(1.0, 2.0, 0.5, np.pi / 2), points)
    assert moved.dtype == np.float32
    assert moved[0] == pytest.approx([1.0, 3.0, 0.5], abs=1e-6)
    assert np.isnan(moved[1]).all()
