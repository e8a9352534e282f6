"""A scenario fitted to its robot's size: what `scale_to_robot = true` multiplies, and by what.

Lengths grow with the robot's scale s, times and speeds with the root of s (Froude's rule: so walks
look alike), forces with its mass. Angles, shares and frictions keep their numbers, and so do the
delays and errors of senses and the settings of `[navigation]`, which are the robot's.
"""

from typing import Any, Final, Protocol, TypeVar

from treadwell.scenario.events import Event
from treadwell.scenario.faults import FAULTS, Fault
from treadwell.scenario.model import Scenario
from treadwell.scenario.types import Scale, Table

MASS_KG: Final = 7.0
"""Of `qrio`, whose scale is 1."""
LENGTHS: Final = ("position", "height", "radius", "via", "near", "within", "to", "path")
"""Keys of start, goal and events that are lengths."""
TIMES: Final = ("at", "duration")
"""Keys of events that are times. Something that lasts and something that comes wait alike."""
SPEEDS: Final = ("speed",)
IMPULSES: Final = ("impulse",)
AnyTable = TypeVar("AnyTable", bound=Table)


class Sized(Protocol):
    """What a robot tells of its size."""

    @property
    def scale(self) -> float:
        """Its leg length over `qrio`'s."""

    @property
    def mass(self) -> float:
        """All of it, kg."""


def size_of(robot: Sized) -> Scale:
    """Return how large a robot is; one of scale 1 has all that is `qrio`'s, whatever its mass."""
    return Scale() if robot.scale == 1.0 else Scale(robot.scale, robot.mass / MASS_KG)


def to_robot(scenario: Scenario, robot: Sized) -> Scenario:
    """Return a scenario as it is for a robot: itself, or with `scale_to_robot` multiplied.

    `course`, and the elements that events add, stay as they are written: they are drawn in those
    lengths, and what comes of it is multiplied when the course is planned. For a robot of scale 1,
    and for a scenario that was fitted before, it is the same scenario.

    Args:
        scenario: as it was read.
        robot: its robot.
    """
    scale = size_of(robot)
    if not scenario.scale_to_robot or scenario.written is not scenario or scale == Scale():
        return scenario
    expect = scenario.expect
    fitted = scenario.model_copy(
        update={
            "time_limit": scenario.time_limit * scale.patience,
            "start": multiplied(scenario.start, scale),
            "goal": multiplied(scenario.goal, scale),
            "event": tuple(scaled_event(event, scale) for event in scenario.event),
            "expect": expect.model_copy(
                update={
                    "max_time": _times(expect.max_time, scale.patience),
                    "max_translation_error": _times(expect.max_translation_error, scale.length),
                    "max_height_error": _times(expect.max_height_error, scale.length),
                }
            ),
        }
    )
    fitted._written, fitted._scale = scenario, scale
    return fitted


def scaled_event(event: Event, scale: Scale) -> Event:
    """Return an event as `multiplied` makes it, and the force of a fault that has one."""
    made = multiplied(event, scale)
    if isinstance(made, Fault) and FAULTS[made.part][made.kind].is_force:
        return made.model_copy(update={"value": _times(made.value, scale.mass)})
    return made


def multiplied(table: AnyTable, scale: Scale) -> AnyTable:
    """Return start, goal or an event with its lengths, times, speed and impulse multiplied."""
    factors = (
        (LENGTHS, scale.length),
        (TIMES, scale.time),
        (SPEEDS, scale.time),
        (IMPULSES, scale.impulse),
    )
    return table.model_copy(
        update={
            key: _times(getattr(table, key), factor)
            for keys, factor in factors
            for key in keys
            if key in type(table).model_fields
        }
    )


def _times(value: Any, factor: float) -> Any:  # noqa: ANN401 - a number, or numbers in tuples
    if value is None:
        return None
    if isinstance(value, tuple):
        return tuple(_times(item, factor) for item in value)
    return value * factor
