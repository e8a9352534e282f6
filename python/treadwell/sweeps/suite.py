"""Frozen suites: lists of episodes whose scenario files may not have changed since."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Final, Literal

from pydantic import Field, ValidationError, field_validator

from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.scenario.loading import LARGEST_ASSET, find_scenario, load_scenario, read_toml
from treadwell.scenario.messages import nearest, shortened
from treadwell.scenario.types import Name, Table
from treadwell.sweeps.content import named_files
from treadwell.sweeps.request import Line, Request, checked, make_line
from treadwell.sweeps.variants import variants

FOLDER: Final = "suites"
_SHOWN: Final = 12


class Entry(Table):
    """A scenario with a robot over seeds, and the hash of its file."""

    scenario: str
    robot: str | None = None
    seeds: Annotated[tuple[int, ...], Field(strict=False, min_length=1, max_length=10_000)]
    hash: str

    @field_validator("seeds")
    @classmethod
    def _once(cls, seeds: tuple[int, ...]) -> tuple[int, ...]:
        if len(set(seeds)) < len(seeds):
            raise ValueError("each seed may be there once")
        return seeds


class Suite(Table):
    """A suite file: `schema`, `name`, `description`, and an `[[entry]]` each."""

    schema_: Annotated[Literal[1], Field(alias="schema")]
    name: Name
    description: str = ""
    entry: Annotated[tuple[Entry, ...], Field(strict=False, min_length=1)]

    def request(self, settings: Sequence[str] = (), vary: Sequence[str] = ()) -> Request:
        """Return the suite as a sweep, with every variant.

        Raises:
            InputError: a scenario's file is not what it was, or a setting is bad.
        """
        lines: list[Line] = []
        for entry in self.entry:
            found = file_hash(find_scenario(entry.scenario))
            if found != entry.hash:
                raise InputError(
                    f"suite {self.name}: {entry.scenario} is not what it was: its hash is "
                    f"{found[:_SHOWN]}, the suite was frozen with {entry.hash[:_SHOWN]}"
                )
            lines += [
                make_line(entry.scenario, entry.seeds, entry.robot, tuple(settings), chosen)
                for chosen in variants(vary)
            ]
        return checked(lines)


def file_hash(path: Path) -> str:
    """Return the hash of a scenario's file by its text; line ends do not count.

    Of what it names besides, another file's course, meshes and worlds, the content counts, too.
    """
    content = hashlib.sha256(read_content(path, LARGEST_ASSET).replace(b"\r\n", b"\n"))
    scenario = load_scenario(path)
    course_of = read_toml(path).get("course_of")
    for other in (*([path.parent / course_of] if course_of else []), *named_files(scenario)):
        content.update(read_content(other, LARGEST_ASSET))
    return content.hexdigest()


def suite_names() -> list[str]:
    """Return the names of the suites that ship with the package, sorted."""
    return sorted(path.stem for path in (data_folder("scenarios") / FOLDER).glob("*.toml"))


def find_suite(name_or_path: str) -> Suite:
    """Return a suite: a path is tried first, then those that ship with the package.

    Raises:
        InputError: there is none, or it is broken.
    """
    path = Path(name_or_path)
    if not path.is_file():
        names = suite_names()
        if name_or_path not in names:
            raise InputError(
                f"--suite {shortened(name_or_path)}: no such file or suite; suites: "
                f"{', '.join(names)}{nearest(name_or_path, names)}"
            )
        path = data_folder("scenarios") / FOLDER / f"{name_or_path}.toml"
    try:
        return Suite.model_validate(read_toml(path))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{path}: {key}: {first['msg']}") from None
