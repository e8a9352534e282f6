"""The parsed `robot.toml` of a robot's folder: what the MJCF cannot say of the robot."""

import json
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    StringConstraints,
    field_validator,
    model_validator,
)

Name = Annotated[str, StringConstraints(min_length=1, max_length=100)]
Positive = Annotated[FiniteFloat, Field(gt=0.0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0.0)]
Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]
Position = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class Table(BaseModel):
    """A table of the file: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class RobotTable(Table):
    """`[robot]`: who it is and the name of its MJCF file, which lies in the same folder."""

    name: Name
    description: str = ""
    model: Annotated[str, StringConstraints(pattern=r"^[\w.-]+\.xml$")]


class BodyTable(Table):
    """`[body]`: the link that is the torso; radius and height (m) of the cylinder around it all.

    `depth` (front to back) and `width`: of the upright box that holds it while it walks sideways,
    m; the cylinder's where they are not given.
    """

    torso: Name
    radius: Positive
    height: Positive
    depth: Positive | None = None
    width: Positive | None = None


class SoleTable(Table):
    """`[legs.*.sole]`: a rectangle; its centre in the link's frame, on the ground, metres."""

    link: Name
    position: Position
    length: Positive
    width: Positive


class SensorsTable(Table):
    """`[legs.*.sensors]`: the rectangle with a force sensor at each corner; as for a sole."""

    position: Position
    length: Positive
    width: Positive


class LegTable(Table):
    """`[legs.*]`: joints from the hip down (yaw, roll, pitch, knee, ankle pitch, ankle roll).

    `forces` names the contact sensor of the sole: its net force, and where that acts; it is added
    where the MJCF has none. Without `sensors`, there is one under each corner of the sole.
    """

    joints: tuple[Name, Name, Name, Name, Name, Name]
    forces: Name
    sole: SoleTable
    sensors: SensorsTable | None = None


class LegsTable(Table):
    """`[legs]`: both. A `forces` that is not named is `left_sole_forces`, `right_sole_forces`."""

    left: LegTable
    right: LegTable

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
    """`[trunk]`: the joints between pelvis and torso, from below; there may be none."""

    joints: tuple[Name, ...] = ()


class HeadTable(Table):
    """`[head]`: the joints that turn and nod the camera."""

    pan: Name
    tilt: Name


class ArmsTable(Table):
    """`[arms]`: angles (rad) of joints of the arms, at rest and when they are raised in joy."""

    rest: dict[Name, FiniteFloat] = {}
    raised: dict[Name, FiniteFloat] = {}


class ImuTable(Table):
    """`[imu]`: the site, its sensors, standard deviations per axis: rad/s and m/s².

    With `link` and `position` (m) the site is added; sensors are where the MJCF has none.
    """

    site: Name = "imu"
    link: Name | None = None
    position: Position = (0.0, 0.0, 0.0)
    gyro: Name = "gyro"
    accelerometer: Name = "accelerometer"
    gyro_noise: NotNegative = 0.0
    gyro_bias: NotNegative = 0.0
    accelerometer_noise: NotNegative = 0.0
    accelerometer_bias: NotNegative = 0.0


class EncodersTable(Table):
    """`[encoders]`: quantum and whole play (rad); bounds of constant errors (rad, m)."""

    quantum: NotNegative = 0.0
    play: NotNegative = 0.0
    leg_offset: NotNegative = 0.0
    camera_roll_pitch_error: NotNegative = 0.0
    camera_yaw_error: NotNegative = 0.0
    camera_position_error: NotNegative = 0.0


class FeetTable(Table):
    """`[feet]`: standard deviation of a force sensor: share of the value, and newtons."""

    force_noise: NotNegative = 0.0
    force_noise_absolute: NotNegative = 0.0


class StereoTable(Table):
    """`[camera.stereo]`: baseline (m), matching window, noise and limits of disparity (pixels)."""

    baseline: Positive
    window: Annotated[int, Field(ge=1, le=31)]
    disparity_noise_fixed: NotNegative = 0.0
    disparity_noise_temporal: NotNegative = 0.0
    quantum: NotNegative = 0.0
    min_disparity: Positive
    max_disparity: Positive
    mismatch_rate: Share = 0.0
    dropout_rate: Share = 0.0

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.window % 2 == 0:
            raise ValueError("window must be odd")
        if self.max_disparity <= self.min_disparity:
            raise ValueError("max_disparity must be above min_disparity")
        return self


class StructuredLightTable(Table):
    """`[camera.structured_light]`: baseline, nearest, farthest (m), noise (px), shares, rad."""

    baseline: Positive
    window: Annotated[int, Field(ge=1, le=31)]
    disparity_noise: NotNegative
    quantum: NotNegative = 0.0
    nearest: Positive
    farthest: Positive
    lateral_noise: NotNegative = 0.0
    edge_dropout: Share = 0.0
    steepest: Annotated[FiniteFloat, Field(gt=0.0, le=1.5708)]

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.farthest <= self.nearest:
            raise ValueError("farthest must be above nearest")
        if self.disparity_noise < self.quantum / 12.0**0.5:
            raise ValueError("disparity_noise must hold that of rounding, quantum / sqrt(12)")
        return self


class MountTable(Table):
    """`[camera.mount]`: the link that carries a camera which the MJCF does not have.

    `position` of the lens in the link's frame, m; it looks along the link's x, tipped `down`, rad.
    """

    link: Name
    position: Position
    down: FiniteFloat = 0.0


class CameraTable(Table):
    """`[camera]`: a camera of the MJCF; image size (pixels), fields of view (rad), period (s).

    With `mount` it is added to the MJCF.

    `sensor` names the table that says how it errs. The core takes `pool` pixels a side for one.
    """

    name: Name
    sensor: Literal["stereo", "structured_light"]
    width: Annotated[int, Field(ge=8, le=640)]
    height: Annotated[int, Field(ge=8, le=480)]
    horizontal_fov: Annotated[FiniteFloat, Field(gt=0.0, lt=3.0)]
    vertical_fov: Annotated[FiniteFloat, Field(gt=0.0, lt=3.0)]
    period: Positive
    pool: Annotated[int, Field(ge=1, le=8)] = 1
    mount: MountTable | None = None
    stereo: StereoTable | None = None
    structured_light: StructuredLightTable | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        ticks = self.period / 0.01
        if ticks < 1.0 - 1e-9 or abs(ticks - round(ticks)) > 1e-6:
            raise ValueError("period must be a multiple of the control tick, 0.01 s")
        if self.width % self.pool or self.height % self.pool:
            raise ValueError(f"pool must divide width and height, got {self.pool}")
        tables = {"stereo": self.stereo, "structured_light": self.structured_light}
        if [name for name, table in tables.items() if table is not None] != [self.sensor]:
            raise ValueError(f"sensor {self.sensor!r} needs its own table, and no other sensor's")
        return self

    @property
    def triangulation(self) -> StereoTable | StructuredLightTable:
        """The sensor's table: both kinds have a baseline and a window."""
        table = self.stereo or self.structured_light
        assert table is not None
        return table


class MotorsTable(Table):
    """`[motors.*]`: torques (N·m), speed (rad/s) and servo gains that some joints share.

    `stall_torque` is where the torque-speed line starts; without it, at `peak_torque`. The joints'
    own `damping` (N·m·s/rad), dry `friction` (N·m) and `armature` (kg·m²) are the MJCF's where they
    are not given.
    """

    joints: Annotated[tuple[Name, ...], Field(min_length=1)]
    peak_torque: Positive
    stall_torque: Positive | None = None
    no_load_speed: Positive
    kp: Positive
    kv: NotNegative
    damping: NotNegative | None = None
    friction: NotNegative | None = None
    armature: NotNegative | None = None

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.stall_torque is not None and self.stall_torque < self.peak_torque:
            raise ValueError("stall_torque must not be below peak_torque")
        return self


class RobotFile(Table):
    """The whole file. `gait` goes to the walker as it is; a scenario goes over `navigation`.

    `stand` (joint to angle, rad; 0 for the others) stands for a keyframe, `ranges` (joint to its
    least and largest angle, rad) for those that the MJCF does not have.
    """

    robot: RobotTable
    stand: dict[Name, FiniteFloat] = {}
    ranges: dict[Name, tuple[FiniteFloat, FiniteFloat]] = {}
    body: BodyTable
    legs: LegsTable
    trunk: TrunkTable = TrunkTable()
    head: HeadTable
    arms: ArmsTable = ArmsTable()
    imu: ImuTable = ImuTable()
    encoders: EncodersTable = EncodersTable()
    feet: FeetTable = FeetTable()
    camera: CameraTable
    motors: dict[Name, MotorsTable]
    gait: dict[str, Any] = {}
    navigation: dict[Name, dict[str, Any]] = {}

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
