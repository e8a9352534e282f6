"""The journal of a sweep: one line a finished episode, on the disk before the next is looked at."""

import errno
import json
import os
from pathlib import Path
from typing import Any, Final

from treadwell.careful_json import json_of
from treadwell.errors import InputError, RecordingError
from treadwell.files import read_content, write_bytes

NAME: Final = "journal.jsonl"
LARGEST: Final = 500_000_000
"""Bytes: some million rows."""


class Journal:
    """Appends rows, and knows those that were there. One process at a time may have it open.

    A line counts when its end is there: what a kill left of the last one is cut off.
    """

    def __init__(self, path: Path) -> None:
        """Open the file, a new one where there is none, and read it.

        Raises:
            InputError: it is no file, or a line before the last is broken.
            RecordingError: it cannot be opened.
        """
        self._path = path
        try:
            if os.path.lexists(path):
                content = read_content(path, LARGEST)
                self._file = os.open(path, os.O_WRONLY | os.O_APPEND)
            else:
                content = b""
                self._file = os.open(
                    path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o666
                )
                _sync_folder(path.parent)
        except OSError as error:
            raise RecordingError(f"{path}: {error.strerror}") from error
        whole = content.rfind(b"\n") + 1
        if whole < len(content):
            os.ftruncate(self._file, whole)
        self._size = whole
        self.rows: list[dict[str, Any]] = [
            self._read(number, line)
            for number, line in enumerate(content[:whole].splitlines(), start=1)
        ]

    def append(self, row: dict[str, Any]) -> None:
        """Write a row; when this returns it is on the disk.

        Raises:
            RecordingError: it could not be written; the file is as it was before.
        """
        self._check_place()
        line = _line(row)
        try:
            _write(self._file, line)
        except OSError as error:
            os.ftruncate(self._file, self._size)
            raise RecordingError(
                f"{self._path}: cannot be written: {error.strerror}; what was done before is kept"
            ) from error
        self._size += len(line)
        self.rows.append(row)

    def replace(self, rows: list[dict[str, Any]]) -> None:
        """Hold these rows from now on and no others, whole or not at all.

        Raises:
            OSError: they could not be written; the file is as it was before.
        """
        lines = [_line(row) for row in rows]
        write_bytes(self._path, b"".join(lines))
        os.close(self._file)
        self._file = os.open(self._path, os.O_WRONLY | os.O_APPEND)
        _sync_folder(self._path.parent)
        self._size, self.rows = sum(map(len, lines)), list(rows)

    def _check_place(self) -> None:
        """Find out whether the file is still where it was.

        Raises:
            RecordingError: it is not.
        """
        opened = os.fstat(self._file)
        try:
            there = os.stat(self._path)
            is_there = (there.st_dev, there.st_ino) == (opened.st_dev, opened.st_ino)
        except OSError:
            is_there = False
        if not is_there:
            raise RecordingError(
                f"{self._path}: was removed or renamed while the sweep went on; what was done "
                "before is where the folder is now"
            )

    def close(self) -> None:
        """Close the file."""
        os.close(self._file)

    def _read(self, number: int, line: bytes) -> dict[str, Any]:
        place = f"{self._path}: line {number}"
        row = json_of(line, place)
        if not isinstance(row, dict):
            raise InputError(f"{place}: not a row of a sweep")
        return row


def read_rows(path: Path) -> list[dict[str, Any]]:
    """Return the whole rows of a journal that somebody may be writing; none where there is none.

    Raises:
        InputError: it is no file, or too large for one.
    """
    if not os.path.lexists(path):
        return []
    content = read_content(path, LARGEST)
    rows = []
    for line in content[: content.rfind(b"\n") + 1].splitlines():
        try:
            row = json_of(line, str(path), strict=False)
        except InputError:
            break
        if isinstance(row, dict):
            rows.append(row)
    return rows


def _line(row: dict[str, Any]) -> bytes:
    return json.dumps(row, allow_nan=False, separators=(",", ":")).encode() + b"\n"


def _write(file: int, line: bytes) -> None:
    """Write a line and wait until it is on the disk."""
    if os.write(file, line) < len(line):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    os.fsync(file)


def _sync_folder(folder: Path) -> None:
    """Make sure that a new file's name is on the disk."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
