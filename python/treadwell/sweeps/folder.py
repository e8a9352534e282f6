"""The folder of a sweep: what was asked for, the journal, recordings, and the results."""

import fcntl
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Self

from treadwell.errors import InputError, RecordingError
from treadwell.files import write_text
from treadwell.sweeps import journal
from treadwell.sweeps.agreement import Edited, edited_classes, read_asked
from treadwell.sweeps.request import Key, Request
from treadwell.sweeps.row import Row, row_of
from treadwell.sweeps.table import write_table

ASKED: Final = "sweep.json"
RESULTS: Final = "results.json"
TABLE: Final = "episodes.parquet"
EPISODES: Final = "episodes"
REPLACED: Final = "replaced"
"""Of a class that was edited: numbered folders of the rows and recordings that ran with it."""
_LOCK: Final = ".lock"
_DOING: Final = ".doing"


class SweepFolder:
    """A sweep's folder while a process works on it, and no other; a context manager.

    Attributes:
        path: of the folder.
        rows: of the episodes that are done, in the order in which they were.
        edited: the classes in Python that were edited since; the rows that ran with them are gone.
    """

    def __init__(self, path: Path, request: Request) -> None:
        """Take the folder: a new one, an empty one, or one whose sweep goes on.

        Raises:
            InputError: it holds something else, another process has it, or its sweep is another.
            RecordingError: it cannot be written.
        """
        self.path, self._request = path, request
        self._lock = self._take()
        try:
            edited = self._agree()
            self._journal = journal.Journal(path / journal.NAME)
            self.rows = [self._row(row) for row in self._journal.rows]
            self._check_rows()
            self.edited = self._set_aside(edited)
            self._note_asked()
            self._tidy()
        except BaseException:
            os.close(self._lock)
            raise

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(self, *raised: object) -> None:
        """Give the folder up."""
        self._journal.close()
        shutil.rmtree(self.path / _DOING, ignore_errors=True)
        os.close(self._lock)

    def place(self, key: Key) -> Path:
        """Return a folder, not there yet, for an episode that is going to be recorded."""
        place = self.path / _DOING / self.name(key)
        shutil.rmtree(place, ignore_errors=True)
        with _written(self.path):
            place.parent.mkdir(exist_ok=True)
        return place.resolve()

    def keep(self, key: Key) -> str | None:
        """Keep what was recorded of an episode; return its folder within the sweep's."""
        made, kept = self.path / _DOING / self.name(key), self.path / EPISODES / self.name(key)
        if not made.is_dir():
            return None
        with _written(self.path):
            kept.parent.mkdir(exist_ok=True)
            made.rename(kept)
        return str(kept.relative_to(self.path))

    def drop(self, key: Key) -> None:
        """Throw away what was recorded of an episode."""
        shutil.rmtree(self.path / _DOING / self.name(key), ignore_errors=True)

    def append(self, row: Row) -> None:
        """Note an episode's end.

        Raises:
            RecordingError: it could not be written.
        """
        self._journal.append(row.document())
        self.rows.append(row)

    def name(self, key: Key) -> str:
        """Return the name of an episode's folder."""
        numbers = [line.variant for line in self._request.lines if line.variant]
        variants = list(dict.fromkeys(numbers))
        variant = f"-v{variants.index(key.variant) + 1}" if key.variant else ""
        return f"{key.scenario}-{key.robot}{variant}-{key.seed}"

    def ordered(self) -> list[Row]:
        """Return the rows line by line in the order of the request, then by seed."""
        return sorted(self.rows, key=lambda row: (self._request.line_of(row.key), row.seed))

    def finish(self, document: dict[str, Any]) -> None:
        """Write the results.

        Raises:
            RecordingError: they could not be written.
        """
        try:
            write_table(self.path / TABLE, self.ordered())
            write_text(self.path / RESULTS, json.dumps(document, indent=1, allow_nan=False) + "\n")
        except OSError as error:
            raise RecordingError(f"{self.path}: cannot be written: {error}") from error

    def _take(self) -> int:
        path = self.path
        try:
            there = path.exists() and (not path.is_dir() or any(path.iterdir()))
            if there and not (path / ASKED).is_file() and not (path / _LOCK).is_file():
                raise InputError(f"--out: {path} exists already and holds no sweep")
            path.mkdir(parents=True, exist_ok=True)
            handle = os.open(path / _LOCK, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            raise InputError(f"--out: {path}: {error.strerror}") from None
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(handle)
            raise InputError(f"--out: {path}: another process is working on this sweep") from None
        return handle

    def _agree(self) -> dict[int, tuple[str, ...]]:
        """Hold what is asked for against what was before: line -> classes that were edited."""
        file = self.path / ASKED
        if not os.path.lexists(file):
            return {}
        return edited_classes(file, read_asked(file), self._request.document())

    def _note_asked(self) -> None:
        """Write what is asked for; last, so that a kill before it leaves the sweep as it was."""
        file = self.path / ASKED
        with _written(file):
            write_text(file, json.dumps(self._request.document(), indent=2) + "\n")

    def _set_aside(self, edited: dict[int, tuple[str, ...]]) -> tuple[Edited, ...]:
        """Put rows and recordings of classes that were edited where they are not in the way."""
        lines = [self._request.line_of(row.key) for row in self.rows]
        if edited.keys().isdisjoint(lines):
            return ()
        number, place = 1, self.path / REPLACED / "1"
        while place.exists():
            number += 1
            place = self.path / REPLACED / str(number)
        by_line = list(zip(self.rows, lines, strict=True))
        stale = [row for row, line in by_line if line in edited]
        left = [row for row, line in by_line if line not in edited]
        with _written(place):
            (place / EPISODES).mkdir(parents=True)
            text = "".join(json.dumps(row.document(), allow_nan=False) + "\n" for row in stale)
            write_text(place / journal.NAME, text)
            self._journal.replace([row.document() for row in left])
            for row in stale:
                kept = self.path / EPISODES / self.name(row.key)
                if kept.is_dir():
                    kept.rename(place / EPISODES / kept.name)
        self.rows = left
        names = dict.fromkeys(name for line in edited for name in edited[line])
        return tuple(
            Edited(
                name,
                sum(name in edited.get(line, ()) for line in lines),
                len(self.rows),
                place,
            )
            for name in names
        )

    def _row(self, document: dict[str, Any]) -> Row:
        try:
            return row_of(document)
        except (TypeError, ValueError) as error:
            raise InputError(
                f"{self.path / journal.NAME}: not the rows of this version: {error}"
            ) from None

    def _check_rows(self) -> None:
        keys = [row.key for row in self.rows]
        if len(set(keys)) < len(keys) or not set(keys) <= set(self._request.keys()):
            raise InputError(f"{self.path / journal.NAME}: rows that were not asked for, or twice")

    def _tidy(self) -> None:
        """Remove what a killed process left half done."""
        shutil.rmtree(self.path / _DOING, ignore_errors=True)
        # What else is there, a replay say, is the user's.
        for key in set(self._request.keys()) - {row.key for row in self.rows}:
            shutil.rmtree(self.path / EPISODES / self.name(key), ignore_errors=True)


def kept_folder(sweep: Path, named: object) -> Path | None:
    """Return the folder of an episode that was kept; None of one that lies elsewhere or is gone.

    Args:
        sweep: the sweep's folder.
        named: what a row says, which may be anything.
    """
    if not isinstance(named, str) or not named or "\x00" in named:
        return None
    try:
        path = sweep / named
        inside = path.resolve().is_relative_to(sweep.resolve())
        return path if inside and path.is_dir() else None
    except (OSError, RuntimeError, ValueError):
        return None


@contextmanager
def _written(path: Path) -> Iterator[None]:
    """Tell what cannot be written as an error of the recording."""
    try:
        yield
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error}") from error
