"""Reading a scenario: find the file, read it, apply flags, settings and draws, check everything."""

import re
import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from treadwell.data import data_folder, robot_names
from treadwell.data import scenario_names as scenario_names
from treadwell.errors import InputError
from treadwell.files import opened, read_content
from treadwell.scenario.elements import named_file
from treadwell.scenario.events import Add
from treadwell.scenario.messages import describe, dotted, nearest, report, shortened, shown
from treadwell.scenario.model import SEEDS, Scenario
from treadwell.scenario.overrides import (
    Overrides,
    apply_draws,
    assign,
    mentioned,
    plain_number,
    read_overrides,
    split_key,
)
from treadwell.scenario.types import SetKeys

LARGEST_FILE: Final = 1_000_000
"""Bytes of a scenario file."""
LARGEST_ASSET: Final = 50_000_000
"""Bytes of a mesh or an MJCF file."""
LARGEST_MAP: Final = 500_000_000
"""Bytes of an octree's file, as the core has it."""
LONGEST_KEY: Final = 100
"""Words of a dotted key."""
MOST_DETAILS: Final = 1000
"""Faults of a file that are looked into: each costs time."""
_TEXT_OR_COMMENT: Final = re.compile(
    rb"""(?s:\"{3}(?:[^\\]|\\.)*?(?:\"{3,5}|\Z)|'{3}.*?(?:'{3,5}|\Z))"""
    rb"""|"(?:[^"\\\n]|\\.)*"?|'[^'\n]*'?|#[^\n]*"""
)
"""What TOML reads as one; each branch takes what it began with, so that time grows with length."""
_AROUND_DOT: Final = re.compile(rb"[ \t]*\.[ \t]*")
_BETWEEN_KEYS: Final = re.compile(rb"[\s,=\[\]{}]+")
SUFFIXES: Final = {"mesh": (".stl", ".obj"), "mjcf": (".xml", ".mjcf"), "terrain": (".png",)}
MAP_SUFFIXES: Final = (".bt", ".ot")


def load_scenario(
    name_or_path: str | Path,
    *,
    robot: str | Path | None = None,
    seed: int | None = None,
    overrides: Overrides = (),
) -> Scenario:
    """Return a scenario, ready to run.

    An explicit `robot` or `seed` beats `overrides`, which beat the file and its `[vary]`.

    Args:
        name_or_path: a path, or the name of a file that ships with the package.
        robot: a robot's name or folder, instead of the file's. A folder is looked for from the
            working folder, as one of `overrides`; the file's own from the file's folder.
        seed: instead of the file's; the draws of `[vary]` depend on it.
        overrides: settings `KEY=VALUE`, as `--set` takes them, or a mapping of keys to values.

    Raises:
        InputError: with one message that names everything that is wrong.
    """
    path = find_scenario(name_or_path)
    raw = read_toml(path)
    _add_course(raw, path)
    settings = read_overrides(overrides)
    lines = _apply(raw, settings, mentioned(overrides), robot=robot, seed=seed)
    asked = robot is not None or any(split_key(key)[0] == "robot" for key, _ in settings)
    fault = _place_robot(raw, None if asked else path.parent)
    given = SetKeys(mentioned(overrides), tuple(key for key, _ in settings))
    scenario, untold = None, 0
    try:
        scenario = Scenario.model_validate(raw)
    except ValidationError as error:
        details = error.errors(include_url=False)
        lines += list(dict.fromkeys(describe(detail, raw) for detail in details[:MOST_DETAILS]))
        untold = max(0, len(details) - MOST_DETAILS)
    except RecursionError:
        lines.append("nested too deep")
    if scenario is not None:
        scenario._path, scenario._set_keys = path, given
        lines += [*([fault] if fault else []), *_check_files(scenario, raw)]
    if scenario is None or lines:
        raise InputError(report(str(path), lines, untold, given))
    return scenario


def find_scenario(name_or_path: str | Path) -> Path:
    """Return the file: a path is tried first, then the folder that ships with the package.

    Raises:
        InputError: neither has it.
    """
    text = str(name_or_path)
    try:
        path = Path(text)
        if path.is_file():
            return path
        exists = path.exists()
    except (OSError, ValueError):
        raise InputError(f"{shortened(text)}: not a file's name") from None
    names = scenario_names()
    stem = text.removesuffix(".toml")
    if stem in names:
        return data_folder("scenarios") / f"{stem}.toml"
    if exists:
        raise InputError(
            f"{shortened(text)}: found something that is not a file; "
            "must be a scenario file or a scenario's name"
        )
    raise InputError(
        f"{shortened(text)}: no such file or scenario{nearest(stem, names, first=True)}"
        f"scenarios: {', '.join(names)}"
    )


def read_toml(path: Path) -> dict[str, Any]:
    """Return a file's tables.

    Raises:
        InputError: too large, unreadable, not UTF-8 or not TOML; with the line.
    """
    content = read_content(path, LARGEST_FILE)
    if _longest_key(content) > LONGEST_KEY:
        # The parser takes minutes for one of some thousands.
        raise InputError(f"{path}: nested too deep: a key of more than {LONGEST_KEY} words")
    try:
        return tomllib.loads(content.decode())
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}: line {line}: not UTF-8, which TOML must be") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not TOML: {shortened(str(error), 300)}") from None
    except ValueError as error:
        raise InputError(f"{path}: a value out of range: {shortened(str(error), 300)}") from None
    except RecursionError:
        raise InputError(f"{path}: nested too deep") from None


def _longest_key(content: bytes) -> int:
    """Return how many words the longest dotted key of a TOML text has; or the longest number."""
    bare = _TEXT_OR_COMMENT.sub(lambda part: b"" if part[0].startswith(b"#") else b"t", content)
    words = _BETWEEN_KEYS.split(_AROUND_DOT.sub(b".", bare))
    return 1 + max(word.count(b".") for word in words)


def _add_course(raw: dict[str, Any], path: Path) -> None:
    """Put the course of the file that `course_of` names before the scenario's own, in place.

    Raises:
        InputError: it names no scenario file beside this one, or one that cannot be read.
    """
    if "course_of" not in raw:
        return
    file = raw.pop("course_of")
    fault = "must be a file's name"
    if isinstance(file, str):
        fault = asset_fault(path.parent, file, (".toml",))
    if fault:
        raise InputError(f"{path}: course_of: found {shown(file)}; {fault}")
    other = read_toml(path.parent / file)
    own, shared = raw.get("course", []), other.get("course", [])
    if isinstance(own, list) and isinstance(shared, list):
        raw["course"] = [*shared, *own]
    if "course_of" in other:
        raise InputError(f"{path}: course_of: {file} has no course of its own but another's")


def _apply(
    raw: dict[str, Any],
    settings: Sequence[tuple[str, Any]],
    word: str,
    *,
    robot: str | Path | None,
    seed: int | None,
) -> list[str]:
    """Apply settings, draws and flags in place, in the order of their rank."""
    early = {i for i, (key, _) in enumerate(settings) if _first_word(key) in {"seed", "vary"}}
    lines: list[str] = []

    def assign_all(indices: Sequence[int]) -> None:
        for i in indices:
            try:
                assign(raw, *settings[i])
            except InputError as error:
                lines.append(f"{word} {error}")

    assign_all(sorted(early))
    if seed is not None:
        raw["seed"] = plain_number(seed)
    drawn_from = raw.get("seed", 0)
    usable = isinstance(drawn_from, int) and not isinstance(drawn_from, bool)
    lines += apply_draws(raw, drawn_from if usable and 0 <= drawn_from < SEEDS else 0)
    assign_all([i for i in range(len(settings)) if i not in early])
    if robot is not None:
        raw["robot"] = str(robot)
    return lines


def _place_robot(raw: dict[str, Any], folder: Path | None) -> str:
    """Make a robot's folder absolute in place, so that what is written of the run finds it, too.

    Args:
        raw: the file's tables.
        folder: from where it is looked for; None: the working folder, and what is not there is
            left as it is.

    Returns:
        What is wrong with it, a line; nothing where all is well or will be told otherwise.
    """
    text = raw.get("robot")
    names = robot_names()
    if not isinstance(text, str) or not text or text in names:
        return ""
    place = (folder or Path()) / text
    with suppress(OSError, RuntimeError, ValueError):  # what no folder can be called
        if (place / "robot.toml").is_file():
            raw["robot"] = str(place.resolve())
            return ""
    if folder is None:
        return ""
    return (
        f"robot: found {shown(text)}; must be one of {', '.join(names)}, or the path of a robot's "
        f"folder from this file's: there is no {shortened(str(place / 'robot.toml'))}"
        f"{nearest(text, names)}"
    )


def _first_word(key: str) -> str:
    try:
        return split_key(key)[0]
    except InputError as error:
        raise InputError(f"--set {error}") from None


def _check_files(scenario: Scenario, raw: dict[str, Any]) -> list[str]:
    """Return a line for each file that an element names and that cannot be used."""
    elements = [(("course", i), element) for i, element in enumerate(scenario.course)]
    lines = []
    added = [
        (("event", i, "element"), event.element)
        for i, event in enumerate(scenario.event)
        if isinstance(event, Add)
    ]
    for path, element in [*elements, *added]:
        file = named_file(element)
        if file is not None:
            fault = asset_fault(scenario.folder, file, SUFFIXES[element.kind])
            if fault:
                key = dotted((*path, "file"), raw)
                lines.append(f"{key}: found {shown(file)}; {fault}")
    told = scenario.navigation.parameters().get("static_map")
    fault = map_file_fault(told, scenario.folder) if isinstance(told, dict) else ""
    return [*lines, fault] if fault else lines


def map_file_fault(told: Mapping[str, object], folder: Path) -> str:
    """Return what is wrong with the file of `[navigation.static_map]`, nothing where it has none.

    Args:
        told: the table.
        folder: the scenario file's.
    """
    if "file" not in told:
        return ""
    key, file = "navigation.static_map.file", told["file"]
    if not isinstance(file, str):
        return f"{key}: found {shown(file)}; a file's name is needed"
    if "resolution" in told:
        return f"{key}: found {shown(file)} and a resolution; a map from a file has its own"
    fault = asset_fault(folder, file, MAP_SUFFIXES, LARGEST_MAP)
    return f"{key}: found {shown(file)}; {fault}" if fault else ""


def asset_fault(
    folder: Path, file: str, suffixes: Sequence[str], most_bytes: int = LARGEST_ASSET
) -> str:
    """Return what is wrong with a file that a scenario names, nothing when it can be used.

    Args:
        folder: the scenario file's folder; the file must lie in it, links followed.
        file: as the scenario has it.
        suffixes: what its name may end in.
        most_bytes: that it may have.
    """
    try:
        resolved = (folder / file).resolve()
        if not resolved.is_relative_to(folder.resolve()):
            return "must lie in the scenario file's folder"
        if resolved.suffix.lower() not in suffixes:
            return f"must end in {' or '.join(suffixes)}"
        if not resolved.is_file():
            return f"there is no such file in {folder}"
        if resolved.stat().st_size > most_bytes:
            return f"must be at most {most_bytes} bytes"
        opened(resolved).close()
    except (InputError, OSError, RuntimeError, ValueError) as error:
        return f"cannot be read: {shortened(str(error))}"
    return ""
