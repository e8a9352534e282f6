"""The core's parameters, each with default, unit, bounds, meaning and source."""

import json
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any

from treadwell import _core
from treadwell.components import RENAMED
from treadwell.errors import InputError
from treadwell.scenario.messages import nearest

if TYPE_CHECKING:
    from treadwell.robot.load import Robot


@dataclass(frozen=True, slots=True)
class Parameter:
    """One setting of the core.

    Attributes:
        key: dotted, as in `navigation.fog.cell`.
        default: what it has where nobody says.
        unit: SI; `1` for a pure number, `-` for what is no number.
        bounds: what is allowed, in words.
        meaning: a sentence.
        source: paper and equation, where it comes from one.
        owner: whose it is (`camera`, `sensor`, `world`, `numerics`), where it does not follow the
            robot's scale though its unit has a length or a time; a camera's noise in 1/m goes
            with its focal length and baseline.
        scales: whether its default follows the robot's scale.
        tuning: whether it stands under `tuning`, where few will want to turn it.
    """

    key: str
    default: Any
    unit: str
    bounds: str
    meaning: str
    source: str | None
    owner: str | None
    scales: bool
    tuning: bool


@dataclass(frozen=True, slots=True)
class ParameterTable:
    """A table of settings, as in `[navigation.fog]`.

    Attributes:
        key: `navigation.fog`, `gait` of robot.toml, or `costs.limits` of a function.
        about: what it is for.
        parameters: in the order of the code.
        schema: JSON schema of the table.
    """

    key: str
    about: str
    parameters: tuple[Parameter, ...]
    schema: dict[str, Any]

    @property
    def name(self) -> str:
        """The last word of the key."""
        return self.key.rpartition(".")[2]


@cache
def all_tables(robot: "Robot | None" = None) -> tuple[ParameterTable, ...]:
    """Return all tables, the components' and those of the stages that are not chosen by name.

    Args:
        robot: whose defaults; None: `qrio`'s size, and no robot's own.
    """
    tables = []
    description = None if robot is None else json.dumps(robot.description())
    for told in json.loads(_core.parameters(description)):
        rows = []
        for row in told["parameters"]:
            row.pop("schema")
            rows.append(Parameter(**row))
        tables.append(ParameterTable(told["key"], told["about"], tuple(rows), told["schema"]))
    return tuple(sorted(tables, key=lambda table: table.key))


def find_parameters(name: str | None = None, robot: "Robot | None" = None) -> list[Parameter]:
    """Return the parameters of a table, of what stands within it, or of all.

    Args:
        name: a component's or stage's (`fog`), or the beginning of a dotted key.
        robot: whose defaults: those that follow its scale, and over them its own; None: `qrio`'s
            size, and no robot's own.

    Raises:
        InputError: there is nothing of that name; the message says which tables there are.
    """
    every = [_of_robot(row, robot) for table in all_tables(robot) for row in table.parameters]
    if name is None:
        return every
    first, dot, rest = name.partition(".")
    dotted = next((table.key for table in all_tables() if table.name == first), first) + dot + rest
    found = [row for row in every if row.key == dotted or row.key.startswith(f"{dotted}.")]
    if not found and first in RENAMED:
        raise InputError(f"NAME: {first} is called {RENAMED[first]} now")
    if not found:
        names = [table.name for table in all_tables()]
        raise InputError(
            f"NAME: there are no parameters of {name!r}{nearest(name, names, first=True)}"
            f"allowed are {', '.join(names)}, and the beginning of a key"
        )
    return found


def _of_robot(row: Parameter, robot: "Robot | None") -> Parameter:
    """Return a parameter with what the robot's file says of it."""
    if robot is None:
        return row
    said: Any = {"gait": robot.file.gait, "navigation": robot.file.navigation}
    for word in row.key.split("."):
        if not isinstance(said, dict) or word not in said:
            return row
        said = said[word]
    return replace(row, default=said)
