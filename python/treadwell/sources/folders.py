"""What lies in a stranger's folder: files that are named by their time, and lists of such files."""

import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from treadwell.errors import InputError
from treadwell.files import read_text

MOST_FILES: Final = 1_000_000
"""In one folder: nine hours at 30 images a second."""
_LARGEST_LIST: Final = 200_000_000
"""Bytes of a list of files."""
Timed = tuple[float, Path]
"""A time, s, and the file of that time."""


def files_in(folder: Path) -> list[Path]:
    """Return a folder's files that are not hidden, by name.

    Raises:
        InputError: it cannot be read, or holds more than `MOST_FILES`.
    """
    found: list[Path] = []
    try:
        for path in folder.iterdir():
            if not path.name.startswith("."):
                found.append(path)
            if len(found) > MOST_FILES:
                raise InputError(f"{folder}: more than {MOST_FILES} files, which is the limit")
    except OSError as error:
        raise InputError(f"{folder}: cannot be read: {error.strerror}") from None
    return sorted(found)


def stem(path: Path, suffixes: Sequence[str]) -> str | None:
    """Return a file's name without its ending, None where that is none of some endings."""
    lower = path.name.lower()
    for suffix in suffixes:
        if lower.endswith(suffix):
            return path.name[: -len(suffix)]
    return None


def timed_files(
    folder: Path, suffixes: Sequence[str], unused: Counter[str] | None = None
) -> list[Timed]:
    """Return the files of some endings that are named by their time in seconds, in its order.

    Args:
        folder: holds them, and other files, which are passed over.
        suffixes: endings, lower case.
        unused: is told how many have a name that is no time.

    Raises:
        InputError: the folder cannot be read.
    """
    found = []
    for path in files_in(folder):
        name = stem(path, suffixes)
        if name is None:
            continue
        try:
            time = float(name)
        except ValueError:
            time = math.nan
        if math.isfinite(time):
            found.append((time, path))
        elif unused is not None:
            unused["name is no time"] += 1
    return sorted(found)


def listed_files(path: Path) -> list[Timed]:
    """Return the files of a list, `time name` a line, in the order of time; # begins a remark.

    Args:
        path: the list; names are of files in its folder.

    Raises:
        InputError: it is missing, a line is none of these, or names a file outside of the folder.
    """
    found = []
    for number, line in enumerate(read_text(path, _LARGEST_LIST).splitlines(), start=1):
        words = line.split(maxsplit=1)
        if not words or words[0].startswith("#"):
            continue
        try:
            time = float(words[0])
        except ValueError:
            time = math.nan
        if len(words) != 2 or not math.isfinite(time):
            raise InputError(f"{path}: line {number}: must be a time in seconds and a file's name")
        name = Path(words[1].strip())
        if name.is_absolute() or ".." in name.parts:
            raise InputError(f"{path}: line {number}: must name a file in this folder")
        found.append((time, path.parent / name))
    return sorted(found)
