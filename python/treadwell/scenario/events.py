"""What can happen on the way, as it stands in a scenario file: one model per `do`."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from treadwell.scenario.elements import MovableElement
from treadwell.scenario.event_table import EventTable
from treadwell.scenario.faults import Fault
from treadwell.scenario.types import (
    Angle,
    ElementName,
    Fraction,
    Friction,
    Height,
    Point2,
    Seconds,
)

Impulse = Annotated[float, Field(ge=-100.0, le=100.0)]
"""One component of a push, N·s."""


class Add(EventTable):
    """An element appears."""

    do: Literal["add"]
    """What happens."""
    element: MovableElement
    """The element, as in `[[course]]`."""


class Remove(EventTable):
    """An element vanishes; nothing happens when it is not there."""

    do: Literal["remove"]
    """What happens."""
    name: ElementName
    """The element's name."""


class Move(EventTable):
    """An element moves to a place or along a path; nothing happens when it is not there."""

    do: Literal["move"]
    """What happens."""
    name: ElementName
    """The element's name."""
    to: Point2 | None = None
    """Where it goes: world x, y, m. Either this or `path`."""
    path: (
        Annotated[tuple[Point2, ...], Field(strict=False, min_length=1, max_length=100)] | None
    ) = None
    """The points that it goes to one after the other: world x, y, m."""
    loop: bool = False
    """Whether it goes on from the path's last point to its first, for ever."""
    speed: Annotated[float, Field(ge=0.001, le=10.0)] = 0.2
    """Speed, m/s."""
    gives_way: bool = False
    """Whether it stops before the robot, as a person does, and turns back after three seconds."""

    @model_validator(mode="after")
    def _has_one_way(self) -> Self:
        if (self.to is None) == (self.path is None):
            raise PydanticCustomError("way", "must have either 'to' or 'path'", {"key": None})
        if self.loop and self.path is None:
            raise PydanticCustomError("way", "belongs to a 'path'", {"key": "loop"})
        return self

    def way(self) -> tuple[tuple[float, float], ...]:
        """Return the points that it goes to, in order: world x, y, m."""
        return self.path or ((self.to,) if self.to is not None else ())


class SetDoor(EventTable):
    """Somebody opens or shuts a door, within a second."""

    do: Literal["set_door"]
    """What happens."""
    name: ElementName
    """The door's name."""
    open: Fraction
    """How far its leaf is open in the end: 0 shut, 1 by 90 degrees."""


class Push(EventTable):
    """A constant force on the torso for 0.1 s."""

    do: Literal["push"]
    """What happens."""
    impulse: Annotated[tuple[Impulse, Impulse, Impulse], Field(strict=False)]
    """Force times time along world x, y, z, N·s."""


class Kidnap(EventTable):
    """The robot is put somewhere else as it stands."""

    do: Literal["kidnap"]
    """What happens."""
    position: Point2
    """Where it is put: world x, y, m."""
    yaw: Angle = 0.0
    """Its heading there, rad."""
    height: Height | None = None
    """The level, m; the highest surface there when left out."""


class Blind(EventTable):
    """The depth camera sees nothing for a while."""

    do: Literal["blind"]
    """What happens."""
    duration: Seconds
    """How long, simulated seconds."""


class ChangeFriction(EventTable):
    """The friction of the soles on everything changes."""

    do: Literal["friction"]
    """What happens."""
    value: Friction
    """The coefficient from then on."""


class EncoderOffset(EventTable):
    """A joint's encoder reads wrong by this from now on."""

    do: Literal["encoder_offset"]
    """What happens."""
    joint: Annotated[str, Field(min_length=1, max_length=64)]
    """The joint's name."""
    value: Angle
    """What is added to the angle that it reads, rad."""


class Knock(EventTable):
    """The camera turns against the head that carries it, and stays so; nobody tells the robot."""

    do: Literal["knock"]
    """What happens."""
    roll: Angle = 0.0
    """About its line of sight, rad; positive: clockwise."""
    pitch: Angle = 0.0
    """Down, rad."""
    yaw: Angle = 0.0
    """To the left, rad."""


Event = Annotated[
    Add
    | Remove
    | Move
    | SetDoor
    | Push
    | Kidnap
    | Blind
    | ChangeFriction
    | EncoderOffset
    | Fault
    | Knock,
    Field(discriminator="do"),
]
"""Any entry of `[[event]]`."""

EVENTS: dict[str, type[EventTable]] = {
    "add": Add,
    "remove": Remove,
    "move": Move,
    "set_door": SetDoor,
    "push": Push,
    "kidnap": Kidnap,
    "blind": Blind,
    "friction": ChangeFriction,
    "encoder_offset": EncoderOffset,
    "fault": Fault,
    "knock": Knock,
}
"""`do` -> model."""
