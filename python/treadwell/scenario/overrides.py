"""What changes a scenario before it is read: `--set KEY=VALUE` and the draws of `[vary]`."""

import tomllib
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Annotated, Any, Final, Self

import numpy as np
from pydantic import Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from treadwell.errors import InputError
from treadwell.scenario.messages import Path, describe, nearest, shortened, shown
from treadwell.scenario.types import Table
from treadwell.scenario.values import element_names

MOST_DRAWS = 100
LONGEST_SETTING = 10_000
DEEPEST: Final = 100
"""Tables within each other."""
Overrides = Sequence[str] | Mapping[str, Any] | None
"""Settings `KEY=VALUE`; or keys, dotted or as tables within tables, with their values."""
Number = Annotated[float, Field(ge=-1e6, le=1e6)]
Pair = Annotated[tuple[Number, Number], Field(strict=False)]


class Draw(Table):
    """One entry of `[vary]`: what a key is drawn from."""

    uniform: Pair | None = None
    """Lower and upper end."""
    normal: Pair | None = None
    """Mean and standard deviation."""
    choice: Annotated[list[Any], Field(min_length=1, max_length=1000)] | None = None
    """Values, one of which is taken."""

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if sum(value is not None for value in (self.uniform, self.normal, self.choice)) != 1:
            raise PydanticCustomError("draw", "must be one of uniform, normal, choice")
        if self.uniform is not None and self.uniform[0] > self.uniform[1]:
            raise PydanticCustomError(
                "draw", "must be the lower and then the upper end", {"key": "uniform"}
            )
        if self.normal is not None and self.normal[1] < 0.0:
            raise PydanticCustomError(
                "draw", "must be a mean and a standard deviation of 0 or more", {"key": "normal"}
            )
        return self

    def sample(self, seed: int, key: str) -> object:
        """Return the value for a seed: each key has its own generator, so none disturbs another."""
        generator = np.random.default_rng([seed, zlib.crc32(key.encode())])
        if self.uniform is not None:
            return float(generator.uniform(*self.uniform))
        if self.normal is not None:
            return float(generator.normal(*self.normal))
        return (self.choice or [None])[int(generator.integers(len(self.choice or [None])))]


def split_key(key: str) -> list[str]:
    """Return the words of a dotted key; a word in double quotes may hold dots."""
    words, word, quoted = [], "", False
    for character in key:
        if character == '"':
            quoted = not quoted
        elif character == "." and not quoted:
            words.append(word.strip())
            word = ""
        else:
            word += character
    words.append(word.strip())
    if quoted or not all(words):
        raise InputError(
            f"{shortened(key) or 'the key'}: found {shown(key)}; "
            "must be words with dots between them"
        )
    return words


def read_overrides(overrides: Overrides) -> list[tuple[str, Any]]:
    """Return dotted key and value of each override.

    Args:
        overrides: a sequence of `KEY=VALUE`, as `--set` takes them; or a mapping, as in
            `{"navigation.fog.cell": 0.05}` or `{"navigation": {"fog": {"cell": 0.05}}}`. One
            setting alone may be a string.

    Raises:
        InputError: one has no key, or a value that no scenario can have.
    """
    if isinstance(overrides, Mapping):
        return list(_flat(overrides, ()))
    listed = (overrides,) if isinstance(overrides, str) else (overrides or ())
    for setting in listed:
        if not isinstance(setting, str):
            raise InputError(
                f"overrides: found {shown(setting)}; must be KEY=VALUE, or all a mapping of keys "
                "to values"
            )
    return [parse_setting(setting) for setting in listed]


def mentioned(overrides: Overrides) -> str:
    """Return what an error calls overrides: as they were given."""
    return "overrides" if isinstance(overrides, Mapping) else "--set"


def with_settings(overrides: Overrides, settings: Mapping[str, str]) -> Overrides:
    """Return overrides with further settings behind them, which beat them."""
    if isinstance(overrides, Mapping):
        return {**overrides, **settings}
    listed = (overrides,) if isinstance(overrides, str) else (overrides or ())
    return (*listed, *(f"{key}={value}" for key, value in settings.items()))


def _flat(table: Mapping[Any, Any], path: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    """Yield dotted key and value of what stands in a table, and in the tables within it."""
    if len(path) > DEEPEST:
        raise InputError("overrides: nested too deep")
    for key, value in table.items():
        if not isinstance(key, str):
            raise InputError(f"overrides: found the key {shown(key)}; must be a text")
        in_vary = path == ("vary",)  # its keys are dotted ones, each with a table
        words = (*path, *((key,) if in_vary else split_key(key)))
        if isinstance(value, Mapping) and not in_vary:
            yield from _flat(value, words)
        else:
            dotted = ".".join(f'"{word}"' if "." in word else word for word in words)
            yield dotted, _plain(value, shortened(dotted), 0)


def plain_number(value: object) -> object:
    """Return a number of numpy's as Python's own, and anything else as it is."""
    return value.item() if isinstance(value, np.number) else value


def _plain(value: object, key: str, depth: int) -> object:
    """Return a value as TOML could have it."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, PurePath):
        return str(value)
    if depth > DEEPEST:
        raise InputError(f"overrides: {key}: nested too deep")
    if isinstance(value, list | tuple):
        return [_plain(item, key, depth + 1) for item in value]
    if isinstance(value, Mapping):
        return {str(name): _plain(item, key, depth + 1) for name, item in value.items()}
    kind = f"the class {value.__name__}" if isinstance(value, type) else type(value).__name__
    raise InputError(
        f"overrides: {key}: found {kind}; must be a number, a text, true or false, or a list or "
        "mapping of these"
    )


def parse_setting(setting: str) -> tuple[str, Any]:
    """Return key and value of `KEY=VALUE`: the value as TOML, as a string where that fails.

    Raises:
        InputError: there is no `=` or no key.
    """
    key, equals, text = setting.partition("=")
    if not equals or not key.strip():
        raise InputError(f"--set: found {shown(setting)}; must be KEY=VALUE")
    if len(setting) > LONGEST_SETTING:
        raise InputError(f"--set {shortened(key)}: longer than {LONGEST_SETTING} characters")
    try:
        table = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return key.strip(), text
    return key.strip(), table["value"] if table.keys() == {"value"} else text


def assign(raw: dict[str, Any], key: str, value: object) -> None:
    """Put a value at a dotted key, in place; elements of lists go by index or name.

    Raises:
        InputError: the key leads through something that is neither a table nor a list, or to an
            element that does not exist.
    """
    words = split_key(key)
    place: Any = raw
    for depth, word in enumerate(words):
        last = depth == len(words) - 1
        if isinstance(place, dict):
            if last:
                place[word] = value
            else:
                place = place.setdefault(word, {})
        elif isinstance(place, list):
            index = _index(place, word, key)
            if last:
                place[index] = value
            else:
                place = place[index]
        else:
            parent = ".".join(words[:depth])
            raise InputError(
                f"{shortened(key)}: {shortened(parent)} is {shown(place)}, not a table or a list"
            )


def _index(place: list[Any], word: str, key: str) -> int:
    """Return the index that a word means in a list: a number, or an element's name."""
    if word.isascii() and word.isdigit():
        if len(word) < 10 and int(word) < len(place):
            return int(word)
        raise InputError(
            f"{shortened(key)}: found index {shortened(word)}; "
            f"there are {len(place)} entries, counted from 0"
        )
    names = element_names(place) if all(isinstance(item, Mapping) for item in place) else []
    if word in names:
        return names.index(word)
    allowed = f"one of {', '.join(names[:30])} or an index" if names else "an index"
    raise InputError(
        f"{shortened(key)}: found {shown(word)}; must be {allowed}{nearest(word, names)}"
    )


def apply_draws(raw: dict[str, Any], seed: int) -> list[str]:
    """Take `[vary]` out of a scenario and put what it draws in place.

    Args:
        raw: the file's tables, changed in place.
        seed: the episode's seed.

    Returns:
        A line for each thing that is wrong.
    """
    table = raw.pop("vary", {})
    if not isinstance(table, dict) or len(table) > MOST_DRAWS:
        return [f"vary: found {shown(table)}; must be a table of up to {MOST_DRAWS} entries"]
    lines = []
    for key, entry in table.items():
        try:
            value = Draw.model_validate(entry).sample(seed, key)
            assign(raw, key, value)
        except ValidationError as error:
            path: Path = ("vary", key)
            for detail in error.errors(include_url=False):
                detail["loc"] = (*path, *detail["loc"])
                lines.append(describe(detail, {"vary": table}))
        except InputError as error:
            lines.append(f'vary."{error}'.replace(":", '":', 1))
    return lines
