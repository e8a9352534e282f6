"""Tests of the error of the camera's pose."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.random_streams import stream
from treadwell.senses.camera_error import (
    CameraErrorBounds,
    draw_camera_error,
    rotation_of,
    turning_as,
)
from treadwell.senses.depth import DepthCamera, Pinhole

XML = """
<mujoco><worldbody><body name="pelvis" pos="0 0 0.3" euler="0 0 40"><freejoint/><geom size="0.05"/>
  <body pos="0 0 0.05"><joint name="waist" axis="0 1 0"/><geom size="0.05"/>
    <body pos="0 0 0.2"><joint name="pan" axis="0 0 1"/><geom size="0.02"/>
      <body><joint name="tilt" axis="0 1 0"/><geom size="0.05"/>
        <camera name="eye" pos="0.04 0.03 0.03" xyaxes="0 -1 0 0 0 1"/>
</body></body></body></body></worldbody></mujoco>
"""
MODEL = mujoco.MjModel.from_xml_string(XML)
JOINTS = ("waist", "pan", "tilt")
WEIGHTS = (0.25, 1.0, 1.0)
BOUNDS = CameraErrorBounds(roll_pitch=np.radians(7.0), yaw=np.radians(1.0), position=0.01)
PINHOLE = Pinhole(8, 8, 10.0)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000))
def test_the_camera_by_the_joints_readings_is_off_by_what_was_drawn(seed: int) -> None:
    error = draw_camera_error(MODEL, "eye", JOINTS, WEIGHTS, BOUNDS, stream(seed, "camera"))
    data = mujoco.MjData(MODEL)
    mujoco.mj_forward(MODEL, data)
    position, rotation = DepthCamera(MODEL, "eye", PINHOLE, error.mount).pose(data)
    for joint, offset in zip(JOINTS, error.offsets, strict=True):
        data.joint(joint).qpos += offset
    mujoco.mj_forward(MODEL, data)
    read_position, read_rotation = DepthCamera(MODEL, "eye", PINHOLE).pose(data)

    rng = stream(seed, "camera")
    roll, pitch = rng.uniform(-BOUNDS.roll_pitch, BOUNDS.roll_pitch, 2)
    yaw = rng.uniform(-BOUNDS.yaw, BOUNDS.yaw)
    base = data.body("pelvis").xmat.reshape(3, 3)
    turn = base.T @ read_rotation @ rotation.T @ base
    np.testing.assert_allclose(turn, rotation_of(roll, pitch, yaw), atol=1e-9)
    assert np.linalg.norm(read_position - position) <= BOUNDS.position + 1e-9


def test_the_joints_take_what_their_axes_allow_and_the_mount_takes_the_rest() -> None:
    offsets, leans, rests = [], [], []
    for seed in range(100):
        error = draw_camera_error(MODEL, "eye", JOINTS, WEIGHTS, BOUNDS, stream(seed, "camera"))
        offsets.append(np.abs(error.offsets))
        turn = error.mount.rotation
        # In the optical frame roll is about z, pitch about x, yaw about y.
        rests.append(abs(np.arctan2(turn[1, 0], turn[0, 0])))
        leans.append(max(abs(turn[1, 2]), abs(turn[0, 2])))
    waist, pan, tilt = np.max(offsets, axis=0)
    assert np.degrees(tilt) == pytest.approx(0.8 * 7.0, rel=0.1)
    assert np.degrees(waist) == pytest.approx(0.2 * 7.0, rel=0.1)
    assert np.degrees(pan) < 1.6
    assert np.degrees(np.max(rests)) == pytest.approx(7.0, rel=0.1)
    assert np.degrees(np.max(leans)) < 1.0


def test_a_waist_that_rolls_takes_nothing_of_what_no_neck_can_take() -> None:
    rolls = mujoco.MjModel.from_xml_string(XML.replace('axis="0 1 0"', 'axis="1 0 0"', 1))
    neck = ("pan", "tilt")
    assert turning_as(MODEL, "eye", ("waist",), neck) == ("waist",)
    assert turning_as(rolls, "eye", ("waist",), neck) == ()
    assert turning_as(MODEL, "eye", ("waist",), ()) == ()
    assert turning_as(MODEL, "eye", (), neck) == ()


def test_no_error_is_none() -> None:
    none = CameraErrorBounds(0.0, 0.0, 0.0)
    error = draw_camera_error(MODEL, "eye", JOINTS, WEIGHTS, none, stream(0, "camera"))
    np.testing.assert_allclose(error.offsets, 0.0, atol=1e-12)
    np.testing.assert_allclose(error.mount.rotation, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(error.mount.translation, 0.0, atol=1e-12)


def test_rotations_are_about_x_then_y_then_z() -> None:
    quarter = np.pi / 2
    np.testing.assert_allclose(rotation_of(quarter, 0, 0) @ [0, 1, 0], [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(rotation_of(0, quarter, 0) @ [0, 0, 1], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(rotation_of(0, 0, quarter) @ [1, 0, 0], [0, 1, 0], atol=1e-15)
    np.testing.assert_allclose(
        rotation_of(0.1, 0.2, 0.3),
        rotation_of(0, 0, 0.3) @ rotation_of(0, 0.2, 0) @ rotation_of(0.1, 0, 0),
        atol=1e-15,
    )
