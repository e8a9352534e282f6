"""Reading a `robot.toml`, and a line for each thing that is wrong with it."""

from pathlib import Path
from types import NoneType
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from treadwell.errors import InputError
from treadwell.robot.file import RobotFile
from treadwell.scenario.loading import read_toml
from treadwell.scenario.messages import nearest, shown


def read_robot_file(path: Path) -> RobotFile:
    """Read and check a `robot.toml`.

    Raises:
        InputError: the file is missing, no TOML, or does not have the form above.
    """
    table = read_toml(path)
    try:
        return RobotFile.model_validate(table)
    except ValidationError as error:
        raise InputError("\n".join(_lines(path, error))) from error
    except RecursionError:
        raise InputError(f"{path}: nested too deep") from None


def required_keys() -> list[str]:
    """Return a line for each table that a `robot.toml` needs, with the keys that it must have."""
    lines = []
    for name, field in RobotFile.model_fields.items():
        if field.is_required():
            lines.append(f"{name}: is needed{_needs(field.annotation)}")
    return lines


def _needs(annotation: object) -> str:
    if not (isinstance(annotation, type) and issubclass(annotation, BaseModel)):
        return ", a table of tables"
    keys = [key for key, field in annotation.model_fields.items() if field.is_required()]
    return f", with {', '.join(keys)}"


def _lines(path: Path, error: ValidationError) -> list[str]:
    """Return a line for each thing that is wrong: the file, the key, what it is and was."""
    lines = []
    for item in error.errors():
        key = ".".join(str(part) for part in item["loc"])
        message = item["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
        found = (
            "" if isinstance(item["input"], dict | BaseModel) else f", got {shown(item['input'])}"
        )
        if item["type"] == "extra_forbidden":
            allowed = _allowed(item["loc"][:-1])
            hint = nearest(item["loc"][-1], allowed)
            message, found = f"unknown key; allowed are {', '.join(allowed)}{hint}", ""
        elif item["type"] == "missing":
            message, found = "is missing", ""
        lines.append(f"{path}: {key}: {message}{found}")
    return lines


def _allowed(place: tuple[int | str, ...]) -> list[str]:
    """Return the keys of the table at a place of the file."""
    table: Any = RobotFile
    for part in place:
        if isinstance(table, type) and issubclass(table, BaseModel):
            field = table.model_fields.get(str(part))
            table = None if field is None else field.annotation
        else:  # a table of tables, named as one likes
            table = next(iter(reversed(get_args(table))), None)
        # What may be left out: its type stands before None.
        choices = [kind for kind in get_args(table) if kind is not NoneType]
        if table is not None and NoneType in get_args(table):
            table = choices[0]
    if isinstance(table, type) and issubclass(table, BaseModel):
        return list(table.model_fields)
    return []
