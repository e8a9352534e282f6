"""The parsed `robot.toml` of a robot's folder: what the MJCF cannot say of the robot."""

import json
from typing import Annotated, Any, Self

from pydantic import Field, StringConstraints, field_validator, model_validator

from treadwell.robot.camera_file import CameraTable
from treadwell.robot.tables import (
    AccelerationError,
    Angle,
    AngleError,
    AngleStep,
    Coordinate,
    Damping,
    ForceError,
    Friction,
    Inertia,
    Length,
    LengthError,
    Name,
    Orientation,
    Position,
    RateError,
    Scale,
    Share,
    Speed,
    Stiffness,
    Table,
    Torque,
)


class RobotTable(Table):
    """`[robot]`: who it is."""

    name: Name
    """The robot's name: its folder's."""
    description: str = ""
    """One line for `treadwell list robots`."""
    model: Annotated[str, StringConstraints(pattern=r"^[\w.-]+\.(xml|urdf)$")]
    """The MJCF or URDF file in the same folder."""
    scale: Scale | None = None
    """How large it is against `qrio`, of which the defaults of all settings are: lengths of theirs
    are multiplied by it; default: the length of its legs over that of `qrio`'s.
    """


class BodyTable(Table):
    """`[body]`: the size of the whole robot."""

    torso: Name
    """The link that counts as the trunk."""
    radius: Length
    """Radius of the upright cylinder that holds the robot while it walks, m."""
    height: Length
    """Height of the top of the head while it stands, m."""
    depth: Length | None = None
    """Front to back, the upright box that holds it while it walks sideways, m; default: the
    cylinder's diameter.
    """
    width: Length | None = None
    """Across, the same box, m; default: the cylinder's diameter."""
    foot_side: Length | None = None
    """How far to each side of the middle the ground matters to the feet, m: a little less than the
    outer edges of the soles; default: three quarters of where those are in the stance.
    """


class SoleTable(Table):
    """`[legs.*.sole]`: the rectangle that a foot stands on."""

    link: Name
    """The link that carries it."""
    position: Position
    """Its centre in the link's frame, on the ground, m."""
    orientation: Orientation | None = None
    """Where the link's axes are not ahead, left and up while the sole is level: those axes in the
    link's frame, quaternion w, x, y, z. The link is turned by it, and `position` is in those axes.
    """
    length: Length
    """Extent forward, m."""
    width: Length
    """Extent across, m."""
    plate: Length | None = None
    """Thickness of a plate of this size that the link is given, m: for a foot whose shapes touch
    the ground in points, and would not stand on an edge; default: none.
    """


class SensorsTable(Table):
    """`[legs.*.sensors]`: the rectangle with a force sensor at each corner."""

    position: Position
    """Its centre in the link's frame, m."""
    length: Length
    """Extent forward, m."""
    width: Length
    """Extent across, m."""


class LegTable(Table):
    """`[legs.*]`: a leg."""

    joints: Annotated[tuple[Name, ...], Field(min_length=5, max_length=7)]
    """The joints from the hip down, five to seven, in whatever order the model has them."""
    forces: Name
    """The contact sensor of the sole: its net force, and where that acts; added where the MJCF has
    none.
    """
    sole: SoleTable
    """The rectangle that it stands on."""
    sensors: SensorsTable | None = None
    """Where the force sensors are; default: one under each corner of the sole."""


class LegsTable(Table):
    """`[legs]`: both. A `forces` that is not named is `left_sole_forces`, `right_sole_forces`."""

    left: LegTable
    """The left leg."""
    right: LegTable
    """The right leg."""

    @model_validator(mode="before")
    @classmethod
    def _name_forces(cls, table: object) -> object:
        if not isinstance(table, dict):
            return table
        return {
            side: {"forces": f"{side}_sole_forces", **leg} if isinstance(leg, dict) else leg
            for side, leg in table.items()
        }


class TrunkTable(Table):
    """`[trunk]`: what is between pelvis and torso."""

    joints: tuple[Name, ...] = ()
    """The joints from below; there may be none."""


class HeadTable(Table):
    """`[head]`: the joints that turn the camera, and where the eyes are."""

    pan: Name | None = None
    """The joint that turns it left and right, where there is one."""
    tilt: Name | None = None
    """The joint that nods, where there is one."""
    eye_height: Length | None = None
    """Height of the eyes above the ground while the robot stands, as far as turning the head to a
    place needs it, m; default: the camera's in the stance.
    """
    eye_ahead: Coordinate | None = None
    """How far the eyes are ahead of the robot's middle, as far as turning the head to a place needs
    it, m; default: the camera's in the stance.
    """


class ArmsTable(Table):
    """`[arms]`: where the arms are held."""

    rest: dict[Name, Angle] = Field(default_factory=dict)
    """Angles of joints of the arms at rest, rad."""
    raised: dict[Name, Angle] = Field(default_factory=dict)
    """Angles when they are raised in joy, rad."""


class ImuTable(Table):
    """`[imu]`: the inertial measurement unit, and how it errs."""

    site: Name = "imu"
    """The site of the MJCF where it sits; with `link` it is added."""
    link: Name | None = None
    """The link on which the site is added."""
    position: Position = (0.0, 0.0, 0.0)
    """The added site's place in the link's frame, m."""
    gyro: Name = "gyro"
    """The gyro of the MJCF; added where it has none."""
    accelerometer: Name = "accelerometer"
    """The accelerometer of the MJCF; added where it has none."""
    gyro_noise: RateError = 0.0
    """Standard deviation of an axis of the gyro at a tick, rad/s."""
    gyro_bias: RateError = 0.0
    """Standard deviation of an axis' constant error, rad/s."""
    accelerometer_noise: AccelerationError = 0.0
    """Standard deviation of an axis of the accelerometer at a tick, m/s²."""
    accelerometer_bias: AccelerationError = 0.0
    """Standard deviation of an axis' constant error, m/s²."""


class EncodersTable(Table):
    """`[encoders]`: how joint angles and the camera mount err."""

    quantum: AngleStep = 0.0
    """Step of an encoder, rad."""
    play: AngleError = 0.0
    """Whole lost motion of a gear, rad; encoders sit on the motors' side of it."""
    leg_offset: AngleError = 0.0
    """Bound of the constant error of the encoder of a leg, and of a trunk's joint that turns the
    camera as no joint of the neck does, rad.
    """
    camera_roll_pitch_error: AngleError = 0.0
    """Bound of the camera's constant error in roll and pitch, rad."""
    camera_yaw_error: AngleError = 0.0
    """Bound of its constant error in yaw, rad."""
    camera_position_error: LengthError = 0.0
    """Bound of the constant error of its place, m."""


class FeetTable(Table):
    """`[feet]`: how the force sensors err."""

    force_noise: Share = 0.0
    """Standard deviation as a share of the force."""
    force_noise_absolute: ForceError = 0.0
    """Standard deviation beside that, N."""


class MotorsTable(Table):
    """`[motors.*]`: a kind of motor, and the joints that have one."""

    joints: Annotated[tuple[Name, ...], Field(min_length=1)]
    """The joints with such a motor."""
    peak_torque: Torque
    """Largest torque, N·m."""
    stall_torque: Torque | None = None
    """Torque at which the torque-speed line starts, N·m; default: `peak_torque`."""
    no_load_speed: Speed
    """Speed at which no torque is left, rad/s."""
    kp: Stiffness
    """Stiffness of the servo, N·m/rad."""
    kv: Damping
    """Damping of the servo, N·m·s/rad."""
    damping: Damping | None = None
    """The joints' own damping, N·m·s/rad; default: the MJCF's."""
    friction: Friction | None = None
    """The joints' dry friction, N·m; default: the MJCF's."""
    armature: Inertia | None = None
    """The motor's inertia at the joint, kg·m²; default: the MJCF's."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.stall_torque is not None and self.stall_torque < self.peak_torque:
            raise ValueError("stall_torque must not be below peak_torque")
        return self


class RobotFile(Table):
    """The whole file `robot.toml`: what the MJCF cannot say of the robot."""

    robot: RobotTable
    """Who it is."""
    stand: dict[Name, Angle] = Field(default_factory=dict)
    """Angles of the upright stance, rad; joints that are not named are as in the MJCF's keyframe
    `stand`, or else at 0 or the end of their range that is nearest to it.
    """
    ranges: dict[Name, tuple[Angle, Angle]] = Field(default_factory=dict)
    """Least and largest angle of joints whose range the MJCF does not have, rad."""
    body: BodyTable
    """The size of the whole robot."""
    legs: LegsTable
    """Both legs."""
    trunk: TrunkTable = TrunkTable()
    """What is between pelvis and torso."""
    head: HeadTable = HeadTable()
    """The joints that turn the camera."""
    arms: ArmsTable = ArmsTable()
    """Where the arms are held."""
    imu: ImuTable = ImuTable()
    """The inertial measurement unit."""
    encoders: EncodersTable = EncodersTable()
    """How joint angles err."""
    feet: FeetTable = FeetTable()
    """How the force sensors err."""
    camera: CameraTable
    """The depth camera."""
    motors: dict[Name, MotorsTable]
    """Kinds of motors, by a name of the file's own."""
    gait: dict[str, Any] = Field(default_factory=dict)
    """The walker's parameters: `treadwell list parameters gait`."""
    navigation: dict[Name, dict[str, Any]] = Field(default_factory=dict)
    """Parameters of components with this robot; a scenario's go over them."""

    @field_validator("ranges")
    @classmethod
    def _check_ranges(
        cls, ranges: dict[str, tuple[float, float]]
    ) -> dict[str, tuple[float, float]]:
        for joint, (low, high) in ranges.items():
            if low >= high:
                raise ValueError(f"{joint}: its least angle must be below its largest")
        return ranges

    @field_validator("gait", "navigation")
    @classmethod
    def _check_core(cls, table: dict[str, Any]) -> dict[str, Any]:
        try:
            json.dumps(table, allow_nan=False)
        except (TypeError, ValueError) as error:
            raise ValueError("must hold finite numbers, strings, booleans and lists") from error
        return table
