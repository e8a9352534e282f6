"""The sides of a comparison: finished sweeps, each variant a side of its own."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from treadwell.careful_json import json_of
from treadwell.comparing.comparison import Candidate
from treadwell.errors import InputError
from treadwell.files import read_text
from treadwell.sweeps import journal
from treadwell.sweeps.agreement import LARGEST, read_asked
from treadwell.sweeps.folder import ASKED, RESULTS
from treadwell.sweeps.request import SCHEMA
from treadwell.sweeps.row import Row, row_of


def candidates(folders: Sequence[Path]) -> list[Candidate]:
    """Return each variant of each sweep, in the order in which they were given.

    Raises:
        InputError: one is no finished sweep, or is given twice.
    """
    places = [folder.resolve() for folder in folders]
    if len(set(places)) < len(places):
        raise InputError("compare: a sweep is given twice")
    found: list[Candidate] = []
    for folder, place in zip(folders, places, strict=True):
        document = read_results(folder)
        rows = [_row(folder, row) for row in document["episodes"]]
        for variant in dict.fromkeys(str(line.get("variant", "")) for line in document["lines"]):
            words = [place.name] if len(folders) > 1 or not variant else []
            name = " ".join([*words, *([variant] if variant else [])])
            of_it = tuple(row for row in rows if row.variant == variant)
            unused = _unused(name, [one.name for one in found], folder)
            found.append(Candidate(unused, of_it, folder))
    return found


def read_results(folder: Path) -> dict[str, Any]:
    """Return what a sweep's `results.json` holds.

    Raises:
        InputError: there is none, or it is none.
    """
    file = folder / RESULTS
    if not folder.is_dir():
        raise InputError(f"{folder}: there is no such sweep")
    if not file.is_file():
        if (folder / journal.NAME).is_file():
            raise InputError(f"{folder}: the sweep is not finished; its command goes on with it")
        raise InputError(f"{folder}: not a sweep, there is no {RESULTS}")
    document = json_of(read_text(file, LARGEST), str(file))
    good = isinstance(document, dict) and document.get("schema") == SCHEMA
    if not good or not all(isinstance(document.get(key), list) for key in ("lines", "episodes")):
        raise InputError(f"{file}: not of schema {SCHEMA}")
    if not all(isinstance(line, dict) for line in document["lines"]):
        raise InputError(f"{file}: not of schema {SCHEMA}")
    asked = folder / ASKED
    if asked.is_file() and read_asked(asked)["lines"] != document["lines"]:
        raise InputError(
            f"{folder}: the sweep is not finished: {ASKED} asks for more than {RESULTS} has; its "
            "command goes on with it"
        )
    return dict(document)


def _row(folder: Path, document: object) -> Row:
    try:
        if isinstance(document, dict):
            return row_of(document)
        told = "no table"
    except (TypeError, ValueError) as error:
        told = str(error)
    raise InputError(
        f"{folder / RESULTS}: an episode that is not as this version writes it: {told}"
    )


def _unused(name: str, taken: Sequence[str], folder: Path) -> str:
    return name if name not in taken else f"{folder} {name}"
