"""A stranger's file, packed by gzip or not, read piece by piece and never more than is allowed."""

import gzip
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final, cast

from treadwell.errors import InputError
from treadwell.files import opened

_PACKED: Final = b"\x1f\x8b"
_LONGEST_LINE: Final = 1 << 20
"""Bytes: a scan of a hundred thousand readings."""


class Content:
    """What a file holds, unpacked."""

    def __init__(self, path: Path, stream: BinaryIO, most_bytes: int) -> None:
        """Begin at the front.

        Args:
            path: the file's name, for messages.
            stream: its content.
            most_bytes: that may be read of it.
        """
        self.path = path
        self._stream = stream
        self._left = most_bytes
        self._most = most_bytes

    def line(self) -> bytes:
        """Return the next line with its end, nothing at the end of the file.

        Raises:
            InputError: it is too long, the file too large, or broken.
        """
        try:
            line = self._stream.readline(_LONGEST_LINE + 1)
        except (OSError, EOFError, zlib.error) as error:
            raise self._broken(error) from None
        if len(line) > _LONGEST_LINE:
            raise InputError(f"{self.path}: a line of more than {_LONGEST_LINE} bytes")
        self._count(len(line))
        return line

    def lines(self) -> Iterator[str]:
        """Yield the lines that are left, as text; what is no ASCII becomes a question mark."""
        while line := self.line():
            yield line.decode("ascii", "replace")

    def read(self, size: int) -> bytes:
        """Return the next bytes, fewer where the file ends.

        Raises:
            InputError: more are asked for than may be read, or the file is broken.
        """
        self._count(size)
        parts = []
        try:
            while size and (part := self._stream.read(min(size, 1 << 24))):
                parts.append(part)
                size -= len(part)
        except (OSError, EOFError, zlib.error) as error:
            raise self._broken(error) from None
        return b"".join(parts)

    def _count(self, size: int) -> None:
        self._left -= size
        if self._left < 0:
            raise InputError(f"{self.path}: larger than {self._most} bytes, which is the limit")

    def _broken(self, error: Exception) -> InputError:
        return InputError(f"{self.path}: cannot be read: {error}")


@contextmanager
def unpacked(path: Path, most_bytes: int) -> Iterator[Content]:
    """Open a file for reading; whether it is packed is seen from how it begins.

    Raises:
        InputError: it is missing, cannot be read, or is no file.
    """
    with opened(path) as file:
        try:
            packed = file.peek(2)[:2] == _PACKED
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}") from None
        if packed:
            with gzip.open(file) as stream:
                yield Content(path, cast(BinaryIO, stream), most_bytes)
        else:
            yield Content(path, file, most_bytes)
