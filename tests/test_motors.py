"""Claims about the servos as Python has them; what they do is claimed beside their code."""

import numpy as np
import pytest

from treadwell._core import Servos
from treadwell.physics.motors import JointTargets
from treadwell.robot.motor_limits import MotorLimits

STEP = 0.002
PLAY = np.radians(0.3)


def limits(n: int = 3) -> MotorLimits:
    return MotorLimits(
        kp=np.full(n, 150.0),
        kv=np.full(n, 3.0),
        peak_torque=np.full(n, 6.0),
        stall_torque=np.full(n, 8.5),
        no_load_speed=np.full(n, 7.0),
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
            MotorLimits(np.ones(2), np.ones(2), np.ones(2), np.ones(1), np.ones(2)),
            play=0.0,
            timestep=STEP,
        )
