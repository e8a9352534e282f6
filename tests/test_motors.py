"""Claims about the servos as Python has them; what they do is claimed beside their code."""

from dataclasses import replace

import numpy as np
import pytest

from treadwell._core import Servos
from treadwell.protocols import JointTargets
from treadwell.robot.followers import Tie
from treadwell.robot.motor_limits import LEAST_SHARE, MotorLimits, rotors

STEP = 0.002
PLAY = np.radians(0.3)


def limits(n: int = 3) -> MotorLimits:
    return MotorLimits(
        kp=np.full(n, 150.0),
        kv=np.full(n, 3.0),
        peak_torque=np.full(n, 6.0),
        stall_torque=np.full(n, 8.5),
        no_load_speed=np.full(n, 7.0),
        friction=np.zeros(n),
        inertia=np.zeros(n),
    )


def command(servos: Servos, targets: JointTargets) -> bool:
    return servos.command(targets.position, targets.velocity, targets.torque)


def test_torques_are_of_what_was_asked_within_the_limits() -> None:
    servos = Servos(limits(), play=0.0, timestep=STEP)
    targets = JointTargets(np.array([0.51, 9.0, -9.0]), np.array([0.2, 0.0, 0.0]), np.zeros(3))
    assert command(servos, targets)
    torques = servos.torques(np.array([0.5, 0.0, 0.0]), np.array([0.1, 7.0, 7.0]))
    assert torques == pytest.approx([150.0 * 0.01 + 3.0 * 0.1, 0.0, -6.0])


def test_an_encoder_offset_that_changes_is_heeded_at_the_next_command() -> None:
    servos = Servos(limits(1), play=0.0, timestep=STEP)
    offsets = np.zeros(1)
    servos.encoder_offsets = offsets
    for offset in (0.0, 0.02):
        offsets[:] = offset
        assert command(servos, JointTargets(np.array([0.5]), np.zeros(1), np.zeros(1)))
        assert servos.torques(np.array([0.5 - offset]), np.zeros(1)) == pytest.approx(0, abs=1e-12)


def test_a_motor_leads_its_joint_by_half_the_play() -> None:
    servos = Servos(limits(1), play=PLAY, timestep=STEP)
    assert command(servos, JointTargets(np.zeros(1), np.zeros(1), np.array([4.0])))
    for _ in range(100):
        servos.torques(np.zeros(1), np.zeros(1))
    assert servos.measured_angle(np.array([0.3])) == pytest.approx([0.3 + PLAY / 2], abs=1e-6)


@pytest.mark.parametrize(
    "targets",
    [
        JointTargets(np.full(3, np.nan), np.zeros(3), np.zeros(3)),
        JointTargets(np.zeros(3), np.zeros(2), np.zeros(3)),
        JointTargets(np.zeros(3), np.zeros(3), np.full(3, np.inf)),
    ],
)
def test_targets_that_cannot_be_are_not_taken(targets: JointTargets) -> None:
    servos = Servos(limits(), play=0.0, timestep=STEP)
    assert command(servos, JointTargets(np.ones(3), np.zeros(3), np.zeros(3)))
    before = servos.torques(np.ones(3), np.zeros(3))
    assert not command(servos, targets)
    assert np.array_equal(servos.torques(np.ones(3), np.zeros(3)), before)


def test_limits_of_different_lengths_are_refused() -> None:
    with pytest.raises(ValueError, match="one value a joint"):
        Servos(
            replace(limits(2), stall_torque=np.ones(1)),
            play=0.0,
            timestep=STEP,
        )


def test_friction_and_rotor_of_a_joint_without_a_motor_are_its_leaders() -> None:
    armature, moved, friction = np.full(3, 0.01), np.full(3, 0.02), np.full(3, 0.05)
    inertia, rubbing = rotors(armature, moved, friction, {2: Tie(0)})
    assert inertia.tolist() == [0.02, 0.01, 0.0]
    assert rubbing.tolist() == [0.1, 0.05, 0.0]
    assert friction.tolist() == [0.05] * 3
    inertia, rubbing = rotors(armature, moved, friction, {2: Tie(0, ratio=-0.5)})
    assert inertia == pytest.approx([0.0125, 0.01, 0.0])
    assert rubbing == pytest.approx([0.075, 0.05, 0.0])


def test_a_joint_without_armature_rubs_by_what_it_moves() -> None:
    inertia, _ = rotors(np.array([0.0, 0.01]), np.full(2, 0.03), np.full(2, 0.05), {})
    assert inertia == pytest.approx([0.03 * LEAST_SHARE, 0.01])


def test_friction_stops_what_turns_with_the_motor_within_a_step_and_no_more() -> None:
    rubs = replace(limits(2), friction=np.full(2, 0.05), inertia=np.full(2, 0.008))
    servos, free = (Servos(each, play=0.0, timestep=STEP) for each in (rubs, limits(2)))
    for speed in (0.001, 1.0, -1.0):
        speeds = np.full(2, speed)
        taken = free.torques(np.zeros(2), speeds) - servos.torques(np.zeros(2), speeds)
        assert taken == pytest.approx(np.clip(0.008 / STEP * speeds, -0.05, 0.05))
