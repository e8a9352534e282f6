"""The servos: the one place where joint targets become torques, within what a motor could do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell.robot.motor_limits import MotorLimits

Floats = NDArray[np.float64]

PLAY_TIME = 0.01
"""Time in which the lost motion follows the torque's sign, s."""
PLAY_TORQUE = 0.05
"""Share of the peak torque that takes up the play."""


@dataclass(frozen=True, slots=True, eq=False)
class JointTargets:
    """What the core asks of the joints at one control tick; arrays by the robot's joint order.

    Attributes:
        position: (n,) rad.
        velocity: (n,) rad/s.
        torque: (n,) N·m, fed forward.
    """

    position: Floats
    velocity: Floats
    torque: Floats


class Motors:
    """A proportional-derivative servo with feed-forward on each joint, and the play in its gear.

    The torque is `kp (position* - angle) + kv (velocity* - velocity) + torque*`, held within the
    peak torque and, where a motor drives, within the line from the stall torque at rest to nothing
    at the no-load speed. Braking is limited by the peak alone.

    The angle is the motor's, before the gear's play; the encoder sits there too. It leads the joint
    by half of the play in the direction of the torque; the lead follows a change of sign with a
    time constant of `PLAY_TIME` and grows with the torque up to `PLAY_TORQUE` of the peak, or more
    for a stiff servo, so that the loop through it has a gain below one and is stable.

    Attributes:
        limits: what each motor can do.
        encoder_offsets: (n,) rad, what each encoder reads too much: the servo goes by its encoder.
            Zero unless it is given the array of the senses.
    """

    def __init__(self, limits: MotorLimits, *, play: float, timestep: float) -> None:
        """Build the motors at rest, in the middle of their play.

        Args:
            limits: what each motor can do.
            play: lost motion between the two directions of torque, rad; 0 for an ideal gear.
            timestep: of the physics, s.
        """
        self.limits = limits
        n = limits.kp.size
        self.encoder_offsets: Floats = np.zeros(n)
        self._half_play = 0.5 * play
        self._follow = np.full(n, -np.expm1(-timestep / PLAY_TIME))
        takes_up = np.maximum(PLAY_TORQUE * limits.peak_torque, limits.kp * self._half_play)
        self._lead_per_torque = self._half_play / takes_up
        self._slope = limits.stall_torque / limits.no_load_speed
        self._stall_backward = -limits.stall_torque
        self._nothing = np.zeros(n)
        self._most_lead = np.full(n, self._half_play)
        self._least_lead = -self._most_lead
        self._lead = np.zeros(n)
        self._angle = np.zeros(n)
        self._asked = np.zeros(n)
        self._torque = np.zeros(n)
        self._scratch = np.empty(n)
        self._bound = np.empty(n)

    @property
    def angle(self) -> Floats:
        """(n,) rad: the motors' angles at the last `torques`."""
        return self._angle

    def measured_angle(self, position: Floats) -> Floats:
        """Return the motors' angles (n,) rad, which encoders see, at joint angles (n,) rad."""
        return position + self._lead

    def command(self, targets: JointTargets) -> None:
        """Take what is asked for from now on."""
        limits = self.limits
        position = targets.position - self.encoder_offsets
        self._asked = targets.torque + limits.kp * position + limits.kv * targets.velocity

    def torques(self, position: Floats, velocity: Floats) -> Floats:
        """Return the torques for the coming physics step.

        Args:
            position: (n,) rad, true joint angles.
            velocity: (n,) rad/s, true joint velocities.

        Returns:
            (n,) N·m; the array is used again at the next call.
        """
        # Arrays of one shape into arrays that are there: all else costs more than the arithmetic.
        limits, torque, scratch, lead = self.limits, self._torque, self._scratch, self._lead
        np.add(position, lead, out=self._angle)
        np.multiply(self._angle, limits.kp, out=scratch)
        np.subtract(self._asked, scratch, out=torque)
        np.multiply(velocity, limits.kv, out=scratch)
        np.subtract(torque, scratch, out=torque)

        bound = self._bound
        np.multiply(self._slope, velocity, out=scratch)
        np.subtract(limits.stall_torque, scratch, out=bound)
        np.maximum(bound, self._nothing, out=bound)
        np.minimum(torque, bound, out=torque)
        np.subtract(self._stall_backward, scratch, out=bound)
        np.minimum(bound, self._nothing, out=bound)
        np.maximum(torque, bound, out=torque)
        np.minimum(torque, limits.peak_torque, out=torque)
        np.negative(limits.peak_torque, out=bound)
        np.maximum(torque, bound, out=torque)

        if self._half_play > 0.0:
            np.multiply(torque, self._lead_per_torque, out=scratch)
            np.maximum(scratch, self._least_lead, out=scratch)
            np.minimum(scratch, self._most_lead, out=scratch)
            np.subtract(scratch, lead, out=scratch)
            np.multiply(scratch, self._follow, out=scratch)
            np.add(lead, scratch, out=lead)
        return torque
