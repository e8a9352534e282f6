"""The senses of the robot's own body: encoders, the inertial unit, the foot forces."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Two readings of an encoder this far apart (s) give a joint's velocity.
VELOCITY_SPAN = 0.02
# After a longer gap (s) the velocity before it says nothing about the acceleration.
LONGEST_TICK = 0.05
# Rad: a larger turn within a tick is a kidnap, not a motion.
LARGEST_TURN = 0.5


class MotorSide(Protocol):
    """The motors: the encoders sit on their side of the gears' play."""

    def measured_angle(self, position: Floats) -> Floats:
        """Return the motors' angles (n,) rad at these joint angles (n,) rad."""


class Encoders:
    """Joint positions with an offset each, in steps of a quantum; velocities with noise."""

    def __init__(
        self,
        model: mujoco.MjModel,
        joints: Sequence[str],
        quantum: float,
        offsets: Floats,
        rng: np.random.Generator,
        followers: Mapping[int, int] = MappingProxyType({}),
    ) -> None:
        """Find the joints.

        Args:
            model: the compiled world with the robot.
            joints: hinges, in the robot's order.
            quantum: rad, step of the readings; 0 for exact readings and velocities.
            offsets: (n,) rad, what each encoder reads too much.
            rng: the velocities' noise.
            followers: joints without an encoder, each with the one whose encoder speaks for both.
        """
        ids = [model.joint(joint).id for joint in joints]
        self._positions = model.jnt_qposadr[ids].copy()
        self._velocities = model.jnt_dofadr[ids].copy()
        self._quantum = quantum
        # Two readings differ by two independent rounding errors, each of sigma quantum / sqrt(12).
        self._velocity_noise = quantum / (np.sqrt(6.0) * VELOCITY_SPAN)
        self._rng = rng
        self.offsets = np.array(offsets, np.float64)
        self._followers, self._leaders = list(followers), list(followers.values())

    def read(self, data: mujoco.MjData, motors: MotorSide | None) -> tuple[Floats, Floats]:
        """Return the readings (n,) rad and the velocities (n,) rad/s.

        Args:
            data: the state.
            motors: whose angles are read; None: the joints' own, as if there were no play.
        """
        angles = data.qpos[self._positions]
        if motors is not None:
            angles = motors.measured_angle(angles)
        readings = angles + self.offsets
        velocities = data.qvel[self._velocities]
        if self._quantum > 0.0:
            readings /= self._quantum
            np.rint(readings, out=readings)
            readings *= self._quantum
            velocities += self._velocity_noise * self._rng.standard_normal(velocities.size)
        if self._followers:
            readings[self._followers] = readings[self._leaders]
            velocities[self._followers] = velocities[self._leaders]
        return readings, velocities


@dataclass(frozen=True)
class ImuNoise:
    """Errors of the inertial unit; the biases are sigmas from which each episode draws.

    Attributes:
        gyro_noise: rad/s, sigma of each sample.
        gyro_bias: rad/s, sigma.
        accelerometer_noise: m/s², sigma of each sample.
        accelerometer_bias: m/s², sigma.
    """

    gyro_noise: float = 0.0
    gyro_bias: float = 0.0
    accelerometer_noise: float = 0.0
    accelerometer_bias: float = 0.0


class Imu:
    """Gyro and accelerometer at a site of the model.

    Both integrate over the tick, as units with an anti-aliasing filter do: a sample is the mean
    angular velocity and the mean specific force since the one before, not the peak of an impact.
    Samples at an instant would beat with the servos, which jump at every tick, and the integral of
    the gyro would drift with every step.
    """

    def __init__(
        self, model: mujoco.MjModel, site: str, noise: ImuNoise, rng: np.random.Generator
    ) -> None:
        """Draw the biases.

        Args:
            model: the compiled world with the robot.
            site: where the unit sits; its axes are the site's.
            noise: its errors; all zero for an ideal one.
            rng: biases and noise.
        """
        self._model = model
        self._site = model.site(site).id
        self._at_rest = -model.opt.gravity
        self._noise = np.repeat([noise.gyro_noise, noise.accelerometer_noise], 3)
        self._bias = rng.standard_normal(6)
        self._bias *= np.repeat([noise.gyro_bias, noise.accelerometer_bias], 3)
        self._exact = not self._noise.any()
        self._rng = rng
        self._velocity = np.zeros(3)
        self._world_from_sensor = np.eye(3)
        self._time_ns: int | None = None
        self._motion = np.empty(6)

    def read(self, data: mujoco.MjData, time_ns: int) -> tuple[Floats, Floats]:
        """Return the angular velocity (3,) rad/s and the specific force (3,) m/s².

        Args:
            data: the state, with the velocities of its bodies up to date.
            time_ns: now.
        """
        site = mujoco.mjtObj.mjOBJ_SITE
        mujoco.mj_objectVelocity(self._model, data, site, self._site, self._motion, 0)
        world_from_sensor = data.site_xmat[self._site].reshape(3, 3)
        angular_velocity, acceleration = None, self._at_rest
        if self._time_ns is not None:
            passed = (time_ns - self._time_ns) * 1e-9
            if 0.0 < passed <= LONGEST_TICK:
                acceleration = acceleration + (self._motion[3:] - self._velocity) / passed
                turn = rotation_vector(self._world_from_sensor.T @ world_from_sensor)
                if max(map(abs, turn)) < LARGEST_TURN:
                    angular_velocity = [angle / passed for angle in turn]
        if angular_velocity is None:
            angular_velocity = (world_from_sensor.T @ self._motion[:3]).tolist()
        self._world_from_sensor[:] = world_from_sensor
        self._velocity[:] = self._motion[3:]
        self._time_ns = time_ns
        force = (world_from_sensor.T @ acceleration).tolist()
        sample = np.array([*angular_velocity, *force])
        sample += self._bias
        if not self._exact:
            sample += self._noise * self._rng.standard_normal(6)
        return sample[:3], sample[3:]


def rotation_vector(rotation: Floats) -> tuple[float, float, float]:
    """Return the axis times the angle (rad) of a rotation (3, 3) by less than half a turn."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation.tolist()
    x, y, z = (zy - yz) / 2, (xz - zx) / 2, (yx - xy) / 2
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return x, y, z
    stretch = math.atan2(sine, (xx + yy + zz - 1.0) / 2) / sine
    return x * stretch, y * stretch, z * stretch


@dataclass(frozen=True, slots=True)
class SensedSole:
    """A stiff sole on four force sensors, at the corners of a rectangle.

    Attributes:
        sensor: name of its contact sensor: net force and where it acts, in the world.
        link: the link that carries it.
        center: m, the rectangle's centre in the link's frame.
        size: m, its length and width.
    """

    sensor: str
    link: str
    center: tuple[float, float, float]
    size: tuple[float, float]


class _Plate:
    """A sole, found in the model. Plain numbers: for so few of them numpy takes longer."""

    def __init__(self, model: mujoco.MjModel, sole: SensedSole) -> None:
        """Find its link and its contact sensor."""
        first = int(model.sensor(sole.sensor).adr[0])
        self._at = slice(first, first + 6)
        self._link = int(model.body(sole.link).id)
        self._center = sole.center
        self._size = sole.size

    def carried(self, data: mujoco.MjData) -> tuple[float, float, float, float]:
        """Return what each sensor truly carries, N: front left and right, rear left and right."""
        fx, fy, fz, x, y, z = data.sensordata[self._at].tolist()
        xx, xy, xz, yx, yy, yz, zx, zy, zz = data.xmat[self._link].tolist()
        link_x, link_y, link_z = data.xpos[self._link].tolist()
        x, y, z = x - link_x, y - link_y, z - link_z
        # What pushes along the sole, as a riser at the toe does, no sensor under it feels.
        pressing = max(0.0, -(xz * fx + yz * fy + zz * fz))
        ahead = 0.5 + (xx * x + yx * y + zx * z - self._center[0]) / self._size[0]
        aside = 0.5 + (xy * x + yy * y + zy * z - self._center[1]) / self._size[1]
        front, left = min(max(ahead, 0.0), 1.0), min(max(aside, 0.0), 1.0)
        rear, right = 1.0 - front, 1.0 - left
        return (
            pressing * (front * left),
            pressing * (front * right),
            pressing * (rear * left),
            pressing * (rear * right),
        )


class FootForces:
    """The force sensors under the soles: they push, they never pull.

    They share a foot's force as a stiff plate does: by how near to each corner it acts.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        soles: Sequence[SensedSole],
        noise: float,
        noise_absolute: float,
        rng: np.random.Generator,
    ) -> None:
        """Find the contact sensors.

        Args:
            model: the compiled world with the robot.
            soles: left and right.
            noise: sigma of each sample as a share of the force; both 0 for ideal sensors.
            noise_absolute: N, sigma of what is added to each sample besides.
            rng: the noise.
        """
        self._plates = [_Plate(model, sole) for sole in soles]
        self._noise = noise
        self._noise_absolute = noise_absolute
        self._exact = noise == 0.0 and noise_absolute == 0.0
        self._rng = rng

    def read(self, data: mujoco.MjData) -> Floats:
        """Return the forces (2, 4) N: front left, front right, rear left, rear right."""
        forces = np.array([plate.carried(data) for plate in self._plates])
        if not self._exact:
            share, added = self._rng.standard_normal((2, *forces.shape))
            forces += self._noise * share * forces + self._noise_absolute * added
            np.maximum(forces, 0.0, out=forces)
        return forces
