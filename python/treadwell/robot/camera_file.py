"""`[camera]` of `robot.toml`: where the depth camera is, what it sees, and how it errs."""

from typing import Annotated, Literal, Self

from pydantic import Field, FiniteFloat, model_validator

from treadwell.robot.tables import (
    Angle,
    Depth,
    Disparity,
    Length,
    Name,
    Orientation,
    Pixels,
    PixelStep,
    Position,
    Share,
    Table,
)


class StereoTable(Table):
    """`[camera.stereo]`: a stereo camera, and how it errs."""

    baseline: Length
    """Distance between the lenses, m."""
    window: Annotated[int, Field(ge=1, le=31)]
    """Side of the matching window, pixels, odd."""
    disparity_noise_fixed: Pixels = 0.0
    """Standard deviation of the fixed pattern of disparities, pixels."""
    disparity_noise_temporal: Pixels = 0.0
    """Standard deviation of what changes from frame to frame, pixels."""
    quantum: PixelStep = 0.0
    """Step of a disparity, pixels."""
    min_disparity: Disparity
    """Smallest disparity that is matched, pixels: sets the farthest depth."""
    max_disparity: Disparity
    """Largest disparity that is matched, pixels: sets the nearest depth."""
    mismatch_rate: Share = 0.0
    """Share of pixels that are grossly wrong."""
    dropout_rate: Share = 0.0
    """Share of pixels without a value."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.window % 2 == 0:
            raise ValueError("window must be odd")
        if self.max_disparity <= self.min_disparity:
            raise ValueError("max_disparity must be above min_disparity")
        return self


class StructuredLightTable(Table):
    """`[camera.structured_light]`: a structured-light camera, and how it errs."""

    baseline: Length
    """Distance between projector and lens, m."""
    window: Annotated[int, Field(ge=1, le=31)]
    """Side of the matching window, pixels."""
    disparity_noise: Pixels
    """Standard deviation of a disparity, pixels."""
    quantum: PixelStep = 0.0
    """Step of a disparity, pixels."""
    nearest: Depth
    """Nearest depth that is seen, m."""
    farthest: Depth
    """Farthest depth that is seen, m."""
    lateral_noise: Pixels = 0.0
    """Standard deviation of where a border is seen, pixels."""
    edge_dropout: Share = 0.0
    """Share of pixels at edges of depth without a value."""
    steepest: Annotated[FiniteFloat, Field(ge=0.01, le=1.5708)]
    """Surfaces that are seen more aslant than this have no value, rad."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.farthest <= self.nearest:
            raise ValueError("farthest must be above nearest")
        if self.disparity_noise < self.quantum / 12.0**0.5:
            raise ValueError("disparity_noise must hold that of rounding, quantum / sqrt(12)")
        return self


class MountTable(Table):
    """`[camera.mount]`: where a camera goes that the MJCF lacks. It looks along the mount's x."""

    link: Name
    """The link that carries it."""
    position: Position
    """The lens in the link's frame, m."""
    orientation: Orientation = (1.0, 0.0, 0.0, 0.0)
    """The mount's axes (ahead, left, up) in the link's frame, quaternion w, x, y, z; default: the
    link's axes.
    """
    down: Angle = 0.0
    """How far it is tipped down, rad."""
    pan_tilt: bool = False
    """Whether it sits on a small unit of its own (0.1 kg) that turns it, by the joints `camera_pan`
    and `camera_tilt`: for a robot without a head that does both.
    """


class CameraTable(Table):
    """`[camera]`: the depth camera."""

    name: Name
    """The camera of the MJCF; with `mount` it is added."""
    sensor: Literal["stereo", "structured_light"]
    """Which table says how it errs."""
    width: Annotated[int, Field(ge=8, le=640)]
    """Width of the image, pixels."""
    height: Annotated[int, Field(ge=8, le=480)]
    """Height of the image, pixels."""
    horizontal_fov: Annotated[FiniteFloat, Field(ge=0.01, lt=3.0)]
    """Horizontal field of view, rad."""
    vertical_fov: Annotated[FiniteFloat, Field(ge=0.01, lt=3.0)]
    """Vertical field of view, rad."""
    period: Annotated[FiniteFloat, Field(ge=0.01, le=10.0)]
    """Time between exposures, s: a multiple of the control tick of 0.01 s."""
    pool: Annotated[int, Field(ge=1, le=8)] = 1
    """Pixels a side that the core takes for one."""
    mount: MountTable | None = None
    """Where it is added."""
    stereo: StereoTable | None = None
    """How a stereo camera errs."""
    structured_light: StructuredLightTable | None = None
    """How a structured-light camera errs."""

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
