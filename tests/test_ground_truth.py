"""Claims about the true frames: between the soles, on the ground, along the feet."""

import math

import numpy as np
import pytest
from episode_builders import qrio, world
from hypothesis import given
from hypothesis import strategies as st

from treadwell.judging.ground_truth import GroundTruth, wrapped
from treadwell.poses import pose_matrix
from treadwell.trace import Sole


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5, math.pi])
def test_the_robot_frame_at_the_start_is_the_start(yaw: float) -> None:
    made = world(start=f"position = [0.3, -0.2]\nyaw = {yaw}")
    truth = GroundTruth(made.model, qrio())
    frame = truth.frame(truth.soles(made.simulation.data))
    assert (frame.x, frame.y, frame.z) == pytest.approx((0.3, -0.2, 0.0), abs=2e-3)
    assert wrapped(frame.yaw - yaw) == pytest.approx(0.0, abs=1e-6)
    assert truth.tilt(made.simulation.data) == pytest.approx(0.0, abs=1e-3)


def test_the_frame_is_on_the_sole_that_carries() -> None:
    made = world()
    truth = GroundTruth(made.model, qrio())
    left, right = Sole(0.0, 0.05, 0.03, (1.0, 0.0)), Sole(0.1, -0.05, 0.0, (1.0, 0.0))
    assert truth.frame((left, right), (True, False)).z == 0.03
    assert truth.frame((left, right), (False, True)).z == 0.0
    assert truth.frame((left, right), (True, True)).z == pytest.approx(0.015)
    assert truth.frame((left, right), (False, False)).z == 0.0


@given(st.floats(-100.0, 100.0))
def test_wrapping_keeps_the_direction(angle: float) -> None:
    turned = wrapped(angle)
    assert -math.pi < turned <= math.pi
    assert math.cos(turned - angle) == pytest.approx(1.0, abs=1e-9)


def test_a_pose_has_its_columns_where_the_frame_has_its_axes() -> None:
    pose = pose_matrix(1.0, 2.0, 3.0, math.pi / 2)
    assert np.allclose(pose @ [1.0, 0.0, 0.0, 1.0], [1.0, 3.0, 3.0, 1.0])
