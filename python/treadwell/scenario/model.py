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
from treadwell.components import COMPONENTS, OF_CHOICE, TABLES, parameter_tables
from treadwell.scenario.elements import Element
from treadwell.scenario.events import Add, Event
from treadwell.scenario.types import (
    Angle,
    Friction,
    Height,
    Length,
    Name,
    Point2,
    Scale,
    Seconds,
    SetKeys,
    Table,
)
from treadwell.scenario.values import check_names, check_parameters

SCHEMA = 1
SEEDS = 2**53
"""Seeds are below it: JSON's numbers hold them."""
MOST_ELEMENTS = 2000
MOST_EVENTS = 200
Count = Annotated[int, Field(ge=0, le=1_000_000)]
Limit = Annotated[float, Field(ge=1e-6, le=1e6)]


class Start(Table):
    """Where the robot starts, in the world frame."""

    position: Point2 = (0.0, 0.0)
    """World x, y, m."""
    height: Height | None = None
    """The level, m, when several lie above each other; default: the highest surface there."""
    yaw: Angle = 0.0
    """Heading, rad, counter-clockwise from world x."""
    known: bool = True
    """False: the core is not told where it starts."""


class Goal(Table):
    """The disc in which the robot has to come to a stand."""

    position: Point2 = (2.0, 0.0)
    """Its middle: world x, y, m."""
    height: Height | None = None
    """The level, m, as of the start. Scored only where it is given."""
    radius: Length = 0.15
    """The robot stops at any pose inside this on which it can stand, m."""
    via: Annotated[tuple[Point2, ...], Field(strict=False, max_length=100)] = ()
    """Points to pass in this order, each within `radius`, before the goal: world x, y, m."""


class Physics(Table):
    """What of the physics a scenario can change."""

    friction: Friction = 0.8
    """Sliding friction of the soles on everything."""
    mass_scale: Annotated[float, Field(ge=0.2, le=5.0)] = 1.0
    """Factor on the robot's masses and inertias; its controller does not know."""


class Sensors(Table):
    """Which of the senses have their noise."""

    depth: Literal["noisy", "ideal"] = "noisy"
    """The depth camera: with the errors of the robot's own sensor, or without any."""
    encoders: Literal["noisy", "ideal"] = "noisy"
    """The joints' encoders, and how well the camera's mount is known."""
    imu: Literal["noisy", "ideal"] = "noisy"
    """The inertial measurement unit: noise and bias of gyro and accelerometer."""
    feet: Literal["noisy", "ideal"] = "noisy"
    """The force sensors of the soles."""
    latency: Annotated[float, Field(ge=0.0, le=2.0)] = 0.0
    """Seconds from exposure to arrival of a depth image."""
    camera_roll_pitch_error: Annotated[float, Field(ge=0.0, le=0.5)] | None = None
    """Bound of the camera's error in roll and pitch, rad, instead of the robot's own."""
    camera_position_error: Annotated[float, Field(ge=0.0, le=0.1)] | None = None
    """Bound of the error of the camera's place, m, instead of the robot's own."""
    mismatch_rate: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    """Share of pixels that stereo gets grossly wrong, instead of the robot's own."""
    intensity: bool = False
    """Whether frames have an image of brightness beside the depth: `Frame.intensity`."""


class Navigation(Table):
    """Which components navigate, and their parameters (`[navigation.<component>]`)."""

    model_config = ConfigDict(extra="allow")

    world_model: str = "fog"
    """What keeps the map: a name of `treadwell list components`, or `package.module:Class`."""
    segmenter: str = "scan_line"
    """What finds planes in a depth image."""
    localizer: str = "odometry"
    """What keeps the robot's pose in the map."""
    planner: str = "a_star"
    """What finds the way."""
    behaviour: str = "stair_climbing"
    """What decides."""
    walker: str = "dcm"
    """What moves the legs."""
    call_limit: Annotated[Seconds, Field(ge=0.001)] = 30.0
    """Seconds of wall-clock time that one call of a component in Python may take."""

    @field_validator(*COMPONENTS)
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
        foreign = (name for slot, name in self.slots().items() if name not in COMPONENTS[slot])
        own = {name.rpartition(":")[2] for name in foreign}
        for key, value in (self.model_extra or {}).items():
            if key not in {*parameter_tables(), *own}:
                raise PydanticCustomError("extra_forbidden", "unknown key", {"key": key})
            check_parameters(value, (key,))
            if key in OF_CHOICE - self.tables_read() - own:
                check_names(value, (key,))
        return self

    def slots(self) -> dict[str, str]:
        """Return slot -> the name of the component chosen."""
        return {slot: getattr(self, slot) for slot in COMPONENTS}

    def tables_read(self) -> set[str]:
        """Return the names of the tables that the core's own among the chosen components read."""
        return {
            name for slot, chosen in self.slots().items() for name in TABLES[slot].get(chosen, ())
        }

    def parameters(self) -> dict[str, dict[str, Any]]:
        """Return component -> its parameters, untouched: what goes to the core."""
        return dict(self.model_extra or {})


class Expect(Table):
    """What makes a run pass. What is None is not asked for."""

    outcome: Literal["goal_reached", "refused"] = "goal_reached"
    """How it has to end."""
    max_time: Limit | None = None
    """Time it may take at most, simulated seconds."""
    max_falls: Count | None = 0
    """Falls at most."""
    max_collisions: Count | None = None
    """Collisions at most."""
    max_collisions_walking: Count | None = None
    """Collisions at most, but for those with what moved when they began while the robot stood."""
    max_translation_error: Limit | None = None
    """Mean distance between the believed and the true place at most, m."""
    max_height_error: Limit | None = None
    """Error of the worst mapped surface at most, m."""


class Scenario(Table):
    """A whole scenario file, as it is run."""

    schema_: Annotated[Literal[1], Field(alias="schema")]
    """The version of this form."""
    name: Name
    """The scenario's name; it becomes part of a run folder's name."""
    description: Annotated[str, Field(max_length=500)] = ""
    """One line for `treadwell list scenarios`."""
    robot: Annotated[str, Field(pattern=r"^[^\x00-\x1f\x7f]{1,500}$")] = "qrio"
    """A robot of `treadwell list robots`, or the path to a robot's folder from this file's."""
    seed: Annotated[int, Field(ge=0, lt=SEEDS)] = 0
    """What all that is random is drawn from: one seed, one result on one kind of processor."""
    time_limit: Annotated[Seconds, Field(ge=0.001)] = 120.0
    """The episode ends after this, simulated seconds."""
    scale_to_robot: bool = False
    """Whether the lengths of course, start, goal and events are `qrio`'s, to be multiplied by the
    robot's scale: its leg length over `qrio`'s. Times, speeds and pushes follow."""
    start: Start
    """Where the robot starts."""
    goal: Goal
    """Where it shall come to a stand."""
    course: Annotated[tuple[Element, ...], Field(strict=False, max_length=MOST_ELEMENTS)] = ()
    """What stands on the ground, a table `[[course]]` for each element."""
    event: Annotated[tuple[Event, ...], Field(strict=False, max_length=MOST_EVENTS)] = ()
    """What happens on the way, a table `[[event]]` for each."""
    physics: Physics = Physics()
    """What of the physics is other than usual."""
    sensors: Sensors = Sensors()
    """Which senses have their noise."""
    navigation: Navigation = Navigation()
    """Which components navigate, and their parameters."""
    expect: Expect = Expect()
    """What makes a run pass."""

    _path: Path | None = PrivateAttr(default=None)
    _set_keys: SetKeys = PrivateAttr(default=SetKeys())
    _written: "Scenario | None" = PrivateAttr(default=None)
    _scale: Scale = PrivateAttr(default=Scale())

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
    def set_keys(self) -> SetKeys:
        """The keys of the overrides that it was read with."""
        return self._set_keys

    @property
    def folder(self) -> Path:
        """The folder in which the files that it names lie."""
        return Path.cwd() if self._path is None else self._path.parent

    @property
    def scale(self) -> Scale:
        """By what all but the course was multiplied, to which `scale_to_robot` had it fitted."""
        return self._scale

    @property
    def written(self) -> "Scenario":
        """The scenario before anything of it was multiplied; itself where nothing was."""
        return self if self._written is None else self._written

    def configuration(self) -> dict[str, Any]:
        """Return everything as it is run, as plain data: what `result.json` holds.

        Of a scenario that was fitted to a robot in the lengths in which it was written: with
        `scale_to_robot` they mean the same when they are read again.
        """
        return self.written.model_dump(mode="json", by_alias=True)
