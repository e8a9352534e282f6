"""Tests of geoms that the core does not draw."""

import mujoco
import numpy as np
import pytest

from treadwell.senses.depth import DepthCamera, Pinhole

PINHOLE = Pinhole(88, 72, 101.4)
SDF = """
<mujoco><asset>
  <mesh name="ball" builtin="sphere" params="2" scale="0.2 0.2 0.2"/>
</asset><worldbody>
  <geom name="field" type="sdf" mesh="ball" pos="0.8 0 0.5"/>
  <geom name="wall" type="box" size="0.01 9 9" pos="2 0 0"/>
  <body name="head" mocap="true" pos="0 0 0.5"><camera name="eye" xyaxes="0 -1 0 0 0 1"/></body>
</worldbody></mujoco>
"""


def test_a_geom_that_the_core_does_not_draw_is_cast_by_mujoco_and_said_once(
    caplog: pytest.LogCaptureFixture,
) -> None:
    model = mujoco.MjModel.from_xml_string(SDF)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera = DepthCamera(model, "eye", PINHOLE)
    groups = model.geom_group.copy()
    for _ in range(2):
        cast = camera.cast(data)
    assert [record.message for record in caplog.records] == [
        "MuJoCo casts the depth camera's rays, slowly, at geoms of type mjGEOM_SDF: field"
    ]
    np.testing.assert_array_equal(model.geom_group, groups)
    assert cast.geom[36, 44] == model.geom("field").id
    assert cast.depth[36, 44] == pytest.approx(0.6, abs=0.01)
    assert cast.geom[2, 2] == model.geom("wall").id
    assert cast.depth[2, 2] == pytest.approx(1.99, abs=1e-9)
