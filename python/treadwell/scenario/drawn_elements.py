"""Elements that draw themselves from the seed: many things in an area of the course."""

from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.types import Fraction, Point2, Rise, Size2

Area = Annotated[tuple[Point2, Point2], Field(strict=False)]
"""Its lower and its upper corner: world x, y, m."""


def check_area(area: tuple[tuple[float, float], tuple[float, float]]) -> None:
    """Refuse an area whose first corner is not the lower one.

    Raises:
        PydanticCustomError: for the key `area`.
    """
    (x0, y0), (x1, y1) = area
    if x0 >= x1 or y0 >= y1:
        raise PydanticCustomError(
            "order", "must be the lower and then the upper corner", {"key": "area"}
        )


HouseThing = Literal["door", "desk", "shelf", "cable", "bevel", "ramp", "flight", "person"]
"""What a house may hold."""
YardThing = Literal["kerb", "ramp", "slab", "post", "bar"]
"""What a yard may hold."""
HOUSE_THINGS: Final[tuple[HouseThing, ...]] = (
    "door",
    "desk",
    "shelf",
    "cable",
    "bevel",
    "ramp",
    "flight",
    "person",
)
YARD_THINGS: Final[tuple[YardThing, ...]] = ("kerb", "ramp", "slab", "post", "bar")
Tread = Annotated[float, Field(ge=0.05, le=1.0)]
"""Depth of a tread of a flight that draws itself, metres."""
FlightShape = Literal["straight", "l", "u", "winder"]
"""How a flight that draws itself can lead up."""
FlightThing = Literal["cheek", "rail", "door"]
"""What can stand beside such a flight, on its landing or on its top."""
FLIGHT_SHAPES: Final[tuple[FlightShape, ...]] = ("straight", "l", "u", "winder")
FLIGHT_THINGS: Final[tuple[FlightThing, ...]] = ("cheek", "rail", "door")


class Scatter(ElementTable):
    """Random boxes and cylinders, 0.08 m or higher, that leave a way from start to goal."""

    kind: Literal["scatter"]
    """Which kind of element it is."""
    area: Area = ((0.5, -0.8), (2.5, 0.8))
    """Two opposite corners of the area in which their centres lie: world x, y, m."""
    count: Annotated[int, Field(ge=1, le=200)] = 6
    """How many there are."""
    size: Size2 = (0.05, 0.25)
    """Smallest and largest edge, m."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        check_area(self.area)
        if self.size[0] > self.size[1]:
            raise PydanticCustomError(
                "order", "must be the smallest and then the largest edge", {"key": "size"}
            )
        return self


class House(ElementTable):
    """Rooms with doors and what stands in them; start and goal lie in rooms of their own.

    Two passages that a wide robot fits through lead from room to room; what is drawn is the same
    for the same seed and name.
    """

    kind: Literal["house"]
    """Which kind of element it is."""
    area: Area = ((-0.7, -1.5), (4.9, 1.5))
    """Two opposite corners of its outer walls: world x, y, m. Start and goal lie inside."""
    rooms: Annotated[int, Field(ge=2, le=12)] = 3
    """How many rooms it has."""
    things: Annotated[tuple[HouseThing, ...], Field(strict=False, max_length=8)] = HOUSE_THINGS
    """What it may hold: doors with leaves that stand open or ajar or are shut on the way, desks,
    shelves, cables, bevels before thresholds, a ramp or a flight up to a raised floor, people who
    walk."""
    closed: Fraction = 0.15
    """The share of seeds in which no way leads to the goal."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        check_area(self.area)
        return self


class Yard(ElementTable):
    """Open ground between two fences with what lies about in it, and what has to be crossed.

    What is drawn is the same for the same seed and name.
    """

    kind: Literal["yard"]
    """Which kind of element it is."""
    area: Area = ((-0.8, -1.4), (4.6, 1.4))
    """Two opposite corners: world x, y, m. Fences run along x; start and goal lie inside."""
    clutter: Annotated[int, Field(ge=0, le=60)] = 8
    """How many posts, slabs and bars lie about."""
    things: Annotated[tuple[YardThing, ...], Field(strict=False, max_length=5)] = YARD_THINGS
    """What it may hold: kerbs askew and ramps, which lie across the whole yard; slabs, posts and
    low bars, which one can go around."""
    closed: Fraction = 0.15
    """The share of seeds in which no way leads to the goal."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        check_area(self.area)
        return self


class Flights(ElementTable):
    """Stairs up to the goal, or from the start down, on open ground, in any direction.

    They are straight, or turn on a landing, or wind. What is drawn is the same for the same seed
    and name.
    """

    kind: Literal["flights"]
    """Which kind of element it is."""
    shapes: Annotated[tuple[FlightShape, ...], Field(strict=False, min_length=1, max_length=4)] = (
        FLIGHT_SHAPES
    )
    """How they may lead up: straight, with a quarter turn (l) or half a turn (u) on a landing, or
    winding."""
    rise: Annotated[tuple[Rise, Rise], Field(strict=False)] = (0.015, 0.050)
    """Least and largest height of a step that is meant to be climbed, m."""
    tread: Annotated[tuple[Tread, Tread], Field(strict=False)] = (0.11, 0.25)
    """Least and largest depth of a tread, m; of winding ones of the usable part."""
    things: Annotated[tuple[FlightThing, ...], Field(strict=False, max_length=3)] = FLIGHT_THINGS
    """What they may have: cheeks or rails beside the steps, a door on a landing or on the top."""
    down: Fraction = 0.5
    """The share of seeds in which the start is on the top, and the goal on the ground."""
    closed: Fraction = 0.15
    """The share of seeds in which no way leads to the goal: a step too high, a door shut, too
    narrow or too low."""

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        for key, (least, most) in (("rise", self.rise), ("tread", self.tread)):
            if least > most:
                raise PydanticCustomError(
                    "order", "must be the least and then the largest", {"key": key}
                )
        return self
