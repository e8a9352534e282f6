"""What an episode depends on, as hashes: of other code or other files it is another episode."""

import hashlib
import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from treadwell.data import PACKAGE
from treadwell.files import opened
from treadwell.own_core import VARIABLE
from treadwell.robot.load import Robot
from treadwell.scenario.elements import named_file
from treadwell.scenario.events import Add
from treadwell.scenario.model import Scenario


def build_hash() -> str:
    """Return a hash of the package's code, and of a core of the user's own."""
    files = [*PACKAGE.rglob("*.py"), *PACKAGE.glob("_core*.so"), *PACKAGE.glob("_core*.pyd")]
    own = os.environ.get(VARIABLE)
    return _hash([*sorted(files), *([Path(own)] if own else [])], "")


def line_hash(file: Path, scenario: Scenario, robot: Robot, asked: Sequence[Any]) -> str:
    """Return a hash of the files of a sweep's line, and of what the scenario becomes.

    Classes in Python are not in it: each has a hash of its own.

    Args:
        file: the scenario's.
        scenario: as it is run with the first seed.
        robot: whose folder counts.
        asked: settings and the like, as plain data.
    """
    files = [file, *named_files(scenario), *_files_in(robot.folder, "*")]
    return _hash(files, json.dumps([scenario.configuration(), *asked]))


def named_files(scenario: Scenario) -> Iterator[Path]:
    """Return the meshes, worlds and heights that a scenario's elements name."""
    added = [event.element for event in scenario.event if isinstance(event, Add)]
    for element in (*scenario.course, *added):
        file = named_file(element)
        if file is not None:
            yield scenario.folder / file


def _files_in(folder: Path, pattern: str) -> list[Path]:
    return sorted(path for path in folder.rglob(pattern) if path.is_file())


def _hash(files: Sequence[Path], text: str) -> str:
    content = hashlib.sha256()
    for path in files:
        with opened(path) as file:
            content.update(hashlib.file_digest(file, "sha256").digest())
    content.update(text.encode())
    return content.hexdigest()[:16]
