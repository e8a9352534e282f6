"""Rows of numbers that grow with a run: a block in memory, what came before in a `.npy` file."""

import os
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, Any, Final

import numpy as np
from numpy.typing import DTypeLike, NDArray

from treadwell.errors import RecordingError

_BLOCK_BYTES: Final = 1 << 17
"""Of a block, about: what waits in memory until it is written."""


class Rows:
    """An array that grows by rows; its memory does not.

    Full blocks go to a nameless file, or to the one that `keep_in` names. Its header is brought up
    to date with each of them, so that whatever happens later it is a whole `.npy` file.
    """

    def __init__(self, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> None:
        """Begin with no row.

        Args:
            shape: of a row.
            dtype: of its values.
        """
        self._file: IO[bytes] | None = None
        self._path: Path | None = None
        self._type, self._shape = np.dtype(dtype), shape
        self._row_bytes = self._type.itemsize * int(np.prod(shape))
        self._block = np.empty((max(1, _BLOCK_BYTES // max(1, self._row_bytes)), *shape), dtype)
        self._waiting, self._written = 0, 0
        self._dropped = False

    def __del__(self) -> None:
        """Let go of the file."""
        self._release()

    def __len__(self) -> int:
        """Return how many rows there are."""
        return self._written + self._waiting

    def append(self, row: NDArray[Any]) -> None:
        """Copy a row to the end.

        Raises:
            RecordingError: it cannot be written.
        """
        self._block[self._waiting] = row
        self._waiting += 1
        if self._waiting == len(self._block):
            self.flush()

    def extend(self, rows: NDArray[Any]) -> None:
        """Copy rows (n, ...) to the end.

        Raises:
            RecordingError: they cannot be written.
        """
        end = self._waiting + len(rows)
        if end < len(self._block):
            self._block[self._waiting : end] = rows
            self._waiting = end
            return
        while len(rows):
            taken = rows[: len(self._block) - self._waiting]
            self._block[self._waiting : self._waiting + len(taken)] = taken
            self._waiting += len(taken)
            rows = rows[len(taken) :]
            if self._waiting == len(self._block):
                self.flush()

    def keep_in(self, path: Path) -> None:
        """Keep the rows, also those that there are, in a file of this name from now on.

        Raises:
            RecordingError: it cannot be written.
        """
        if self._dropped:
            raise RecordingError(f"{path}: what is to be written was dropped")
        so_far = self.array()
        self._release()
        try:
            # Without a buffer: what is written is in the file even where the process is killed.
            self._file, self._path = path.open("w+b", buffering=0), path
        except OSError as error:
            raise _failed(path, error) from error
        self._waiting = self._written = 0
        self._write(so_far)

    def drop(self) -> None:
        """Forget all rows, and those to come; to keep them then is an error."""
        self._release()
        self._waiting = self._written = 0
        self._dropped = True

    def flush(self) -> None:
        """Write what waits.

        Raises:
            RecordingError: it cannot be written.
        """
        rows, self._waiting = self._block[: self._waiting], 0
        if len(rows) and not self._dropped:
            self._write(rows)

    def array(self) -> NDArray[Any]:
        """Return (n, ...): all rows so far."""
        waiting = self._block[: self._waiting].copy()
        if self._file is None or not self._written:
            return waiting
        self._file.seek(0)
        kept: NDArray[Any] = np.lib.format.read_array(self._file)
        return np.concatenate([kept, waiting])

    def _release(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _write(self, rows: NDArray[Any]) -> None:
        try:
            if self._file is None:
                self._file = TemporaryFile(buffering=0)  # noqa: SIM115 - closed when it is let go
            self._file.seek(0)
            write_header(self._file, self._type, (self._written, *self._shape))
            # Not the end: there may be a piece of a block that could not be written whole.
            self._file.seek(self._written * self._row_bytes, os.SEEK_CUR)
            rest = np.ascontiguousarray(rows).reshape(-1).view(np.uint8)
            while len(rest):
                rest = rest[self._file.write(rest.data) :]
            self._written += len(rows)
            self._file.seek(0)
            write_header(self._file, self._type, (self._written, *self._shape))
        except OSError as error:
            raise _failed(self._path, error) from error


def write_header(file: IO[bytes], dtype: "np.dtype[Any]", shape: tuple[int, ...]) -> None:
    """Write the header of a `.npy` file, as long for any number of rows.

    Raises:
        OSError: it cannot be written.
    """
    said = {"descr": np.lib.format.dtype_to_descr(dtype), "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(file, said)


def _failed(path: Path | None, error: OSError) -> RecordingError:
    place = path or "the audit, in the folder for temporary files"
    return RecordingError(f"{place}: cannot be written: {error.strerror}")
