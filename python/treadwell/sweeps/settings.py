"""Settings of a sweep as Python has them, as the texts `KEY=VALUE` of the command line."""

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from treadwell.components import CLASS_NAME, COMPONENTS
from treadwell.errors import InputError
from treadwell.scenario.messages import nearest, shown
from treadwell.scenario.overrides import Overrides, parse_setting

Vary = Sequence[str] | Mapping[str, Sequence[Any]]
"""`KEY=A,B,C` each, or a mapping of keys to the values that they take in turn."""

_PARTING = frozenset(",[]{}'\"")
"""Characters by which a list of values is taken apart."""


def setting_texts(overrides: Overrides, components: Mapping[str, object]) -> tuple[str, ...]:
    """Return settings as `KEY=VALUE`.

    Args:
        overrides: settings.
        components: classes of the user's by slot, as in `planner=MyPlanner`, or their names.

    Raises:
        InputError: there is no such slot, or a value cannot be a setting.
    """
    for slot in components:
        if slot not in COMPONENTS:
            raise InputError(
                f"{slot}: no such component; there are {', '.join(COMPONENTS)}"
                f"{nearest(slot, COMPONENTS)}"
            )
    if isinstance(overrides, str):
        raise InputError(f"overrides: found {shown(overrides)}; must be a list or a mapping")
    found = [f"{key}={_text(value, key)}" for key, value in _flat(overrides)]
    if not isinstance(overrides, Mapping):
        found = [str(setting) for setting in overrides or ()]
    of_slots = {f"navigation.{slot}": value for slot, value in components.items()}
    return (*found, *(f"{key}={_text(value, key)}" for key, value in of_slots.items()))


def vary_texts(vary: Vary) -> tuple[str, ...]:
    """Return what varies as `KEY=A,B,C`.

    Raises:
        InputError: a value cannot be a setting.
    """
    if isinstance(vary, str):
        raise InputError(f"vary: found {shown(vary)}; must be a list or a mapping")
    if not isinstance(vary, Mapping):
        return tuple(str(one) for one in vary)
    found = []
    for key, values in vary.items():
        if isinstance(values, str) or not isinstance(values, Sequence):
            raise InputError(f"vary: {key}: found {shown(values)}; must be a list of values")
        found.append(f"{key}={','.join(_text(value, key, alone=False) for value in values)}")
    return tuple(found)


def _flat(overrides: Overrides, before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield keys with dots, and their values that are no mappings."""
    if isinstance(overrides, Mapping):
        for key, value in overrides.items():
            if isinstance(value, Mapping) and value:
                yield from _flat(value, f"{before}{key}.")
            else:
                yield f"{before}{key}", value


def _text(value: object, key: str, *, alone: bool = True) -> str:
    """Return a value as TOML; a text as it is where that is read as the same text.

    Args:
        value: to be written.
        key: for the message.
        alone: whether it stands by itself; else commas part it from others.
    """
    if isinstance(value, type):
        return class_name(value, key)
    if isinstance(value, str):
        same = parse_setting(f"x={value}")[1] == value and value == value.strip() != ""
        parted = not alone and not _PARTING.isdisjoint(value)
        return value if same and not parted else _quoted(value)
    if hasattr(value, "item") and not isinstance(value, list | tuple):
        value = value.item()  # a number of NumPy's
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, list | tuple):
        inner = (_quoted(one) if isinstance(one, str) else _text(one, key) for one in value)
        return f"[{', '.join(inner)}]"
    if type(value).__module__ != "builtins":
        raise InputError(
            f"{key}: found an object of {type(value).__name__}; each episode makes its own, in "
            "another process: give the class, and its parameters as settings of its table"
        )
    raise InputError(f"{key}: found {shown(value)}; must be a number, text, list or class")


def _quoted(text: str) -> str:
    """Return a text as TOML; without a quote in it, at which others would take it for ended."""
    inner = json.dumps(text, ensure_ascii=False)[1:-1].replace('\\"', "\\u0022")
    return f'"{inner}"'.replace("\x7f", "\\u007f")


def class_name(kind: type, key: str) -> str:
    """Return `package.module:Class`, by which worker processes find a class.

    Raises:
        InputError: they could not.
    """
    module, name = kind.__module__, kind.__qualname__
    if module == "__main__":
        main = sys.modules["__main__"]
        where = "the program that runs" if hasattr(main, "__file__") else "a notebook or a prompt"
        raise InputError(
            f"{key}: {name} is defined in {where}, where worker processes do not find it: move it "
            f"into a file, my_parts.py say, and give 'my_parts:{kind.__name__}'"
        )
    if not CLASS_NAME.fullmatch(f"{module}:{name}"):
        raise InputError(
            f"{key}: {module}.{name} is defined within a function or a class, where worker "
            "processes do not find it: move it to the top of its module"
        )
    return f"{module}:{name}"
