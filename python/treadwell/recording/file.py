"""The file of a recording: how far it is whole, and how much it can still grow."""

import errno
import math
import os
import resource
import struct
from pathlib import Path
from typing import Final

from treadwell.errors import InputError
from treadwell.files import opened

NAME: Final = "recording.rrd"
_MAGIC: Final = b"RRF2"
_HEADER: Final = 12
_MESSAGE: Final = struct.Struct("<QQ")
"""Before each message: its kind and its length in bytes."""
_MOST_MESSAGES: Final = 500_000
"""A recording of an hour has a tenth; nothing but empty ones would be read for minutes."""
_FOOTER: Final = 32
"""Bytes behind the last message of a finished file."""
_FOOTER_MARK: Final = b"RRF2FOOT"


def whole_length(path: Path) -> int:
    """Return the bytes up to the end of the last whole message; 0 for another kind of file.

    A file that rerun has finished ends with a footer behind its last message, which counts.

    Raises:
        InputError: the file cannot be read.
        OSError: it broke while it was read.
    """
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        if file.read(len(_MAGIC)) != _MAGIC or size < _HEADER:
            return 0
        end, count = _HEADER, 0
        while count < _MOST_MESSAGES and end + _MESSAGE.size <= size:
            file.seek(end)
            _, length = _MESSAGE.unpack(file.read(_MESSAGE.size))
            if end + _MESSAGE.size + length > size:
                break
            end += _MESSAGE.size + length
            count += 1
        file.seek(max(0, size - _FOOTER))
        finished = _FOOTER_MARK in file.read(_FOOTER)
    return size if finished and size - end == _FOOTER else end


def begins_right(path: Path) -> bool:
    """Say whether a file is a recording as far as it goes, however short it is.

    Raises:
        InputError: the file cannot be read.
    """
    with opened(path) as file:
        return _MAGIC.startswith(file.read(len(_MAGIC)))


def cut_to_whole_messages(path: Path) -> None:
    """Cut a recording that breaks off amid a message behind the last whole one."""
    try:
        os.truncate(path, whole_length(path))
    except (InputError, OSError):
        return  # it stays as it is: readable but for its end


def write_fault(path: Path, error: OSError) -> str:
    """Return why a file could not be written, with the room that is left where that is too little.

    Args:
        path: of the file.
        error: that came of writing it.
    """
    told = str(error.strerror or error)
    if error.errno not in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        return told
    try:
        return f"{told}, {room(path) / 1e6:.1f} MB are left"
    except OSError:
        return told


def room(path: Path) -> float:
    """Return how many bytes a file can still grow by.

    Raises:
        OSError: there is no such file.
    """
    disk = os.statvfs(path)
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    allowed = math.inf if limit == resource.RLIM_INFINITY else limit - path.stat().st_size
    return min(disk.f_bavail * disk.f_frsize, allowed)
