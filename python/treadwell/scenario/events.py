"""What can happen on the way, as it stands in a scenario file: one model per `do`."""

from typing import Annotated, Literal

from pydantic import Field

from treadwell.scenario.elements import MovableElement
from treadwell.scenario.event_table import EventTable
from treadwell.scenario.faults import Fault
from treadwell.scenario.types import Angle, ElementName, Friction, Height, Point2, Seconds

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
    """An element moves in a straight line; nothing happens when it is not there."""

    do: Literal["move"]
    """What happens."""
    name: ElementName
    """The element's name."""
    to: Point2
    """Where it goes: world x, y, m."""
    speed: Annotated[float, Field(gt=0.0, le=10.0)] = 0.2
    """Speed, m/s."""


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
    Add | Remove | Move | Push | Kidnap | Blind | ChangeFriction | EncoderOffset | Fault | Knock,
    Field(discriminator="do"),
]
"""Any entry of `[[event]]`."""

EVENTS: dict[str, type[EventTable]] = {
    "add": Add,
    "remove": Remove,
    "move": Move,
    "push": Push,
    "kidnap": Kidnap,
    "blind": Blind,
    "friction": ChangeFriction,
    "encoder_offset": EncoderOffset,
    "fault": Fault,
    "knock": Knock,
}
"""`do` -> model."""
