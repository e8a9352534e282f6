"""The senses of the harness: from the simulator's state to the Observation that the core gets."""

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell import _core
from treadwell._core import Servos
from treadwell.observation import Observation
from treadwell.robot.description import focal_length
from treadwell.robot.file import RobotFile
from treadwell.robot.followers import Tie
from treadwell.senses.body import (
    EncoderSenses,
    FootSenses,
    Generators,
    ImuNoise,
    SensedSole,
    body_senses,
)
from treadwell.senses.camera_error import (
    CameraError,
    CameraErrorBounds,
    draw_camera_error,
    rotation_of,
    turning_as,
)
from treadwell.senses.depth import DepthCamera, Mount, Pinhole
from treadwell.senses.depth_sensor import DepthSensor, brightness
from treadwell.senses.faults import SenseFault, SenseFaults
from treadwell.senses.stereo import StereoConfig, StereoModel
from treadwell.senses.structured_light import StructuredLightConfig, StructuredLightModel

Floats = NDArray[np.float64]
Streams = Callable[[str], np.random.Generator]

# A trunk joint takes this much of the camera's error against a neck joint with the same axis.
TRUNK_WEIGHT = 0.25


class SensorSettings(Protocol):
    """`[sensors]` of a scenario: each sense is "noisy" or "ideal"; latency in seconds."""

    @property
    def depth(self) -> str:
        """The depth camera."""

    @property
    def encoders(self) -> str:
        """The joints' encoders, neck and trunk included."""

    @property
    def imu(self) -> str:
        """Gyro and accelerometer."""

    @property
    def feet(self) -> str:
        """The force sensors."""

    @property
    def latency(self) -> float:
        """Seconds from a depth image's exposure to its arrival."""

    @property
    def camera_roll_pitch_error(self) -> float | None:
        """Bound of the camera's error in roll and pitch, rad; None: the robot's own."""

    @property
    def camera_position_error(self) -> float | None:
        """Bound of the error of the camera's place, m; None: the robot's own."""

    @property
    def mismatch_rate(self) -> float | None:
        """Share of pixels that stereo gets grossly wrong; None: the robot's own."""

    @property
    def intensity(self) -> bool:
        """Whether frames have an image of brightness."""


class SensedRobot(Protocol):
    """What the senses need to know of a robot."""

    @property
    def file(self) -> RobotFile:
        """Its `robot.toml`."""

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of its joints, in joint order."""

    @property
    def ties(self) -> Mapping[int, Tie]:
        """How each joint without a motor follows the one that turns it, in joint order."""

    @property
    def nominal(self) -> mujoco.MjModel:
        """Its model, alone in an empty world."""


class Sensors:
    """All senses of one robot in one episode.

    Constant errors (offsets, biases, the camera's mount) are drawn at construction. Every sense
    draws from a stream of its own, so that switching one to ideal leaves the others' numbers.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        robot: SensedRobot,
        settings: SensorSettings,
        streams: Streams,
        texture: Floats | None = None,
    ) -> None:
        """Build the senses.

        Args:
            model: the compiled world with the robot.
            robot: its file, joint order and model.
            settings: which senses are noisy, and the latency.
            streams: the episode's random numbers, by a component's name.
            texture: for each geom id, how well stereo sees it, 0 (blank) to 1; default: all 1.
        """
        file = robot.file
        error = _camera_error(robot.nominal, file, settings, streams("sensors.camera"))
        self._joint_order = {name: i for i, name in enumerate(robot.joints)}
        encoders = streams("sensors.encoders")
        self._body = body_senses(
            model,
            self._encoders(robot, settings, encoders, error),
            file.imu.site,
            _imu(file, settings),
            _feet(file, settings),
            Generators(encoders, streams("sensors.imu"), streams("sensors.feet")),
        )
        self._drawn_offsets = self._body.encoder_offsets.copy()
        self._depth = _depth(model, file, settings, streams, error.mount, texture)
        self._shifts: dict[str, float] = {}
        self._faults: SenseFaults | None = None
        self._streams = streams

    @property
    def encoder_offsets(self) -> Floats:
        """(n,) rad: what the encoders read too much; for `Servos.encoder_offsets`, as it is.

        Always the same array; what is in it changes when an encoder shifts.
        """
        return self._body.encoder_offsets

    @property
    def camera(self) -> DepthCamera:
        """The depth camera where it really sits; for scoring alone."""
        return self._depth.camera

    def observe(
        self, data: mujoco.MjData, time_ns: int, motors: Servos | None = None
    ) -> Observation:
        """Return what the senses say now; call it at every control tick.

        Args:
            data: the state; poses and velocities up to date, forces those of the last step.
                Nothing in it is changed.
            time_ns: now, nanoseconds since the start.
            motors: whose angles the encoders read; None: the joints' own.
        """
        seen = Observation(
            time_ns,
            *self._body.read(data, time_ns, motors),
            self._depth.observe(data, time_ns),
        )
        if self._faults is None:
            return seen
        told = self._faults.apply(seen)
        # A servo goes by its encoder, so a stuck one misleads it as well.
        for joint, error in self._faults.encoder_errors(seen).items():
            self._body.encoder_offsets[joint] += error
        return told

    def set_faults(self, active: Sequence[SenseFault]) -> None:
        """Let senses be broken from now on; those that are not named are whole."""
        if self._faults is None:
            self._faults = SenseFaults(self._joint_order, self._streams("events.fault"))
        self._shift_encoders()
        self._faults.set(list(active))

    def knock(self, roll: float, pitch: float, yaw: float) -> None:
        """Turn the camera against the head: about its line of sight, down, to the left, rad."""
        self._depth.camera.knock(rotation_of(roll, pitch, yaw))

    def blind(self, until_ns: int) -> None:
        """Let the camera expose nothing before this time."""
        self._depth.blind(until_ns)

    def set_encoder_shifts(self, shifts: Mapping[str, float]) -> None:
        """Let encoders read more than they did at the start; those not named as at the start.

        Args:
            shifts: rad, by the joint's name.
        """
        if self._shifts == shifts:
            return
        self._shifts = dict(shifts)
        self._shift_encoders()

    def _shift_encoders(self) -> None:
        offsets = self._body.encoder_offsets
        offsets[:] = self._drawn_offsets
        for joint, shift in self._shifts.items():
            offsets[self._joint_order[joint]] += shift

    def _encoders(
        self,
        robot: SensedRobot,
        settings: SensorSettings,
        numbers: np.random.Generator,
        error: CameraError,
    ) -> EncoderSenses:
        table = robot.file.encoders
        offsets = np.zeros(len(robot.joints))
        if settings.encoders == "ideal":
            return EncoderSenses(robot.joints, 0.0, offsets, robot.ties)
        for leg in (robot.file.legs.left, robot.file.legs.right):
            at = [self._joint_order[joint] for joint in leg.joints]
            offsets[at] = numbers.uniform(-table.leg_offset, table.leg_offset, len(at))
        trunk, neck = _camera_joints(robot.nominal, robot.file)
        for joint, offset in zip([*trunk, *neck], error.offsets, strict=True):
            offsets[self._joint_order[joint]] = offset
        for joint in robot.file.trunk.joints:
            if joint not in trunk:
                offset = numbers.uniform(-table.leg_offset, table.leg_offset)
                offsets[self._joint_order[joint]] = offset
        return EncoderSenses(robot.joints, table.quantum, offsets, robot.ties)


def _camera_joints(model: mujoco.MjModel, file: RobotFile) -> tuple[list[str], list[str]]:
    """Return the joints of trunk and neck whose encoders make the camera's pose wrong."""
    neck = [joint for joint in (file.head.pan, file.head.tilt) if joint is not None]
    return [*turning_as(model, file.camera.name, file.trunk.joints, neck)], neck


def _camera_error(
    model: mujoco.MjModel, file: RobotFile, settings: SensorSettings, rng: np.random.Generator
) -> CameraError:
    trunk, neck = _camera_joints(model, file)
    joints = [*trunk, *neck]
    weights = [TRUNK_WEIGHT] * len(trunk) + [1.0] * len(neck)
    table = file.encoders
    bounds = CameraErrorBounds(
        _either(settings.camera_roll_pitch_error, table.camera_roll_pitch_error),
        table.camera_yaw_error,
        _either(settings.camera_position_error, table.camera_position_error),
    )
    return draw_camera_error(model, file.camera.name, joints, weights, bounds, rng)


def _either(asked: float | None, own: float) -> float:
    """Return what the scenario asks for, or the robot's own where it does not say."""
    return own if asked is None else asked


def _imu(file: RobotFile, settings: SensorSettings) -> ImuNoise:
    if settings.imu == "ideal":
        return ImuNoise()
    return ImuNoise(
        file.imu.gyro_noise,
        file.imu.gyro_bias,
        file.imu.accelerometer_noise,
        file.imu.accelerometer_bias,
    )


def _feet(file: RobotFile, settings: SensorSettings) -> FootSenses:
    legs = (file.legs.left, file.legs.right)
    left, right = (
        SensedSole(leg.forces, leg.sole.link, at.position, (at.length, at.width))
        for leg in legs
        for at in [leg.sensors or leg.sole]
    )
    if settings.feet == "ideal":
        return FootSenses((left, right))
    return FootSenses((left, right), file.feet.force_noise, file.feet.force_noise_absolute)


def _depth(
    model: mujoco.MjModel,
    file: RobotFile,
    settings: SensorSettings,
    streams: Streams,
    mount: Mount,
    texture: Floats | None,
) -> DepthSensor:
    table = file.camera
    pinhole = Pinhole(table.width, table.height, focal_length(file))
    textures = np.ones(model.ngeom) if texture is None else texture
    if len(textures) != model.ngeom:
        raise ValueError(f"texture: {model.ngeom} geoms, got {len(textures)} values")
    errors = None
    if settings.depth == "ideal":
        mount = Mount()
    else:
        errors = _depth_errors(file, settings, streams, pinhole, textures)
    return DepthSensor(
        DepthCamera(model, table.name, pinhole, mount),
        errors,
        round(table.period * 1e9),
        round(settings.latency * 1e9),
        brightness(model) if settings.intensity else None,
    )


def _depth_errors(
    file: RobotFile,
    settings: SensorSettings,
    streams: Streams,
    pinhole: Pinhole,
    textures: Floats,
) -> _core.DepthErrors:
    camera, noise = file.camera, streams("sensors.depth.noise")
    if camera.structured_light is not None:
        light = StructuredLightConfig(**camera.structured_light.model_dump())
        return StructuredLightModel(light, pinhole, noise).errors
    assert camera.stereo is not None
    values = camera.stereo.model_dump()
    values["valid_textured"] = 1.0 - values.pop("dropout_rate")
    values["mismatch_rate"] = _either(settings.mismatch_rate, values["mismatch_rate"])
    pattern = streams("sensors.depth.pattern")
    return StereoModel(StereoConfig(**values), pinhole, textures, pattern, noise).errors
