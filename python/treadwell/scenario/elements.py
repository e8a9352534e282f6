"""The elements of a course as they stand in a scenario file: one model per kind."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.types import (
    MOST_STEPS,
    Angle,
    ElementName,
    FileName,
    Fraction,
    Height,
    Length,
    LengthOrList,
    Point2,
    Point3,
    Rise,
    RiseOrList,
    Size2,
    Size3,
    Table,
)


class ElementTable(Table):
    """What every element has."""

    name: ElementName | None = None
    mapped: bool = True
    """False leaves it out of the a-priori map."""
    texture: Fraction = 1.0
    """How well stereo sees it, 0 (blank) to 1."""


class Stairs(ElementTable):
    """A flight of steps. Position: middle of the first riser's foot; yaw: direction of ascent."""

    kind: Literal["stairs"]
    position: Point2 = (0.6, 0.0)
    yaw: Angle = 0.0
    steps: Annotated[int, Field(ge=1, le=MOST_STEPS)] = 4
    rise: RiseOrList = 0.03
    tread: LengthOrList = 0.12
    width: Length = 0.33
    landing: Length = 0.33
    """Depth of the topmost step: it takes the place of the last tread."""
    descent: bool = False
    turn: Annotated[float, Field(ge=-0.8, le=0.8)] = 0.0
    """Each step's front edge is turned about its middle by this against the one below."""

    @model_validator(mode="after")
    def _one_entry_per_step(self) -> Self:
        for key, value in (("rise", self.rise), ("tread", self.tread)):
            if isinstance(value, tuple) and len(value) != self.steps:
                raise PydanticCustomError(
                    "list_length",
                    "must have one entry for each of the {steps} steps, not {found}",
                    {"key": key, "steps": self.steps, "found": len(value)},
                )
        return self

    def rises(self) -> tuple[float, ...]:
        """Return the rise of each step, metres, lowest first."""
        return self.rise if isinstance(self.rise, tuple) else (self.rise,) * self.steps

    def treads(self) -> tuple[float, ...]:
        """Return the depth of each step, metres, lowest first; the landing is the last."""
        treads = self.tread if isinstance(self.tread, tuple) else (self.tread,) * self.steps
        return (*treads[:-1], self.landing)


class Sill(ElementTable):
    """A low bar to step over or onto. Position: middle of the near edge; yaw: walking direction."""

    kind: Literal["sill"]
    position: Point2 = (1.5, 0.0)
    yaw: Angle = 0.0
    rise: Rise = 0.038
    depth: Length = 0.09
    width: Length = 1.0


class Platform(ElementTable):
    """A block with a walkable top. Position: its centre."""

    kind: Literal["platform"]
    position: Point2 = (2.5, 0.0)
    yaw: Angle = 0.0
    size: Size3 = (0.6, 1.0, 0.03)


class Box(ElementTable):
    """An obstacle. Position: its centre; `base`: height of its underside above the ground."""

    kind: Literal["box"]
    position: Point2 = (1.0, 0.4)
    yaw: Angle = 0.0
    size: Size3 = (0.2, 0.1, 0.3)
    base: Height = 0.0


class Cylinder(ElementTable):
    """An upright round obstacle. Position: its axis."""

    kind: Literal["cylinder"]
    position: Point2 = (1.2, -0.4)
    radius: Length = 0.05
    height: Length = 0.4


class Wall(ElementTable):
    """An upright wall along a line."""

    kind: Literal["wall"]
    from_: Annotated[Point2, Field(alias="from")] = (0.0, 1.0)
    to: Point2 = (3.0, 1.0)
    height: Length = 0.6
    thickness: Length = 0.05

    @model_validator(mode="after")
    def _has_a_length(self) -> Self:
        if self.from_ == self.to:
            raise PydanticCustomError(
                "no_length", "must differ from the wall's other end", {"key": "to"}
            )
        return self


class Ramp(ElementTable):
    """An inclined walkable plane. Position: middle of the low edge; yaw: direction of ascent."""

    kind: Literal["ramp"]
    position: Point2 = (3.0, 0.0)
    yaw: Angle = 0.0
    length: Length = 0.8
    width: Length = 0.6
    rise: Rise = 0.06


class Rubble(ElementTable):
    """A rough patch that cannot be walked on. Position: its centre."""

    kind: Literal["rubble"]
    position: Point2 = (1.8, 0.5)
    yaw: Angle = 0.0
    size: Size2 = (0.3, 0.3)
    amplitude: Rise = 0.03
    """Height of the highest peak."""


class Mesh(ElementTable):
    """A body of any shape from an .stl or .obj file in the scenario file's folder."""

    kind: Literal["mesh"]
    file: FileName
    position: Point3 = (0.0, 0.0, 0.0)
    yaw: Angle = 0.0


class Scatter(ElementTable):
    """Random boxes and cylinders, 0.08 m or higher, that leave a way from start to goal."""

    kind: Literal["scatter"]
    area: Annotated[tuple[Point2, Point2], Field(strict=False)] = ((0.5, -0.8), (2.5, 0.8))
    """Two opposite corners of the area in which their centres lie."""
    count: Annotated[int, Field(ge=1, le=200)] = 6
    size: Size2 = (0.05, 0.25)
    """Smallest and largest edge."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        (x0, y0), (x1, y1) = self.area
        if x0 >= x1 or y0 >= y1:
            raise PydanticCustomError(
                "order", "must be the lower and then the upper corner", {"key": "area"}
            )
        if self.size[0] > self.size[1]:
            raise PydanticCustomError(
                "order", "must be the smallest and then the largest edge", {"key": "size"}
            )
        return self


class Mjcf(ElementTable):
    """An MJCF world in the scenario file's folder, added as it is."""

    kind: Literal["mjcf"]
    file: FileName


Element = Annotated[
    Stairs | Sill | Platform | Box | Cylinder | Wall | Ramp | Rubble | Mesh | Scatter | Mjcf,
    Field(discriminator="kind"),
]
"""Any element of `[[course]]`."""

MovableElement = Annotated[
    Stairs | Sill | Platform | Box | Cylinder | Wall | Ramp | Rubble | Mesh,
    Field(discriminator="kind"),
]
"""What an event can add: one body whose place is known beforehand."""

ELEMENTS: dict[str, type[ElementTable]] = {
    "stairs": Stairs,
    "sill": Sill,
    "platform": Platform,
    "box": Box,
    "cylinder": Cylinder,
    "wall": Wall,
    "ramp": Ramp,
    "rubble": Rubble,
    "mesh": Mesh,
    "scatter": Scatter,
    "mjcf": Mjcf,
}
"""Kind -> model."""
