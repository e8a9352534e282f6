"""Plain values in a scenario: parameters that go through to the core, and names for elements."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from treadwell.components import parameter_names
from treadwell.errors import InputError

DEEPEST = 8
LONGEST = 10_000


def check_parameters(value: object, where: tuple[str | int, ...]) -> None:
    """Check a component's table: plain, finite, not too deep; what it means the core knows.

    Args:
        value: the table, as TOML gave it.
        where: its key below `[navigation]`.

    Raises:
        PydanticCustomError: with the key of what is wrong.
    """
    if len(where) == 1 and not isinstance(value, dict):
        raise PydanticCustomError("parameters", "must be a table", {"at": where})
    if len(where) > DEEPEST:
        raise PydanticCustomError("parameters", "must not be nested so deep", {"at": where})
    if isinstance(value, dict | list):
        if len(value) > LONGEST:
            raise PydanticCustomError("parameters", "must not be so long", {"at": where})
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        for key, item in pairs:
            check_parameters(item, (*where, key))
    elif isinstance(value, float) and not math.isfinite(value):
        raise PydanticCustomError("parameters", "must be a finite number", {"at": where})
    elif isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise PydanticCustomError("parameters", "must fit in 64 bits", {"at": where})
    elif not isinstance(value, bool | int | float | str):
        raise PydanticCustomError(
            "parameters", "must be a number, a string, a boolean, a list or a table", {"at": where}
        )


def flag(name: str, value: object) -> bool:
    """Return an argument of Python's that is True or False; what is only like it may mean either.

    Raises:
        InputError: it is neither.
    """
    if not isinstance(value, bool | np.bool_):
        raise InputError(f"{name}: found {value!r}; must be True or False")
    return bool(value)


def check_names(table: Mapping[str, Any], where: tuple[str, ...]) -> None:
    """Check the keys of a component's table: of what no component reads nobody else does.

    Args:
        table: the table, as TOML gave it.
        where: its key below `[navigation]`.

    Raises:
        PydanticCustomError: with the first key that the component does not have.
    """
    names = parameter_names(*where)
    for key, value in table.items():
        if key not in names:
            raise PydanticCustomError("extra_forbidden", "unknown key", {"at": (*where, key)})
        if isinstance(value, Mapping) and parameter_names(*where, key):
            check_names(value, (*where, key))


def element_names(elements: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return a name for each element: its own, or its kind, and from the second on with a number.

    Three unnamed boxes are `box`, `box 2` and `box 3`. A name that is taken is passed over.

    Args:
        elements: tables with `kind` and perhaps `name`, in the order of the file.
    """
    taken = {str(element["name"]) for element in elements if element.get("name") is not None}
    names: list[str] = []
    counts: dict[str, int] = {}
    for element in elements:
        if element.get("name") is not None:
            names.append(str(element["name"]))
            continue
        kind = str(element.get("kind", "element"))
        while True:
            counts[kind] = counts.get(kind, 0) + 1
            name = kind if counts[kind] == 1 else f"{kind} {counts[kind]}"
            if name not in taken:
                break
        taken.add(name)
        names.append(name)
    return names
