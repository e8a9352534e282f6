"""Claims about the servos: within the motor's limits always, and stable with play."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadwell.physics.motors import JointTargets, Motors
from treadwell.robot.motor_limits import MotorLimits

STEP = 0.002
PLAY = np.radians(0.3)


def limits(n: int = 1, *, kp: float = 150.0, kv: float = 3.0) -> MotorLimits:
    return MotorLimits(
        kp=np.full(n, kp),
        kv=np.full(n, kv),
        peak_torque=np.full(n, 6.0),
        stall_torque=np.full(n, 8.5),
        no_load_speed=np.full(n, 7.0),
    )


def targets(position: np.ndarray) -> JointTargets:
    return JointTargets(position, np.zeros_like(position), np.zeros_like(position))


def triple(bound: float) -> st.SearchStrategy[np.ndarray]:
    return arrays(np.float64, 3, elements=st.floats(-bound, bound))


@given(asked=triple(1e6), feed=triple(1e6), angle=triple(3.0), speed=triple(50.0))
def test_no_torque_is_outside_the_peak_or_the_torque_speed_line(
    asked: np.ndarray, feed: np.ndarray, angle: np.ndarray, speed: np.ndarray
) -> None:
    motors = Motors(limits(3), play=PLAY, timestep=STEP)
    motors.command(JointTargets(asked, np.zeros(3), feed))
    torque = motors.torques(angle, speed)
    assert (np.abs(torque) <= 6.0).all()
    driving = torque * speed > 0.0
    line = np.maximum(8.5 * (1.0 - np.abs(speed) / 7.0), 0.0)
    assert (np.abs(torque) <= line + 1e-12)[driving].all()


def test_at_the_no_load_speed_a_motor_can_only_brake() -> None:
    motors = Motors(limits(), play=0.0, timestep=STEP)
    motors.command(targets(np.array([10.0])))
    assert motors.torques(np.zeros(1), np.array([7.0])) == 0.0
    assert motors.torques(np.zeros(1), np.array([-7.0])) == 6.0


def test_without_play_and_within_limits_the_servo_is_its_formula() -> None:
    motors = Motors(limits(), play=0.0, timestep=STEP)
    motors.command(JointTargets(np.array([0.51]), np.array([0.2]), np.array([0.7])))
    torque = motors.torques(np.array([0.5]), np.array([0.1]))
    assert torque == pytest.approx(150.0 * 0.01 + 3.0 * 0.1 + 0.7)


def test_a_servo_holds_the_joint_off_by_its_encoders_offset() -> None:
    motors = Motors(limits(), play=0.0, timestep=STEP)
    motors.encoder_offsets = np.array([0.02])
    motors.command(targets(np.array([0.5])))
    assert motors.torques(np.array([0.48]), np.zeros(1)) == pytest.approx(0.0, abs=1e-12)


@given(torque=st.floats(-6.0, 6.0))
def test_the_encoder_leads_the_joint_by_half_the_play_at_most_and_with_the_torques_sign(
    torque: float,
) -> None:
    motors = Motors(limits(), play=PLAY, timestep=STEP)
    for _ in range(100):
        lead = float(motors.measured_angle(np.zeros(1))[0])
        motors.command(JointTargets(np.array([lead]), np.zeros(1), np.array([torque])))
        motors.torques(np.zeros(1), np.zeros(1))
        assert abs(lead) <= 0.5 * PLAY
        assert lead * torque >= 0.0
    if abs(torque) > 0.5:
        assert abs(lead) == pytest.approx(0.5 * PLAY, rel=1e-6)


def test_a_change_of_sign_loses_the_whole_play() -> None:
    motors = Motors(limits(), play=PLAY, timestep=STEP)
    angles = []
    for torque in (4.0, -4.0):
        motors.command(JointTargets(np.zeros(1), np.zeros(1), np.array([torque])))
        for _ in range(100):
            motors.torques(np.zeros(1), np.zeros(1))
        angles.append(float(motors.measured_angle(np.zeros(1))[0]))
    assert angles[0] - angles[1] == pytest.approx(PLAY, rel=1e-6)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(
    kp=st.floats(5.0, 300.0),
    inertia=st.floats(0.01, 0.1),
    play=st.floats(0.0, 0.03),
    start=st.floats(-0.3, 0.3),
)
def test_a_servo_with_any_play_brings_an_unloaded_joint_to_rest(
    kp: float, inertia: float, play: float, start: float
) -> None:
    kv = 1.4 * np.sqrt(kp * inertia)
    motors = Motors(limits(kp=kp, kv=kv), play=play, timestep=STEP)
    motors.command(targets(np.zeros(1)))
    position, velocity = np.array([start]), np.zeros(1)
    for _ in range(3000):
        velocity += STEP * motors.torques(position, velocity) / inertia
        position += STEP * velocity
    assert abs(velocity[0]) < 1e-3
    assert abs(position[0]) <= 0.5 * play + 1e-3
