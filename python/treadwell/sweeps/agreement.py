"""What a sweep that goes on has to have in common with what was asked for before."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.files import read_text
from treadwell.sweeps.request import SCHEMA

LARGEST = 500_000_000
"""Bytes of `sweep.json` and of `results.json`."""


@dataclass(frozen=True, slots=True)
class Edited:
    """A class in Python that was edited since a sweep began.

    Attributes:
        name: `package.module:Class`.
        again: episodes that ran with it, which are run again.
        kept: episodes of the sweep that are not run again.
        place: where the rows and recordings of the former are.
    """

    name: str
    again: int
    kept: int
    place: Path

    @property
    def sentence(self) -> str:
        """What a user is told of it."""
        return (
            f"{self.name} was edited: {_episodes(self.again)} with it "
            f"{'is' if self.again == 1 else 'are'} run again, {self.kept} "
            f"{'is' if self.kept == 1 else 'are'} kept; what was there is in {self.place}"
        )


def _episodes(count: int) -> str:
    return "1 episode" if count == 1 else f"{count} episodes"


def read_asked(file: Path) -> dict[str, Any]:
    """Return what a `sweep.json` holds.

    Raises:
        InputError: it is no such file.
    """
    document = json_of(read_text(file, LARGEST), str(file))
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise InputError(f"{file}: not a sweep of schema {SCHEMA}")
    lines = document.get("lines")
    if not isinstance(lines, list) or not all(isinstance(line, dict) for line in lines):
        raise InputError(f"{file}: lines: must be a list of tables")
    return document


def edited_classes(
    file: Path, before: Mapping[str, Any], now: Mapping[str, Any]
) -> dict[int, tuple[str, ...]]:
    """Return the classes that were edited: index of a line -> their names. Others have none.

    More seeds are the same sweep, and so is one of which a class was edited.

    Args:
        file: that says what was asked for before.
        before: its content.
        now: what is asked for, as `Request.document` has it.

    Raises:
        InputError: something else differs; the message says what.
    """

    def refuse(what: str, old: object, new: object) -> None:
        raise InputError(
            f"{file}: the sweep here is another: {what} was {old}, now {new}; give another --out"
        )

    for key in ("version", "build"):
        if before.get(key) != now[key]:
            refuse(f"treadwell's {key}", before.get(key), now[key])
    old, new = before.get("lines", []), now["lines"]
    if len(old) != len(new):
        refuse("the number of scenarios and variants", len(old), len(new))
    found: dict[int, tuple[str, ...]] = {}
    for number, (a, b) in enumerate(zip(old, new, strict=True)):
        for key in ("scenario", "robot", "variant", "settings"):
            if a.get(key) != b[key]:
                refuse(f"{key} of {b['scenario']}", a.get(key), b[key])
        if a.get("hash") != b["hash"]:
            files = f"the hash of {b['scenario']}'s files and its robot's, {b['robot']},"
            refuse(files, a.get("hash"), b["hash"])
        if not set(a.get("seeds", [])) <= set(b["seeds"]):
            refuse("episodes", _extent(a["seeds"]), _extent(b["seeds"]))
        found[number] = _edited(a.get("classes"), b["classes"])
    return {number: names for number, names in found.items() if names}


def _edited(before: object, now: Mapping[str, str]) -> tuple[str, ...]:
    """Return the names of the classes of a line that were edited."""
    known = before if isinstance(before, dict) else {}
    # A class that only the new seeds draw is none that the old ones ran with.
    return tuple(name for name, value in now.items() if known.get(name, value) != value)


def _extent(seeds: list[int]) -> str:
    return f"{len(seeds)} from seed {seeds[0]} on" if seeds else "none"
