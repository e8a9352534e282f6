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
    assert {field.name for field in fields(Frame)} == {"exposure_ns", "arrival_ns", "depth"}


def test_an_observation_cannot_be_changed() -> None:
    seen = observation()
    with pytest.raises(FrozenInstanceError):
        seen.time_ns = 0  # type: ignore[misc]
