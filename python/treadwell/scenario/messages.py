"""One clear line for each fault of a scenario: key, what was found, what is allowed."""

import difflib
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from pydantic import BaseModel
from pydantic_core import ErrorDetails

from treadwell.additions import known
from treadwell.components import COMPONENTS, RENAMED, parameter_names, parameter_tables
from treadwell.scenario.elements import ELEMENTS, MOVABLE
from treadwell.scenario.events import EVENTS
from treadwell.scenario.model import Expect, Goal, Navigation, Physics, Scenario, Sensors, Start
from treadwell.scenario.types import SetKeys
from treadwell.scenario.values import element_names

MOST_ERRORS: Final = 20
TABLES: Final[dict[str, type[BaseModel]]] = {
    "start": Start,
    "goal": Goal,
    "physics": Physics,
    "sensors": Sensors,
    "navigation": Navigation,
    "expect": Expect,
}
Path = tuple[str | int, ...]
MISSING: Final = object()
NOT_SET: Final = SetKeys()


def nearest(word: object, allowed: Iterable[str], *, first: bool = False) -> str:
    """Return "; did you mean 'x'?" for the most similar allowed word, or nothing.

    Args:
        word: what was found.
        allowed: words.
        first: a long list follows: what parts the two is there as well, also without a word.
    """
    if not isinstance(word, str):
        return "; " if first else ""
    found = difflib.get_close_matches(word[:100], list(allowed), n=1, cutoff=0.6)
    hint = f"; did you mean '{found[0]}'?" if found else ""
    return (f"{hint} " if hint else "; ") if first else hint


def shown(value: object, longest: int = 60) -> str:
    """Return a value as one short line, nearly as TOML writes it."""
    if isinstance(value, Mapping):
        return "a table"
    try:
        text = json.dumps(value) if isinstance(value, bool | str | list | tuple) else str(value)
    except (TypeError, ValueError, RecursionError):
        text = type(value).__name__
    return text if len(text) <= longest else text[: longest - 3] + "..."


def value_at(raw: object, path: Path) -> object:
    """Return what stands at a path of keys and indices, `MISSING` when nothing does."""
    for key in path:
        known = isinstance(raw, Mapping) and key in raw
        if isinstance(raw, list | tuple) and isinstance(key, int):
            known = 0 <= key < len(raw)
        if not known:
            return MISSING
        raw = raw[key]  # type: ignore[index]
    return raw


def dotted(path: Path, raw: Mapping[str, Any]) -> str:
    """Return the dotted key of a path; an element of the course goes by its name."""
    words = [f'"{key}"' if "." in str(key) or not str(key) else str(key) for key in path]
    if len(path) > 1 and path[0] == "course" and isinstance(path[1], int):
        course = raw.get("course")
        if isinstance(course, list) and all(isinstance(item, Mapping) for item in course):
            words[1] = element_names(course)[path[1]]
    return shortened(".".join(words))


def shortened(text: str, longest: int = 120) -> str:
    """Return a text without control characters, cut where it is too long."""
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def describe_in(name: str, model: type[BaseModel], error: ErrorDetails, raw: object) -> str:
    """Return the line for one of pydantic's errors in a table that was validated alone.

    Args:
        name: of the table.
        model: of it.
        error: one entry of `ValidationError.errors()`.
        raw: what was validated.
    """
    nested: ErrorDetails = {**error, "loc": (name, *error["loc"])}
    return describe(nested, {name: raw}, {name: model})


def describe(
    error: ErrorDetails,
    raw: Mapping[str, Any],
    tables: Mapping[str, type[BaseModel]] = TABLES,
) -> str:
    """Return the line for one of pydantic's errors.

    Args:
        error: one entry of `ValidationError.errors()`.
        raw: what was validated.
        tables: those that it can have at its top.
    """
    kind, context = error["type"], error.get("ctx", {})
    path = _path_of(error, raw)
    if kind in {"union_tag_invalid", "union_tag_not_found"}:
        tag = str(context["discriminator"]).strip("'")
        path = (*path, tag)
        allowed: Mapping[str, type[BaseModel]] = EVENTS if tag == "do" else ELEMENTS
        if path[-2:-1] == ("element",):
            allowed = MOVABLE
        found = value_at(raw, path)
        text = f"must be one of {', '.join(allowed)}"
        return _line(path, raw, text + nearest(found, allowed))
    if kind == "extra_forbidden":
        return _unknown(path, raw, tables)
    if kind == "missing":
        return f"{dotted(path, raw)}: missing, it is required"
    text = error["msg"].replace("Input should be", "must be").replace("Value should", "must")
    text = text[:1].lower() + text[1:]
    if kind in {"model_type", "model_attributes_type", "dict_type"}:
        text = "must be a table"
    elif kind == "bool_type":
        text = "must be true or false"
    found = value_at(raw, path)
    if kind == "literal_error":
        text += nearest(
            found, str(context["expected"]).replace("'", "").replace(" or ", ", ").split(", ")
        )
    elif kind == "component":
        text = _component(found, text, known(context["among"]))
    elif kind == "string_pattern_mismatch":
        text = {
            "name": "must be up to 64 letters, digits, - or _ (an element's may have spaces, "
            "and starts with a letter)"
        }.get(str(path[-1]), "must be 1 to 255 characters, none of them a control character")
    return _line(path, raw, text)


def _unknown(path: Path, raw: Mapping[str, Any], tables: Mapping[str, type[BaseModel]]) -> str:
    key = dotted(path, raw)
    if path[:-1] == ("navigation",) and path[-1] in RENAMED:
        return f"{key}: is called navigation.{RENAMED[str(path[-1])]} now"
    allowed = _keys_at(path[:-1], raw, tables)
    return f"{key}: unknown key; allowed: {', '.join(allowed)}{nearest(path[-1], allowed)}"


def _component(found: object, text: str, allowed: Iterable[str]) -> str:
    new = RENAMED.get(found) if isinstance(found, str) else None
    return text + nearest(found, allowed) if new is None else f"is called '{new}' now"


def report(
    file: str,
    lines: Sequence[str],
    untold: int = 0,
    given: SetKeys = NOT_SET,
) -> str:
    """Return the one message for all that is wrong in a file, capped.

    Args:
        file: its name.
        lines: one for each fault.
        untold: further faults, which have no line.
        given: overrides: what is wrong with one of these is not the file's fault.
    """
    kept = list(lines[:MOST_ERRORS])
    more = len(lines) - len(kept) + untold
    if more:
        kept.append(f"and {more} more")
    return "\n".join(
        f"{given.word} {line.removeprefix(f'{given.word} ')} (over {file})"
        if _is_set(line, given)
        else f"{file}: {line}"
        for line in kept
    )


def _is_set(line: str, given: SetKeys) -> bool:
    """Say whether a line tells of an override: of its key, of what is in it, or of a new table."""
    if not given.word or line.startswith(f"{given.word} "):
        return bool(given.word)
    at = line.partition(" ")[0].rstrip(":")
    unknown = f"{at}: unknown key" in line
    return any(
        key == at or at.startswith(f"{key}.") or (unknown and key.startswith(f"{at}."))
        for key in given.keys
    )


def _line(path: Path, raw: Mapping[str, Any], text: str) -> str:
    found = value_at(raw, path)
    what = "nothing" if found is MISSING else shown(found)
    key = dotted(path, raw)
    return f"{key}: found {what}; {text}" if key else f"{text}; found {what}"


def _path_of(error: ErrorDetails, raw: Mapping[str, Any]) -> Path:
    """Return the error's place in the file: pydantic's location without the tags of unions."""
    path: Path = ()
    location = error["loc"]
    for i, key in enumerate(location):
        if value_at(raw, (*path, key)) is not MISSING or (
            i == len(location) - 1 and error["type"] == "missing"
        ):
            path = (*path, key)
    context = error.get("ctx", {})
    if context.get("key") is not None:
        path = (*path, context["key"])
    return (*path, *context.get("at", ()))


def _keys_at(
    path: Path, raw: Mapping[str, Any], tables: Mapping[str, type[BaseModel]]
) -> list[str]:
    """Return the keys that the table at a path can have."""
    model: type[BaseModel] | None = None
    extra: list[str] = []
    if path == ():
        model, extra = Scenario, ["vary"]
    elif path[0] == "navigation" and len(path) > 1:
        extra = parameter_names(*map(str, path[1:]))
    elif len(path) == 1:
        model = tables.get(str(path[0]))
        extra = [*parameter_tables(), *_classes(raw)] if path == ("navigation",) else []
    elif path[0] == "course" or path[-1] == "element":
        model = ELEMENTS.get(str(value_at(raw, (*path, "kind"))))
    elif path[0] == "event":
        model = EVENTS.get(str(value_at(raw, (*path, "do"))))
    fields = model.model_fields if model is not None else {}
    return [field.alias or name for name, field in fields.items()] + extra


def _classes(raw: Mapping[str, Any]) -> list[str]:
    """Return the names of the user's classes that take a slot: each may have a table."""
    table = raw.get("navigation")
    chosen = [table.get(slot) for slot in COMPONENTS] if isinstance(table, Mapping) else []
    return [name.rpartition(":")[2] for name in chosen if isinstance(name, str) and ":" in name]
