"""Claims about motors: what a model says of them counts, and an angle is never a torque."""

import mujoco
import pytest

from treadwell.robot.loops import drivers
from treadwell.robot.motors_found import SPEED, Fitting, find_motor, needed_torque

SERVO = '<position joint="j" kp="20" kv="2" ctrlrange="-1.5 1.5"{more}/>'


def model_with(actuator: str, joint: str = "") -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody><body><freejoint/><geom size='.1' mass='6'/><body><joint name='j' "
        f"axis='0 1 0' {joint}/><geom size='.1' mass='1'/></body></body></worldbody>"
        f"<actuator>{actuator}</actuator></mujoco>"
    )


@pytest.mark.parametrize(
    ("actuator", "joint", "torque", "told"),
    [
        (SERVO.format(more=""), "", 0.0, ""),
        (SERVO.format(more=' forcerange="-5 5"'), "", 5.0, "forcerange"),
        (SERVO.format(more=' forcerange="-5 5" gear="3"'), "", 15.0, "forcerange"),
        (SERVO.format(more=""), "actuatorfrcrange='-9 9'", 9.0, "actuatorfrcrange"),
        (SERVO.format(more=' forcerange="-5 5"'), "actuatorfrcrange='-9 9'", 9.0, "actuatorfrcra"),
        ('<motor joint="j" ctrlrange="-4.5 4.5" gear="25"/>', "", 112.5, "ctrlrange"),
        ('<motor joint="j" ctrlrange="-4 4"/>', "", 4.0, "ctrlrange"),
        ('<motor joint="j"/>', "", 0.0, ""),
    ],
)
def test_the_torque_is_what_the_model_says_of_torque(
    actuator: str, joint: str, torque: float, told: str
) -> None:
    found = find_motor(model_with(actuator, joint), 1)
    assert found.torque == pytest.approx(torque)
    assert found.torque_from.startswith(told)
    assert bool(found.torque_from) == bool(told)


def test_gains_of_a_servo_are_at_the_joint() -> None:
    found = find_motor(model_with(SERVO.format(more=' gear="3"')), 1)
    assert found.stiffness == pytest.approx(180.0)
    assert found.stiffness_damping == pytest.approx(18.0)


def test_what_a_model_does_not_say_follows_from_weight_and_legs_and_is_said_to() -> None:
    model = model_with('<motor joint="j"/>')
    torque, told = Fitting(model, 0.25).torque(1, "knee")
    assert told == ""
    assert torque == pytest.approx(needed_torque(model, 0.25), rel=0.05)
    assert needed_torque(model, 0.5) == pytest.approx(2.0 * needed_torque(model, 0.25))


def test_a_bound_that_is_alike_on_all_joints_and_far_beyond_need_is_no_motors() -> None:
    alike = '<motor joint="j" ctrlrange="-100 100"/>'
    fitting = Fitting(model_with(alike), 0.25)
    assert fitting.bound == 100.0
    assert fitting.torque(1, "knee")[1] == ""
    assert Fitting(model_with(alike.replace("100", "10")), 0.25).torque(1, "knee")[0] == 10.0


def test_a_servo_neither_shakes_nor_takes_a_soft_gain_of_the_model() -> None:
    soft = model_with(SERVO.format(more=' forcerange="-30 30"').replace('"20"', '"1"'))
    servo = Fitting(soft, 0.25).servo(1, "knee", 1e-4)
    assert servo.kp == pytest.approx(120.0)
    assert servo.armature is not None
    assert servo.kp * 0.002**2 / (1e-4 + servo.armature) < 1.0
    assert servo.speed == SPEED
    assert drivers(soft) == {1}


def test_a_large_damping_is_the_line_to_the_no_load_speed_or_else_the_servos() -> None:
    fast = Fitting(model_with(SERVO.format(more=' forcerange="-5 5"'), "damping='1'"), 0.25)
    assert fast.servo(1, None, 0.01).speed == pytest.approx(5.0)
    slow = Fitting(model_with(SERVO.format(more=' forcerange="-5 5"'), "damping='5'"), 0.25)
    assert slow.servo(1, None, 0.01).speed == SPEED
    assert slow.servo(1, None, 0.01).damping == pytest.approx(0.1)
