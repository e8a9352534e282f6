"""The command that runs an episode again, found from its configuration and checked by loading."""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import tomli_w

from treadwell.errors import InputError, TreadwellError
from treadwell.recording.scenario_file import NAME, origin_of, without_nothing
from treadwell.scenario.loading import load_scenario, scenario_names

_BARE: Final = re.compile(r"^[A-Za-z0-9_-]+$")
_FLAGS: Final = ("robot", "seed")
"""Keys that have an option of their own."""


@dataclass(frozen=True, slots=True)
class Repeat:
    """How to run an episode again.

    Attributes:
        words: the command, unquoted; empty where there is none.
        note: what to know of it, a sentence; empty where there is nothing.
    """

    words: tuple[str, ...]
    note: str = ""

    @property
    def command(self) -> str:
        """The command as it is typed into a shell."""
        return shlex.join(self.words)


def repeat_command(configuration: dict[str, Any], folder: Path) -> Repeat:
    """Return the command that runs a configuration again.

    The scenario's own name or file with what was set otherwise is tried first, then the run's
    `scenario.toml`. A command counts only when what it would run is the same configuration.

    Args:
        configuration: of a `result.json`.
        folder: the run's.
    """
    name = configuration.get("name")
    sources = [str(name)] if name in scenario_names() else []
    origin = origin_of(folder / NAME)
    if origin is not None and origin.is_file():
        sources.append(origin.stem if _is_shipped(origin) else str(origin))
    # Not made absolute: a folder of runs is copied elsewhere with its reports.
    sources.append(str(folder / NAME))
    for source in dict.fromkeys(sources):
        words = _words(source, configuration)
        if words is not None:
            return Repeat(words)
    note = (
        f"neither {name} nor {folder / NAME} gives this configuration any more: the scenario's "
        "file has changed or is gone, or it names files that lie elsewhere"
    )
    return Repeat((), note)


def _is_shipped(path: Path) -> bool:
    from treadwell.data import data_folder

    try:
        return path.resolve().parent == data_folder("scenarios").resolve()
    except (OSError, TreadwellError):
        return False


def _words(source: str, wanted: dict[str, Any]) -> tuple[str, ...] | None:
    """Return the command by this source; None where it cannot give the configuration."""
    seed, robot = wanted.get("seed"), wanted.get("robot")
    if not isinstance(seed, int) or not isinstance(robot, str):
        return None
    try:
        plain = load_scenario(source, seed=seed).configuration()
        other = robot if plain["robot"] != robot else None
        settings = list(_settings(plain, wanted))
        made = load_scenario(source, robot=other, seed=seed, overrides=settings)
        same = made.configuration() == wanted
    except (InputError, ValueError, TypeError):
        return None
    if not same:
        return None
    robots = () if other is None else ("--robot", other)
    sets = [word for setting in settings for word in ("--set", setting)]
    return ("treadwell", "run", source, *robots, "--seed", str(seed), *sets)


def _settings(plain: dict[str, Any], wanted: dict[str, Any]) -> Iterator[str]:
    """Yield `KEY=VALUE` for what is set otherwise, as deep as TOML allows."""
    for key in wanted:
        if key not in (*_FLAGS, "schema") and wanted[key] != plain.get(key):
            yield from _deeper((key,), plain.get(key), wanted[key])


def _deeper(key: tuple[str, ...], plain: Any, wanted: Any) -> Iterator[str]:  # noqa: ANN401
    """Yield the settings that turn one value into another."""
    if isinstance(plain, dict) and isinstance(wanted, dict):
        changed = [k for k in {**plain, **wanted} if plain.get(k) != wanted.get(k)]
        # What has to become nothing can only be left out of a whole table.
        if all(wanted.get(k) is not None for k in changed):
            for k in changed:
                yield from _deeper((*key, k), plain.get(k), wanted[k])
            return
    elif isinstance(plain, list) and isinstance(wanted, list) and _are_tables(plain, wanted):
        for index, (old, new) in enumerate(zip(plain, wanted, strict=True)):
            if old != new:
                yield from _deeper((*key, str(index)), old, new)
        return
    if wanted is not None:
        words = (word if _BARE.match(word) else f'"{word}"' for word in key)
        yield f"{'.'.join(words)}={_toml(without_nothing(wanted))}"


def _are_tables(plain: list[Any], wanted: list[Any]) -> bool:
    return len(plain) == len(wanted) and all(isinstance(x, dict) for x in (*plain, *wanted))


def _toml(value: Any) -> str:  # noqa: ANN401 - any JSON
    """Return a value as TOML on one line."""
    if isinstance(value, dict):
        pairs = (f"{_quoted(key)} = {_toml(item)}" for key, item in value.items())
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip("\n")


def _quoted(key: str) -> str:
    return key if _BARE.match(key) else tomli_w.dumps({key: 0}).removesuffix(" = 0\n")
