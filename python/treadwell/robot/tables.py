"""The table and the kinds of numbers that the models of a robot's file are made of."""

from typing import Annotated, Final

from pydantic import AfterValidator, ConfigDict, Field, FiniteFloat, StringConstraints

from treadwell.scenario.types import PlainNumbers

FINEST: Final = 1e-6
"""The finest step that anything is counted in; a finer one means nothing."""


def _coarse(value: float) -> float:
    if 0.0 < value < FINEST:
        raise ValueError(f"must be 0 or at least {FINEST}")
    return value


def _unit(value: tuple[float, ...]) -> tuple[float, ...]:
    length = sum(number * number for number in value) ** 0.5
    if not 0.99 < length < 1.01:
        raise ValueError(f"must have the length 1, it has {length:.3g}")
    return value


Name = Annotated[str, StringConstraints(min_length=1, max_length=100)]
Share = Annotated[FiniteFloat, Field(ge=0.0, le=1.0)]
Scale = Annotated[FiniteFloat, Field(ge=0.5, le=5.0)]
"""How large a robot is against `qrio`."""
Length = Annotated[FiniteFloat, Field(ge=0.001, le=10.0)]
"""An extent of the robot, m."""
Coordinate = Annotated[FiniteFloat, Field(ge=-10.0, le=10.0)]
"""A place on the robot, m."""
Position = tuple[Coordinate, Coordinate, Coordinate]
"""A point of the robot, m."""
Orientation = Annotated[
    tuple[FiniteFloat, FiniteFloat, FiniteFloat, FiniteFloat], AfterValidator(_unit)
]
"""A quaternion w, x, y, z of length 1."""
Angle = Annotated[FiniteFloat, Field(ge=-100.0, le=100.0)]
"""An angle of a joint, rad."""
AngleError = Annotated[FiniteFloat, Field(ge=0.0, le=0.5)]
"""How far an angle is wrong, rad."""
LengthError = Annotated[FiniteFloat, Field(ge=0.0, le=0.1)]
"""How far a place is wrong, m."""
RateError = Annotated[FiniteFloat, Field(ge=0.0, le=10.0)]
"""How far an angular velocity is wrong, rad/s."""
AccelerationError = Annotated[FiniteFloat, Field(ge=0.0, le=100.0)]
"""How far an acceleration is wrong, m/s²."""
ForceError = Annotated[FiniteFloat, Field(ge=0.0, le=1000.0)]
"""How far a force is wrong, N."""
AngleStep = Annotated[FiniteFloat, Field(ge=0.0, le=0.5), AfterValidator(_coarse)]
"""The step in which an angle is counted, rad; 0: it is not."""
Torque = Annotated[FiniteFloat, Field(ge=0.001, le=10000.0)]
"""A torque, N·m."""
Friction = Annotated[FiniteFloat, Field(ge=0.0, le=1000.0)]
"""A torque against the motion, N·m."""
Speed = Annotated[FiniteFloat, Field(ge=0.01, le=1000.0)]
"""An angular velocity, rad/s."""
Stiffness = Annotated[FiniteFloat, Field(ge=0.001, le=100000.0)]
"""Torque for an angle, N·m/rad."""
Damping = Annotated[FiniteFloat, Field(ge=0.0, le=10000.0)]
"""Torque for an angular velocity, N·m·s/rad."""
Inertia = Annotated[FiniteFloat, Field(ge=0.0, le=100.0)]
"""A moment of inertia, kg·m²."""
Pixels = Annotated[FiniteFloat, Field(ge=0.0, le=640.0)]
"""An extent in a picture, pixels."""
PixelStep = Annotated[FiniteFloat, Field(ge=0.0, le=640.0), AfterValidator(_coarse)]
"""The step in which pixels are counted; 0: they are not."""
Disparity = Annotated[FiniteFloat, Field(ge=0.001, le=640.0)]
"""What two lenses see in other places, pixels."""
Depth = Annotated[FiniteFloat, Field(ge=0.001, le=100.0)]
"""A distance from the camera, m."""


class Table(PlainNumbers):
    """A table of the file: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)
