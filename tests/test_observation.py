"""Tests of what the core is given."""

from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest

from treadwell.observation import Frame, Observation


def observation() -> Observation:
    frame = Frame(0, 10, np.ones((2, 3), np.float32))
    zeros = np.zeros(3)
    return Observation(10, zeros, zeros, zeros, zeros, np.zeros((2, 4)), frame)


def test_an_observation_has_no_pose() -> None:
    assert {field.name for field in fields(Observation)} == {
        "time_ns",
        "joint_positions",
        "joint_velocities",
        "angular_velocity",
        "specific_force",
        "foot_forces",
        "depth",
    }
    assert {field.name for field in fields(Frame)} == {
        "exposure_ns",
        "intensity",
        "arrival_ns",
        "depth",
    }


def test_an_observation_cannot_be_changed() -> None:
    seen = observation()
    with pytest.raises(FrozenInstanceError):
        seen.time_ns = 0  # type: ignore[misc]


def test_a_frame_is_read_as_its_image() -> None:
    image = np.array([[1.0, np.nan, 2.0], [3.0, 4.0, 5.0]], np.float32)
    frame = Frame(0, 10, image)
    assert frame.shape == (2, 3)
    assert frame.dtype == np.dtype(np.float32)
    assert np.nanmax(frame) == 5.0
    assert frame[1, 0] == 3.0
    np.testing.assert_array_equal(np.asarray(frame), image)
