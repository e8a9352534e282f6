"""Claims about encoders, inertial unit and foot forces in MuJoCo; more beside their code."""

from collections.abc import Mapping
from types import MappingProxyType

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from treadwell._core import BodySenses, Servos
from treadwell.random_streams import stream
from treadwell.robot.followers import Tie
from treadwell.robot.motor_limits import MotorLimits
from treadwell.senses.body import (
    EncoderSenses,
    FootSenses,
    Generators,
    ImuNoise,
    SensedSole,
    body_senses,
)

Floats = NDArray[np.float64]
QUANTUM = np.radians(0.088)
TICK = 10_000_000
IDEAL = ImuNoise()
SOLES = (
    SensedSole("forces", "body", (0.0, 0.0, -0.1), (0.2, 0.2)),
    SensedSole("forces", "body", (0.0, 0.0, -0.1), (0.2, 0.2)),
)
MODEL = mujoco.MjModel.from_xml_string("""
<mujoco><option timestep="0.002"/>
<worldbody><geom type="plane" size="5 5 1"/>
  <body name="body" pos="0 0 0.1"><freejoint/><geom type="box" size="0.1 0.1 0.1" mass="2"/>
    <site name="imu" type="sphere" size="0.01" pos="0.03 0 0.02" euler="90 0 0"/>
    <body pos="0 0 0.2"><joint name="one" axis="0 1 0"/><geom size="0.01" mass="0.01"/>
      <body pos="0 0 0.1"><joint name="two"/><geom size="0.01" mass="0.01"/></body></body>
  </body>
</worldbody>
<sensor><contact name="forces" body1="body" num="1" reduce="netforce" data="force pos"/></sensor>
</mujoco>
""")


def state() -> mujoco.MjData:
    data = mujoco.MjData(MODEL)
    mujoco.mj_forward(MODEL, data)
    return data


def senses(
    imu: ImuNoise = IDEAL,
    *,
    quantum: float = 0.0,
    offsets: tuple[float, float] = (0.0, 0.0),
    ties: Mapping[int, Tie] = MappingProxyType({}),
    foot_noise: tuple[float, float] = (0.0, 0.0),
    seed: int = 0,
) -> BodySenses:
    return body_senses(
        MODEL,
        EncoderSenses(("two", "one"), quantum, np.array(offsets), ties),
        "imu",
        imu,
        FootSenses(SOLES, *foot_noise),
        Generators(*(stream(seed, name) for name in "eif")),
    )


def inertial(made: BodySenses, data: mujoco.MjData, time_ns: int) -> tuple[Floats, Floats]:
    return made.read(data, time_ns, None)[2:4]


def leading() -> Servos:
    """Motors that lead their joints by half a radian."""
    one, none = np.ones(2), np.zeros(2)
    motors = Servos(MotorLimits(one, one, one, one, one, none, none), play=1.0, timestep=0.002)
    motors.command(np.zeros(2), np.zeros(2), np.full(2, 9.0))
    for _ in range(500):
        motors.torques(np.full(2, -9.0), np.zeros(2))
    return motors


def test_encoders_read_their_joints_motors_and_offsets_in_quanta() -> None:
    data = state()
    data.joint("one").qpos, data.joint("two").qpos = 0.1234567, -0.7654321
    data.joint("one").qvel, data.joint("two").qvel = 1.5, -2.5
    positions, velocities = senses().read(data, 0, None)[:2]
    assert positions.tolist() == [-0.7654321, 0.1234567]
    assert velocities.tolist() == [-2.5, 1.5]
    read = senses(quantum=QUANTUM, offsets=(0.01, 0.2), ties={1: Tie(0)}).read(data, 0, leading())
    assert read[0][0] == read[0][1] == pytest.approx(-0.2554321, abs=QUANTUM)
    assert read[1][0] == read[1][1] == pytest.approx(-2.5, abs=0.2)
    assert data.joint("one").qvel == 1.5


def test_another_data_object_is_read_from_then_on_and_one_of_another_model_refused() -> None:
    made, first, second = senses(), state(), state()
    first.joint("two").qpos, second.joint("two").qpos = 0.1, 0.2
    found = [made.read(data, 0, None)[0][0] for data in (first, second, first)]
    assert found == [0.1, 0.2, 0.1]
    other = mujoco.MjModel.from_xml_string("<mujoco/>")
    with pytest.raises(ValueError, match=r"qpos has 0 numbers, \d+ are needed"):
        made.read(mujoco.MjData(other), 0, None)


def test_an_offset_that_changes_is_read_at_the_next_tick() -> None:
    made, data = senses(), state()
    before = made.read(data, 0, None)[0]
    made.encoder_offsets[:] = (0.25, 0.0)
    assert (made.read(data, TICK, None)[0] - before).tolist() == [0.25, 0.0]


def test_at_rest_the_accelerometer_reads_gravity_upward_in_its_own_frame() -> None:
    imu = senses()
    angular_velocity, specific_force = inertial(imu, state(), 0)
    np.testing.assert_allclose(angular_velocity, 0.0, atol=1e-12)
    # The site is turned by 90 degrees about x: its y points up.
    np.testing.assert_allclose(specific_force, [0.0, 9.81, 0.0], atol=1e-9)


def test_a_falling_body_feels_no_force() -> None:
    data = state()
    data.qpos[2] = 2.0
    imu = senses()
    force = np.zeros(3)
    for i in range(5):
        for _ in range(5):
            mujoco.mj_step(MODEL, data)
        _, force = inertial(imu, data, i * TICK)
    np.testing.assert_allclose(force, 0.0, atol=0.05)


def test_the_gyro_reads_in_the_sites_frame_and_the_lever_is_felt() -> None:
    data = state()
    data.qpos[2] = 2.0
    rate = 3.0
    data.qvel[5] = rate
    imu = senses()
    forces = []
    for i in range(20):
        for _ in range(5):
            mujoco.mj_step(MODEL, data)
        angular_velocity, force = inertial(imu, data, i * TICK)
        np.testing.assert_allclose(angular_velocity, [0.0, rate, 0.0], atol=1e-2)
        forces.append(force)
    # It flies freely: what is felt is the centripetal pull toward the axis, 0.03 m away.
    assert np.mean(forces[2:], axis=0)[0] == pytest.approx(-(rate**2) * 0.03, abs=0.02)


def test_the_gyro_misses_nothing_between_two_readings() -> None:
    data = state()
    data.qpos[2] = 50.0
    mujoco.mj_forward(MODEL, data)
    imu, rng = senses(), stream(0, "w")
    inertial(imu, data, 0)
    turned = 0.0
    for i in range(1, 50):
        for _ in range(5):
            data.qvel[3:6] = [0.0, 0.0, rng.uniform(-5.0, 8.0)]
            mujoco.mj_step(MODEL, data)
        mujoco.mj_forward(MODEL, data)
        angular_velocity, _ = inertial(imu, data, i * TICK)
        turned += angular_velocity[1] * 1e-9 * TICK
    rotation = data.body("body").xmat.reshape(3, 3)
    heading = np.arctan2(rotation[1, 0], rotation[0, 0])
    assert np.remainder(turned - heading + np.pi, 2.0 * np.pi) - np.pi == pytest.approx(0, abs=1e-6)


def test_the_accelerometer_does_not_take_a_pause_for_a_jerk() -> None:
    data = state()
    imu = senses()
    inertial(imu, data, 0)
    data.qvel[0] = 1.0
    mujoco.mj_forward(MODEL, data)
    _, force = inertial(imu, data, 1_000_000_000)
    np.testing.assert_allclose(force, [0.0, 9.81, 0.0], atol=1e-9)


def test_biases_stay_and_noise_is_new() -> None:
    noise = ImuNoise(0.002, 0.00087, 0.15, 0.05)
    data = state()
    biases = []
    for seed in range(60):
        imu = senses(noise, seed=seed)
        samples = np.array([np.concatenate(inertial(imu, data, i * TICK)) for i in range(400)])
        assert samples.std(axis=0)[:3] == pytest.approx(0.002, rel=0.25)
        assert samples.std(axis=0)[3:] == pytest.approx(0.15, rel=0.25)
        biases.append(samples.mean(axis=0) - [0, 0, 0, 0, 9.81, 0])
    assert np.std(biases, axis=0)[:3] == pytest.approx(0.00087, rel=0.3)
    assert np.std(biases, axis=0)[3:] == pytest.approx(0.05, rel=0.3)


def standing() -> mujoco.MjData:
    data = state()
    for _ in range(500):
        mujoco.mj_step(MODEL, data)
    return data


def test_the_feet_carry_the_weight() -> None:
    forces = senses().read(standing(), 0, None)[4]
    assert forces.shape == (2, 4)
    assert forces[0].sum() == pytest.approx(2.02 * 9.81, rel=0.01)
    np.testing.assert_array_equal(forces[0], forces[1])


@given(x=st.floats(-0.1, 0.1), y=st.floats(-0.1, 0.1), yaw=st.floats(-3.1, 3.1))
def test_a_sole_shares_a_force_as_a_stiff_plate_does(x: float, y: float, yaw: float) -> None:
    data = state()
    data.qpos[:7] = [0.3, -0.2, 0.1, np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]
    mujoco.mj_kinematics(MODEL, data)
    body = data.body("body")
    data.sensordata[:3] = [0.0, 0.0, -20.0]
    data.sensordata[3:] = body.xpos + body.xmat.reshape(3, 3) @ [x, y, -0.1]
    forces = senses().read(data, 0, None)[4][0]
    corners = np.array([[0.1, 0.1], [0.1, -0.1], [-0.1, 0.1], [-0.1, -0.1]])
    assert forces.min() >= 0.0
    assert forces.sum() == pytest.approx(20.0)
    assert forces @ corners / 20.0 == pytest.approx([x, y], abs=1e-9)


@pytest.mark.parametrize("force", [[15.0, 0.0, 0.0], [0.0, -15.0, 0.0], [0.0, 0.0, 15.0]])
def test_what_pushes_along_a_sole_or_pulls_at_it_is_not_felt(force: list[float]) -> None:
    data = state()
    mujoco.mj_kinematics(MODEL, data)
    data.sensordata[:3] = data.body("body").xmat.reshape(3, 3) @ force
    data.sensordata[3:] = data.body("body").xpos + np.array([0.05, 0.0, -0.1])
    forces = senses().read(data, 0, None)[4]
    assert np.abs(forces).max() < 1e-12


def test_foot_forces_are_noisy_and_never_pull() -> None:
    data = standing()
    exact = senses().read(data, 0, None)[4]
    feet = senses(foot_noise=(0.02, 0.1))
    found = np.array([feet.read(data, 0, None)[4] for _ in range(2000)])
    expected = np.sqrt((0.02 * exact) ** 2 + 0.1**2)
    np.testing.assert_allclose(found.std(axis=0), expected, rtol=0.1)
    data.sensordata[:] = 0.0
    lifted = np.array([feet.read(data, 0, None)[4] for _ in range(200)])
    assert lifted.min() == 0.0
    assert lifted.max() > 0.0
