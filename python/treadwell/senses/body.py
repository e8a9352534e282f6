"""The senses of the robot's own body, encoders, inertial unit, foot forces: found in a model."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell._core import BodySenses
from treadwell.robot.followers import Tie

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class EncoderSenses:
    """The joints' encoders.

    Attributes:
        joints: names of hinges, in the robot's order.
        quantum: rad, step of the readings; 0 for exact readings and velocities.
        offsets: (n,) rad, what each encoder reads too much.
        ties: joints without an encoder, each with how it follows one whose encoder speaks for both.
    """

    joints: Sequence[str]
    quantum: float
    offsets: Floats
    ties: Mapping[int, Tie] = field(default_factory=dict)


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


@dataclass(frozen=True, slots=True)
class FootSenses:
    """The force sensors under the soles.

    Attributes:
        soles: left and right.
        noise: sigma of each sample as a share of the force; both 0 for ideal sensors.
        noise_absolute: N, sigma of what is added to each sample besides.
    """

    soles: tuple[SensedSole, SensedSole]
    noise: float = 0.0
    noise_absolute: float = 0.0


@dataclass(frozen=True, slots=True)
class Generators:
    """The random numbers of each sense; constant errors are drawn from them first."""

    encoders: np.random.Generator
    imu: np.random.Generator
    feet: np.random.Generator


def body_senses(
    model: mujoco.MjModel,
    encoders: EncoderSenses,
    site: str,
    imu: ImuNoise,
    feet: FootSenses,
    numbers: Generators,
) -> BodySenses:
    """Find the senses in the compiled world with the robot.

    Args:
        model: the world.
        encoders: of the joints.
        site: where the inertial unit sits; its axes are the site's.
        imu: the unit's errors; all zero for an ideal one.
        feet: the force sensors.
        numbers: the errors of each.
    """
    settings = {
        "encoders": _encoders(model, encoders, numbers.encoders),
        "inertial": _inertial(model, site, imu, numbers.imu),
        "feet": {
            "soles": [_sole(model, sole) for sole in feet.soles],
            "noise": feet.noise,
            "noise_absolute_n": feet.noise_absolute,
            "seed": _seed(numbers.feet),
        },
    }
    return BodySenses(json.dumps(settings), np.array(encoders.offsets, np.float64))


def _seed(numbers: np.random.Generator) -> int:
    return int(numbers.integers(1 << 64, dtype=np.uint64))


def _encoders(
    model: mujoco.MjModel, encoders: EncoderSenses, numbers: np.random.Generator
) -> dict[str, Any]:
    joints = [model.joint(joint) for joint in encoders.joints]
    return {
        "positions": [int(joint.qposadr[0]) for joint in joints],
        "velocities": [int(joint.dofadr[0]) for joint in joints],
        "quantum_rad": encoders.quantum,
        "followers": [
            {"joint": joint, "by": tie.leader, "ratio": tie.ratio, "offset_rad": tie.offset}
            for joint, tie in encoders.ties.items()
        ],
        "seed": _seed(numbers),
    }


def _inertial(
    model: mujoco.MjModel, site: str, noise: ImuNoise, numbers: np.random.Generator
) -> dict[str, Any]:
    number = int(model.site(site).id)
    link = int(model.site_bodyid[number])
    bias = numbers.standard_normal(6)
    bias *= np.repeat([noise.gyro_bias, noise.accelerometer_bias], 3)
    return {
        "site": number,
        "link": link,
        "root": int(model.body_rootid[link]),
        "at_rest_mps2": (-model.opt.gravity).tolist(),
        "bias": bias.tolist(),
        "noise": 3 * [noise.gyro_noise] + 3 * [noise.accelerometer_noise],
        "seed": _seed(numbers),
    }


def _sole(model: mujoco.MjModel, sole: SensedSole) -> dict[str, Any]:
    return {
        "forces": int(model.sensor(sole.sensor).adr[0]),
        "link": int(model.body(sole.link).id),
        "centre_m": sole.center,
        "size_m": sole.size,
    }
