"""Tests of the rays: against analytic scenes."""

from unittest.mock import patch

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.senses.depth import DepthCamera, Mount, Pinhole
from treadwell.senses.view import View

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


CLUTTER = """
<mujoco><worldbody>
  <geom type="plane" size="9 9 1"/>
  <geom type="box" size="0.3 0.3 0.015" pos="0.7 0 0.015"/>
  <geom type="box" size="0.2 0.3 0.015" pos="0.8 0 0.045"/>
  <geom type="box" size="0.1 0.04 0.2" pos="0.6 0.3 0.2" euler="10 5 30"/>
  <geom type="cylinder" size="0.03 0.3" pos="0.5 -0.2 0.3"/>
  <body pos="0.9 0.1 0.1"><geom type="sphere" size="0.1"/></body>
  <body pos="1.2 0.2 0.2" euler="0 30 10">
    <geom type="ellipsoid" size="0.1 0.05 0.2"/>
    <geom type="box" size="0.6 0.01 0.01" pos="0.1 0.2 0" euler="20 10 60"/>
  </body>
  <body pos="0.3 0.1 0.1"><geom type="capsule" size="0.02 0.2" euler="80 10 0"/></body>
  <body name="head" mocap="true"><camera name="eye" xyaxes="0 -1 0 0 0 1"/></body>
</worldbody></mujoco>
"""


def clutter(x: float, tilt: float, yaw: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return things in a heap, seen from 0.5 m above the floor at x m."""
    model = mujoco.MjModel.from_xml_string(CLUTTER)
    data = mujoco.MjData(model)
    data.mocap_pos[0] = [x, 0.0, 0.5]
    mujoco.mju_euler2Quat(data.mocap_quat[0], [yaw, tilt, 0.0], "zyx")
    mujoco.mj_forward(model, data)
    return model, data


@settings(max_examples=40, deadline=None)
@given(st.floats(-0.2, 1.2), st.floats(-0.5, 1.4), st.floats(-0.6, 0.6), st.integers(7, 90))
def test_the_rays_that_are_saved_would_have_met_the_same(
    x: float, tilt: float, yaw: float, width: int
) -> None:
    model, data = clutter(x, tilt, yaw)
    pinhole = Pinhole(width, 72, 101.4)
    saving = DepthCamera(model, "eye", pinhole).cast(data)
    whole = DepthCamera(model, "eye", pinhole, every_pixel=True).cast(data)
    same = saving.geom == whole.geom
    # What is narrower than two pixels, as the tip of a corner is, can be missed.
    assert np.count_nonzero(~same) <= 3
    np.testing.assert_allclose(saving.depth[same], whole.depth[same], rtol=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.floats(-0.2, 1.2), st.floats(-0.5, 1.4), st.floats(-0.6, 0.6))
def test_what_is_hidden_because_it_lies_beside_the_picture_is_met_by_no_ray(
    x: float, tilt: float, yaw: float
) -> None:
    model, data = clutter(x, tilt, yaw)
    fields = (model.geom_group, model.body_geomnum, model.body_bvhadr)
    before = [field.copy() for field in fields]
    camera = DepthCamera(model, "eye", PINHOLE)
    saving = camera.cast(data)
    for field, was in zip(fields, before, strict=True):
        np.testing.assert_array_equal(field, was)
    with patch.object(View, "beside", return_value=np.zeros(model.ngeom, np.bool_)):
        whole = camera.cast(data)
    assert (saving.geom == whole.geom).all()
    np.testing.assert_array_equal(saving.depth, whole.depth)


def test_what_lies_behind_the_camera_is_hidden_from_its_rays() -> None:
    model, data = world(0.5, 0.0)
    backward = Mount(rotation=np.diag([-1.0, 1.0, -1.0]))
    for mount, hidden in ((Mount(), False), (backward, True)):
        camera = DepthCamera(model, "eye", PINHOLE, mount)
        beside = View(model, PINHOLE.borders()).beside(data, *camera.pose(data))
        assert beside[model.geom("nose").id] == hidden
        assert not beside[model.geom("floor").id]


def test_a_long_wall_beside_the_picture_is_hidden_and_its_body_passed_over() -> None:
    wall = '<body name="wall" pos="1 {} 0"><geom type="box" size="2 0.02 1"/></body>'
    for y, hidden in ((1.6, True), (0.8, False)):
        xml = WORLD.replace("</worldbody>", wall.format(y) + "</worldbody>")
        model = mujoco.MjModel.from_xml_string(xml.replace('pos="0.3 0 0"', 'pos="-0.3 0 0"'))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        camera = DepthCamera(model, "eye", Pinhole(88, 72, 88.0))
        with View(model, camera.pinhole.borders()).alone(data, *camera.pose(data)):
            bodies = [name for name in ("wall", "nose") if model.body(name).geomnum[0]]
        assert bodies == ([] if hidden else ["wall"])


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
