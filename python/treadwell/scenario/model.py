"""A scenario: what its TOML file says, checked, with draws and overrides applied."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import (
    ConfigDict,
    Field,
    PrivateAttr,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import PydanticCustomError

from treadwell.additions import is_component, known
from treadwell.components import COMPONENTS, parameter_tables
from treadwell.scenario.elements import Element
from treadwell.scenario.events import Add, Event
from treadwell.scenario.types import (
    Angle,
    Friction,
    Height,
    Length,
    Name,
    Point2,
    Seconds,
    Table,
)
from treadwell.scenario.values import check_parameters

SCHEMA = 1
SEEDS = 2**53
"""Seeds are below it: JSON's numbers hold them."""
MOST_ELEMENTS = 500
MOST_EVENTS = 200
Count = Annotated[int, Field(ge=0, le=1_000_000)]
Limit = Annotated[float, Field(gt=0.0, le=1e6)]


class Start(Table):
    """Where the robot starts, in the world frame."""

    position: Point2 = (0.0, 0.0)
    height: Height | None = None
    """The level, when several lie above each other; default: the highest surface there."""
    yaw: Angle = 0.0
    known: bool = True
    """False: the core is not told where it starts."""


class Goal(Table):
    """The disc in which the robot has to come to a stand."""

    position: Point2 = (2.0, 0.0)
    height: Height | None = None
    """The level, as of the start. Scored only where it is given."""
    radius: Length = 0.15
    via: Annotated[tuple[Point2, ...], Field(strict=False, max_length=100)] = ()
    """Points to pass in this order, each within `radius`, before the goal."""


class Physics(Table):
    """What of the physics a scenario can change."""

    friction: Friction = 0.8
    """Sliding friction of the soles on everything."""
    mass_scale: Annotated[float, Field(ge=0.2, le=5.0)] = 1.0
    """Factor on the robot's masses and inertias; its controller does not know."""


class Sensors(Table):
    """Which of the senses have their noise."""

    depth: Literal["noisy", "ideal"] = "noisy"
    encoders: Literal["noisy", "ideal"] = "noisy"
    imu: Literal["noisy", "ideal"] = "noisy"
    feet: Literal["noisy", "ideal"] = "noisy"
    latency: Annotated[float, Field(ge=0.0, le=2.0)] = 0.0
    """Seconds from exposure to arrival of a depth image."""
    camera_roll_pitch_error: Annotated[float, Field(ge=0.0, le=0.5)] | None = None
    """Bound of the camera's error in roll and pitch, rad, instead of the robot's own."""
    camera_position_error: Annotated[float, Field(ge=0.0, le=0.1)] | None = None
    """Bound of the error of the camera's place, m, instead of the robot's own."""
    mismatch_rate: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    """Share of pixels that stereo gets grossly wrong, instead of the robot's own."""


class Navigation(Table):
    """Which components navigate, and their parameters (`[navigation.<component>]`)."""

    model_config = ConfigDict(extra="allow")

    world_model: str = "fog"
    segmenter: str = "scan_line"
    localizer: str = "odometry"
    planner: str = "a_star"
    behaviour: str = "stair_climbing"
    call_limit: Annotated[Seconds, Field(gt=0.0)] = 30.0
    """Seconds of wall-clock time that one call of a component in Python may take."""

    @field_validator("world_model", "segmenter", "localizer", "planner", "behaviour")
    @classmethod
    def _is_a_component(cls, value: str, info: ValidationInfo) -> str:
        slot = str(info.field_name)
        if not is_component(slot, value):
            raise PydanticCustomError(
                "component",
                "must be {names} or 'package.module:Class'",
                {"names": ", ".join(known(slot)), "among": slot},
            )
        return value

    @model_validator(mode="after")
    def _tables_are_parameters(self) -> Self:
        own = {value.rpartition(":")[2] for value in self.slots().values()}
        for key, value in (self.model_extra or {}).items():
            if key not in {*parameter_tables(), *own}:
                raise PydanticCustomError("extra_forbidden", "unknown key", {"key": key})
            check_parameters(value, (key,))
        return self

    def slots(self) -> dict[str, str]:
        """Return slot -> the name of the component chosen."""
        return {slot: getattr(self, slot) for slot in COMPONENTS}

    def parameters(self) -> dict[str, dict[str, Any]]:
        """Return component -> its parameters, untouched: what goes to the core."""
        return dict(self.model_extra or {})


class Expect(Table):
    """What makes a run pass. What is None is not asked for."""

    outcome: Literal["goal_reached", "refused"] = "goal_reached"
    max_time: Limit | None = None
    max_falls: Count | None = 0
    max_collisions: Count | None = None
    max_translation_error: Limit | None = None
    max_height_error: Limit | None = None


class Scenario(Table):
    """A whole scenario file, as it is run."""

    schema_: Annotated[Literal[1], Field(alias="schema")]
    name: Name
    description: Annotated[str, Field(max_length=500)] = ""
    robot: Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f]{1,500}$")] = "qrio"
    seed: Annotated[int, Field(ge=0, lt=SEEDS)] = 0
    time_limit: Annotated[Seconds, Field(gt=0.0)] = 120.0
    start: Start
    goal: Goal
    course: Annotated[tuple[Element, ...], Field(strict=False, max_length=MOST_ELEMENTS)] = ()
    event: Annotated[tuple[Event, ...], Field(strict=False, max_length=MOST_EVENTS)] = ()
    physics: Physics = Physics()
    sensors: Sensors = Sensors()
    navigation: Navigation = Navigation()
    expect: Expect = Expect()

    _path: Path | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _names_are_unique(self) -> Self:
        seen: set[str] = set()
        added = [
            (("event", i, "element"), e.element)
            for i, e in enumerate(self.event)
            if isinstance(e, Add)
        ]
        for where, element in [(("course", i), e) for i, e in enumerate(self.course)] + added:
            if element.name is None:
                continue
            if element.name in seen:
                raise PydanticCustomError(
                    "unique", "must be unique among the elements", {"at": (*where, "name")}
                )
            seen.add(element.name)
        return self

    @property
    def path(self) -> Path | None:
        """The file that it was read from; None when it was made otherwise."""
        return self._path

    @property
    def folder(self) -> Path:
        """The folder in which the files that it names lie."""
        return Path.cwd() if self._path is None else self._path.parent

    def configuration(self) -> dict[str, Any]:
        """Return everything as it is run, as plain data: what `result.json` holds."""
        return self.model_dump(mode="json", by_alias=True)
