"""The servos: the one place where joint targets become torques, within what a motor could do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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


@dataclass(frozen=True, slots=True, eq=False)
class MotorLimits:
    """What the motors are; arrays by the robot's joint order.

    Attributes:
        kp: (n,) N·m/rad, stiffness of the servo.
        kv: (n,) N·m·s/rad, damping of the servo.
        peak_torque: (n,) N·m, never exceeded.
        stall_torque: (n,) N·m, where the torque-speed line starts; at or above the peak.
        no_load_speed: (n,) rad/s, where the line ends.
    """

    kp: Floats
    kv: Floats
    peak_torque: Floats
    stall_torque: Floats
    no_load_speed: Floats


class Motors:
    """A proportional-derivative servo with feed-forward on each joint, and the play in its gear.

    The torque is `kp (position* - angle) + kv (velocity* - velocity) + torque*`, held within the
    peak torque and, where a motor drives, within the line from the stall torque at rest to nothing
    at the no-load speed. Braking is limited by the peak alone.

    The angle is the motor's, before the gear's play; the encoder sits there too. It leads the joint
    by half of the play in the direction of the torque; the lead follows a change of sign with a
    time constant of `PLAY_TIME` and grows with the torque up to `PLAY_TORQUE` of the peak, or more
    for a stiff servo, so that the loop through it has a gain below one and is stable.
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
        self._half_play = 0.5 * play
        self._follow = -np.expm1(-timestep / PLAY_TIME)
        takes_up = np.maximum(PLAY_TORQUE * limits.peak_torque, limits.kp * self._half_play)
        self._per_torque = 1.0 / takes_up
        self._slope = limits.stall_torque / limits.no_load_speed
        self._lead = np.zeros(n)
        self._angle = np.zeros(n)
        self._torque = np.zeros(n)
        self._a = np.empty(n)
        self._b = np.empty(n)

    @property
    def angle(self) -> Floats:
        """(n,) rad: the motors' angles at the last `update`; what an encoder sees."""
        return self._angle

    @property
    def torque(self) -> Floats:
        """(n,) N·m: the torques of the last `update`."""
        return self._torque

    def measured_angle(self, position: Floats) -> Floats:
        """Return the motors' angles (n,) rad at these joint angles (n,) rad."""
        return position + self._lead

    def update(self, targets: JointTargets, position: Floats, velocity: Floats) -> Floats:
        """Return the torques for the coming physics step.

        Args:
            targets: what is asked for.
            position: (n,) rad, true joint angles.
            velocity: (n,) rad/s, true joint velocities.

        Returns:
            (n,) N·m; the array is used again at the next call.
        """
        limits, torque, a, b = self.limits, self._torque, self._a, self._b
        np.add(position, self._lead, out=self._angle)
        np.subtract(targets.position, self._angle, out=torque)
        np.multiply(torque, limits.kp, out=torque)
        np.subtract(targets.velocity, velocity, out=a)
        np.multiply(a, limits.kv, out=a)
        np.add(torque, a, out=torque)
        np.add(torque, targets.torque, out=torque)

        np.multiply(velocity, self._slope, out=a)
        np.subtract(limits.stall_torque, a, out=b)
        np.clip(b, 0.0, limits.peak_torque, out=b)
        np.minimum(torque, b, out=torque)
        np.add(limits.stall_torque, a, out=b)
        np.clip(b, 0.0, limits.peak_torque, out=b)
        np.negative(b, out=b)
        np.maximum(torque, b, out=torque)

        if self._half_play > 0.0:
            np.multiply(torque, self._per_torque, out=a)
            np.clip(a, -1.0, 1.0, out=a)
            np.multiply(a, self._half_play, out=a)
            np.subtract(a, self._lead, out=a)
            np.multiply(a, self._follow, out=a)
            np.add(self._lead, a, out=self._lead)
        return torque
