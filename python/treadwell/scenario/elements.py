"""The elements of a course as they stand in a scenario file: one model per kind."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.drawn_elements import Flights, House, Scatter, Yard
from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.ground_elements import Patch, Slabs, Terrain, Vegetation
from treadwell.scenario.types import (
    MOST_STEPS,
    Angle,
    Distance,
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
)


class Stairs(ElementTable):
    """A flight of steps. Position: middle of the first riser's foot; yaw: direction of ascent."""

    kind: Literal["stairs"]
    """Which kind of element it is."""
    position: Point2 = (0.6, 0.0)
    """Middle of the first riser's foot: world x, y, m."""
    yaw: Angle = 0.0
    """Direction of ascent, rad."""
    steps: Annotated[int, Field(ge=1, le=MOST_STEPS)] = 4
    """Number of steps, the landing included."""
    rise: RiseOrList = 0.03
    """Height of a step, m: one for all, or a list with one for each."""
    tread: LengthOrList = 0.12
    """Depth of a step, m: one for all, or a list with one for each."""
    width: Length = 0.33
    """Extent across the direction of ascent, m."""
    landing: Length = 0.33
    """Depth of the topmost step, m: it takes the place of the last tread."""
    descent: bool = False
    """Whether the same steps lead down again behind the landing."""
    turn: Annotated[float, Field(ge=-0.8, le=0.8)] = 0.0
    """Each step's front edge is turned about its middle by this against the one below, rad."""

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
    """Which kind of element it is."""
    position: Point2 = (1.5, 0.0)
    """Middle of the near edge: world x, y, m."""
    yaw: Angle = 0.0
    """Walking direction, rad."""
    rise: Rise = 0.038
    """Height above the ground, m."""
    depth: Length = 0.09
    """Extent in walking direction, m."""
    width: Length = 1.0
    """Extent across, m."""


class Platform(ElementTable):
    """A block with a walkable top. Position: its centre."""

    kind: Literal["platform"]
    """Which kind of element it is."""
    position: Point2 = (2.5, 0.0)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Size3 = (0.6, 1.0, 0.03)
    """Length, width and height, m."""


class Box(ElementTable):
    """An obstacle. Position: its centre; `base`: height of its underside above the ground."""

    kind: Literal["box"]
    """Which kind of element it is."""
    position: Point2 = (1.0, 0.4)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Size3 = (0.2, 0.1, 0.3)
    """Length, width and height, m."""
    base: Height = 0.0
    """Height of its underside above the ground, m: an overhang or a curtain where it is above 0."""


class Cylinder(ElementTable):
    """An upright round obstacle. Position: its axis."""

    kind: Literal["cylinder"]
    """Which kind of element it is."""
    position: Point2 = (1.2, -0.4)
    """Its axis: world x, y, m."""
    radius: Length = 0.05
    """Radius, m."""
    height: Length = 0.4
    """Height, m."""


class Wall(ElementTable):
    """An upright wall along a line."""

    kind: Literal["wall"]
    """Which kind of element it is."""
    from_: Annotated[Point2, Field(alias="from")] = (0.0, 1.0)
    """One end of its line: world x, y, m."""
    to: Point2 = (3.0, 1.0)
    """The other end: world x, y, m."""
    height: Length = 0.6
    """Height, m."""
    thickness: Length = 0.05
    """Thickness, m, half of it to either side of the line."""

    @model_validator(mode="after")
    def _has_a_length(self) -> Self:
        if self.from_ == self.to:
            raise PydanticCustomError(
                "no_length", "must differ from the wall's other end", {"key": "to"}
            )
        return self


class Door(ElementTable):
    """An opening in a wall, with a lintel above it and a leaf, hinged left, that opens away.

    Position: middle of the opening; yaw: the way through.
    """

    kind: Literal["door"]
    """Which kind of element it is."""
    position: Point2 = (1.0, 0.0)
    """Middle of the opening: world x, y, m."""
    yaw: Angle = 0.0
    """The way through, rad."""
    width: Length = 0.6
    """Extent of the opening across the way, m."""
    height: Length = 0.8
    """Height of the opening, m: the underside of the lintel."""
    wall: Annotated[tuple[Distance, Distance, Length], Field(strict=False)] = (0.5, 0.5, 1.0)
    """The wall that it is in: how far it goes to the left and to the right of the opening, and its
    height, m."""
    thickness: Length = 0.05
    """Thickness of the wall, m, half of it to either side of the position."""
    open: Fraction = 1.0
    """How far the leaf is open: 0 shut, 1 by 90 degrees."""


class Ramp(ElementTable):
    """An inclined walkable plane. Position: middle of the low edge; yaw: direction of ascent."""

    kind: Literal["ramp"]
    """Which kind of element it is."""
    position: Point2 = (3.0, 0.0)
    """Middle of the low edge: world x, y, m."""
    yaw: Angle = 0.0
    """Direction of ascent, rad."""
    length: Length = 0.8
    """Extent along the ground in the direction of ascent, m."""
    width: Length = 0.6
    """Extent across, m."""
    rise: Rise = 0.06
    """Height of the high edge above the low one, m."""


class Rubble(ElementTable):
    """A rough patch that cannot be walked on. Position: its centre."""

    kind: Literal["rubble"]
    """Which kind of element it is."""
    position: Point2 = (1.8, 0.5)
    """Its centre: world x, y, m."""
    yaw: Angle = 0.0
    """Heading of its length, rad."""
    size: Size2 = (0.3, 0.3)
    """Length and width, m."""
    amplitude: Rise = 0.03
    """Height of the highest peak, m."""


class Mesh(ElementTable):
    """A body of any shape from an .stl or .obj file in the scenario file's folder."""

    kind: Literal["mesh"]
    """Which kind of element it is."""
    file: FileName
    """Its file, `.stl` or `.obj`, beside the scenario file."""
    position: Point3 = (0.0, 0.0, 0.0)
    """Where the file's origin goes: world x, y, z, m."""
    yaw: Angle = 0.0
    """Heading of the file's x axis, rad."""


class Mjcf(ElementTable):
    """An MJCF world in the scenario file's folder, added as it is.

    Its upright boxes and height fields are walked on, by their true surfaces. All else in it,
    tilted ones too, counts as the box around it. Steps within a height field are not looked for
    where it is asked whether there is a way.
    """

    kind: Literal["mjcf"]
    """Which kind of element it is."""
    file: FileName
    """Its MJCF file, beside the scenario file."""


MovableElement = Annotated[
    Stairs | Sill | Platform | Box | Cylinder | Wall | Ramp | Rubble | Patch | Mesh,
    Field(discriminator="kind"),
]
"""What an event can add, move or remove: one body whose place is known beforehand."""

Element = Annotated[
    Stairs
    | Sill
    | Platform
    | Box
    | Cylinder
    | Wall
    | Door
    | Ramp
    | Rubble
    | Patch
    | Vegetation
    | Terrain
    | Slabs
    | Mesh
    | Scatter
    | House
    | Yard
    | Flights
    | Mjcf,
    Field(discriminator="kind"),
]
"""Any element of `[[course]]`."""

MOVABLE: dict[str, type[ElementTable]] = {
    "stairs": Stairs,
    "sill": Sill,
    "platform": Platform,
    "box": Box,
    "cylinder": Cylinder,
    "wall": Wall,
    "ramp": Ramp,
    "rubble": Rubble,
    "patch": Patch,
    "mesh": Mesh,
}
"""Kind -> model of what an event can add, move or remove."""

ELEMENTS: dict[str, type[ElementTable]] = {
    **MOVABLE,
    "door": Door,
    "scatter": Scatter,
    "house": House,
    "yard": Yard,
    "flights": Flights,
    "vegetation": Vegetation,
    "terrain": Terrain,
    "slabs": Slabs,
    "mjcf": Mjcf,
}
"""Kind -> model."""


def named_file(element: ElementTable) -> str | None:
    """Return the file that an element names, beside the scenario file; None where it has none."""
    return element.file if isinstance(element, Mesh | Mjcf | Terrain) else None
