"""The number, name and table types that the models of a scenario file are made of."""

import math
import sys
from dataclasses import dataclass, field
from typing import Annotated, Any, Final

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, field_validator
from pydantic_core import PydanticCustomError

LARGEST_M: Final = 100.0
"""Nothing in a scenario is farther away or longer than this, in metres."""
SMALLEST_M: Final = 0.001
"""Nothing in a scenario is thinner than this, in metres: MuJoCo makes no sense of it."""


@dataclass(frozen=True, slots=True)
class Scale:
    """By what a scenario in `qrio`'s lengths is multiplied for a robot of another size.

    Attributes:
        length: what lengths are multiplied by.
        mass: what masses and forces are.
    """

    length: float = 1.0
    mass: float = 1.0

    @property
    def time(self) -> float:
        """What times are multiplied by, and speeds: of a walk twice as long, the root of two."""
        return math.sqrt(self.length)

    @property
    def patience(self) -> float:
        """What limits of time are multiplied by: as times are, but never less than 1."""
        return max(1.0, self.time)

    @property
    def impulse(self) -> float:
        """What impulses are multiplied by: as mass times speed."""
        return self.mass * self.time


class PlainNumbers(BaseModel):
    """Numbers that arithmetic takes as they look: no -0.0, and none too near to 0 for 64 bits.

    A range that ends in -0.0 is empty to NumPy, and the reciprocal of a subnormal number is
    infinite.
    """

    @field_validator("*")
    @classmethod
    def _take_plainly(cls, value: Any) -> Any:  # noqa: ANN401 - whatever a field holds
        return plain(value)


def plain(value: Any) -> Any:  # noqa: ANN401 - whatever a field holds
    """Return a value with 0.0 for each -0.0 in it.

    Raises:
        PydanticCustomError: a number in it is subnormal.
    """
    if isinstance(value, float):
        if 0.0 < abs(value) < sys.float_info.min:
            raise PydanticCustomError(
                "subnormal",
                "must be 0, or not so near to it: {least} at least",
                {"least": sys.float_info.min},
            )
        return value + 0.0
    if isinstance(value, tuple | list):
        return type(value)(plain(item) for item in value)
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return value


class Table(PlainNumbers):
    """A table of the file: no unknown keys, no conversions, no NaN or infinity, never changed."""

    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        frozen=True,
        populate_by_name=True,
        validate_default=False,
        use_attribute_docstrings=True,
    )


def _shape(value: object) -> str:
    return "list" if isinstance(value, list | tuple) else "number"


Coordinate = Annotated[float, Field(ge=-LARGEST_M, le=LARGEST_M)]
"""A coordinate in the world, metres."""
Length = Annotated[float, Field(ge=SMALLEST_M, le=LARGEST_M)]
"""An extent, metres."""
Distance = Annotated[float, Field(ge=0.0, le=LARGEST_M)]
"""An extent that may be nothing, metres."""
Height = Annotated[float, Field(ge=-10.0, le=10.0)]
"""A level or a base above the ground, metres."""
Angle = Annotated[float, Field(ge=-12.6, le=12.6)]
"""An angle, radians, at most two turns (degrees by mistake are often more)."""
Seconds = Annotated[float, Field(ge=0.0, le=36000.0)]
"""A time or a duration, simulated seconds."""
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
"""A share, 0 to 1."""
Friction = Annotated[float, Field(ge=0.0, le=10.0)]
"""A sliding friction coefficient."""

Point2 = Annotated[tuple[Coordinate, Coordinate], Field(strict=False)]
"""World x, y in metres."""
Point3 = Annotated[tuple[Coordinate, Coordinate, Coordinate], Field(strict=False)]
"""World x, y, z in metres."""
Size2 = Annotated[tuple[Length, Length], Field(strict=False)]
"""Length along x, width along y in metres."""
Size3 = Annotated[tuple[Length, Length, Length], Field(strict=False)]
"""Length along x, width along y, height along z in metres."""

Rise = Annotated[float, Field(ge=SMALLEST_M, le=2.0)]
"""One step's height, metres."""
MOST_STEPS: Final = 100
LengthOrList = Annotated[
    Annotated[Length, Tag("number")]
    | Annotated[
        tuple[Length, ...], Field(strict=False, min_length=1, max_length=MOST_STEPS), Tag("list")
    ],
    Discriminator(_shape),
]
"""One length for all steps, or one per step."""
RiseOrList = Annotated[
    Annotated[Rise, Tag("number")]
    | Annotated[
        tuple[Rise, ...], Field(strict=False, min_length=1, max_length=MOST_STEPS), Tag("list")
    ],
    Discriminator(_shape),
]
"""One rise for all steps, or one per step."""

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$")]
"""A scenario's name: it becomes part of a folder's name."""
ElementName = Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_ -]{0,63}$")]
"""An element's name: no dot (it is part of a dotted key) and no digit first (that is an index)."""
FileName = Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f]{1,255}$")]
"""A file beside the scenario file."""


@dataclass(frozen=True, slots=True)
class SetKeys:
    """Which keys overrides have, for what errors say: a scenario is the same with and without.

    Attributes:
        word: what they are called: `--set` or `overrides`.
        keys: dotted keys.
    """

    word: str = field(default="", compare=False)
    keys: tuple[str, ...] = field(default=(), compare=False)
