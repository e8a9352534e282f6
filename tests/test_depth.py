"""Tests of the rays: against analytic scenes."""

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.senses.depth import DepthCamera, Mount, Pinhole

WORLD = """
<mujoco><worldbody>
  <geom name="floor" type="plane" size="9 9 1"/>
  <geom name="unseen" type="box" size="9 9 0.01" pos="0 0 0.1" group="3"/>
  <geom name="glass" type="box" size="9 9 0.01" pos="0 0 0.1" rgba="1 1 1 0"/>
  <body name="head" mocap="true">
    <geom name="skull" type="sphere" size="0.1"/>
    <camera name="eye" xyaxes="0 -1 0 0 0 1"/>
    <body name="nose" pos="0.3 0 0"><geom name="nose" type="sphere" size="0.02"/></body>
  </body>
</worldbody></mujoco>
"""
PINHOLE = Pinhole(88, 72, 101.4)


def world(height: float, tilt: float, yaw: float = 0.0) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(WORLD)
    data = mujoco.MjData(model)
    data.mocap_pos[0] = [0.0, 0.0, height]
    quaternion = np.empty(4)
    mujoco.mju_euler2Quat(quaternion, [yaw, tilt, 0.0], "zyx")
    data.mocap_quat[0] = quaternion
    mujoco.mj_forward(model, data)
    return model, data


@settings(max_examples=30, deadline=None)
@given(st.floats(0.3, 1.5), st.floats(0.4, 1.4), st.floats(-3.0, 3.0))
def test_the_depth_of_the_floor_is_the_analytic_one(height: float, tilt: float, yaw: float) -> None:
    model, data = world(height, tilt, yaw)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    row = np.arange(72)[:, None]
    # A ray's slope downward, for a camera that looks down by the tilt.
    down = np.sin(tilt) + np.cos(tilt) * (row - 35.5) / PINHOLE.focal
    expected = np.broadcast_to(height / np.maximum(down, 1e-3), (72, 88))
    floor = (cast.geom == model.geom("floor").id) & (expected < 8.0)
    assert floor.sum() > 1000
    np.testing.assert_allclose(cast.depth[floor], expected[floor], rtol=0.0, atol=1e-6)


def test_every_geom_is_where_the_pinhole_projects_it() -> None:
    model, data = world(0.5, 0.0)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    rows, columns = np.nonzero(cast.geom == model.geom("nose").id)
    assert rows.mean() == pytest.approx(35.5, abs=0.01)
    assert columns.mean() == pytest.approx(43.5, abs=0.01)
    assert np.nanmin(cast.depth) == pytest.approx(0.28, abs=1e-4)
    radius_px = PINHOLE.focal * 0.02 / 0.3
    assert rows.size == pytest.approx(np.pi * radius_px**2, rel=0.1)


def test_the_camera_sees_its_robot_but_not_the_body_that_carries_it() -> None:
    model, data = world(0.5, 0.5)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    assert model.geom("nose").id in cast.geom
    assert model.geom("skull").id not in cast.geom


def test_what_is_invisible_is_not_seen() -> None:
    model, data = world(0.5, 0.5)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    assert model.geom("unseen").id not in cast.geom
    assert model.geom("glass").id not in cast.geom


def test_nothing_in_sight_is_nan() -> None:
    model, data = world(0.5, -0.5)
    cast = DepthCamera(model, "eye", PINHOLE).cast(data)
    assert np.isnan(cast.depth[:25]).all()
    assert ((cast.geom == -1) == np.isnan(cast.depth)).all()


def test_a_mount_moves_the_rays_as_moving_the_camera_does() -> None:
    turn = 0.1
    model, data = world(0.5, 0.6 + turn)
    there = DepthCamera(model, "eye", PINHOLE).cast(data)
    model, data = world(0.5, 0.6)
    nod = np.array([[1, 0, 0], [0, np.cos(turn), np.sin(turn)], [0, -np.sin(turn), np.cos(turn)]])
    mounted = DepthCamera(model, "eye", PINHOLE, Mount(rotation=nod)).cast(data)
    floor = model.geom("floor").id
    both = (there.geom == floor) & (mounted.geom == floor)
    assert both.sum() > 3000
    np.testing.assert_allclose(mounted.depth[both], there.depth[both], atol=1e-6)


def test_a_mounts_translation_is_in_the_optical_frame() -> None:
    model, data = world(0.5, np.pi / 2)
    nearer = Mount(translation=np.array([0.0, 0.0, 0.01]))
    cast = DepthCamera(model, "eye", PINHOLE, nearer).cast(data)
    assert cast.depth[0, 0] == pytest.approx(0.49, abs=1e-6)


def test_an_empty_image_is_refused() -> None:
    with pytest.raises(ValueError, match="size must be > 0, got 0 x 72"):
        Pinhole(0, 72, 100.0)
    with pytest.raises(ValueError, match="focal length must be > 0"):
        Pinhole(88, 72, -1.0)
