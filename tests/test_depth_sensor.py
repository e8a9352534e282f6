"""Tests of the depth camera in time."""

import mujoco
import numpy as np
import pytest

from treadwell.observation import Frame
from treadwell.senses.depth import DepthCamera, Pinhole
from treadwell.senses.depth_sensor import DepthSensor, brightness

TICK = 10_000_000
PERIOD = 80_000_000
FULL = mujoco.mjtState.mjSTATE_INTEGRATION
MODEL = mujoco.MjModel.from_xml_string("""
<mujoco><worldbody><geom type="plane" size="5 5 1"/><body name="eye" pos="0 0 0.5">
  <joint name="lift" type="slide" axis="0 0 1"/><geom size="0.01"/><camera name="eye"/>
</body></worldbody></mujoco>
""")


def sensor(latency: int = 0) -> tuple[DepthSensor, mujoco.MjData]:
    data = mujoco.MjData(MODEL)
    mujoco.mj_forward(MODEL, data)
    camera = DepthCamera(MODEL, "eye", Pinhole(8, 6, 10.0))
    return DepthSensor(camera, None, PERIOD, latency), data


def frames(seen: DepthSensor, data: mujoco.MjData, ticks: range) -> list[Frame]:
    found = [seen.observe(data, i * TICK) for i in ticks]
    return [frame for frame in found if frame is not None]


def test_frames_come_at_multiples_of_the_period() -> None:
    seen, data = sensor()
    found = frames(seen, data, range(100))
    assert [frame.exposure_ns for frame in found] == [i * PERIOD for i in range(13)]
    assert all(frame.arrival_ns == frame.exposure_ns for frame in found)


@pytest.mark.parametrize(
    ("latency", "arrives"), [(15_000_000, 2), (80_000_000, 8), (250_000_000, 25)]
)
def test_a_frame_arrives_late_and_shows_what_was_at_its_exposure(
    latency: int, arrives: int
) -> None:
    seen, data = sensor(latency)
    for i in range(60):
        data.qpos[0] = 0.001 * i
        mujoco.mj_forward(MODEL, data)
        frame = seen.observe(data, i * TICK)
        assert (frame is not None) == (i >= arrives and (i - arrives) % 8 == 0)
        if frame is not None:
            exposed = i - arrives
            assert frame.exposure_ns == exposed * TICK
            assert frame.arrival_ns == i * TICK
            np.testing.assert_allclose(frame.depth, 0.5 + 0.001 * exposed, atol=1e-6)


def test_a_blind_camera_exposes_nothing_and_sees_again_afterwards() -> None:
    seen, data = sensor()
    seen.observe(data, 0)
    seen.blind(3 * PERIOD)
    found = frames(seen, data, range(1, 40))
    assert [frame.exposure_ns for frame in found] == [3 * PERIOD, 4 * PERIOD]


def test_what_was_under_way_arrives_though_the_camera_is_blind() -> None:
    seen, data = sensor(latency=50_000_000)
    seen.observe(data, 0)
    seen.blind(10 * PERIOD)
    found = frames(seen, data, range(1, 40))
    assert [(frame.exposure_ns, frame.arrival_ns) for frame in found] == [(0, 50_000_000)]


def test_looking_changes_nothing_in_the_state() -> None:
    seen, data = sensor()
    before, after = (np.empty(mujoco.mj_stateSize(MODEL, FULL)) for _ in range(2))
    mujoco.mj_getState(MODEL, data, before, FULL)
    poses = data.geom_xpos.copy()
    seen.observe(data, 0)
    mujoco.mj_getState(MODEL, data, after, FULL)
    np.testing.assert_array_equal(before, after)
    np.testing.assert_array_equal(poses, data.geom_xpos)


def test_intensity_stands_beside_the_depth_where_it_is_asked_for() -> None:
    model = mujoco.MjModel.from_xml_string("""
    <mujoco><asset><material name="dark" rgba="0.1 0.2 0.3 1"/></asset><worldbody>
      <geom type="plane" size="5 5 1" rgba="0.6 0.6 0.6 1"/>
      <geom type="box" size="0.05 1 0.01" pos="0.06 0 0" material="dark"/>
      <body name="eye" pos="0 0 0.5"><geom size="0.01"/><camera name="eye"/></body>
    </worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera = DepthCamera(model, "eye", Pinhole(8, 6, 10.0))
    plain = DepthSensor(camera, None, PERIOD, 0).observe(data, 0)
    seen = DepthSensor(camera, None, PERIOD, 0, brightness(model)).observe(data, 0)
    assert plain is not None
    assert seen is not None
    assert plain.intensity is None
    assert seen.intensity is not None
    assert seen.intensity.dtype == np.uint8
    assert seen.intensity.shape == seen.depth.shape
    np.testing.assert_array_equal(seen.depth, plain.depth)
    box = seen.depth < 0.495
    assert box.any()
    assert (seen.intensity[box] == 51).all()
    assert (seen.intensity[~box] == 153).all()


def test_what_cannot_be_is_refused() -> None:
    camera = DepthCamera(MODEL, "eye", Pinhole(8, 6, 10.0))
    with pytest.raises(ValueError, match="period must be > 0"):
        DepthSensor(camera, None, 0, 0)
    with pytest.raises(ValueError, match="latency must be >= 0"):
        DepthSensor(camera, None, PERIOD, -1)
