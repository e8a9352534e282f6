"""Files: strangers' are read with care, ours are written whole or not at all.

What is read is no larger than was said before, and never something that is no file. What is
written takes its place when all of it is on the disk, readable to whom the umask allows.
"""

import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedReader
from pathlib import Path

from treadwell.errors import InputError


def opened(path: Path) -> BufferedReader:
    """Open a file for reading.

    Raises:
        InputError: it is missing, cannot be read, or is no file: a pipe would be waited for
            without end, a device be read without end.
    """
    try:
        # Whether it is a file is asked of what was opened, so that nothing can change between.
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return os.fdopen(handle, "rb")
        os.close(handle)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise InputError(f"{path}: cannot be read: not a file's name") from None
    raise InputError(f"{path}: cannot be read: it is no file")


def read_content(path: Path, most_bytes: int) -> bytes:
    """Return a file's content.

    Raises:
        InputError: as `opened`, or it is too large.
    """
    with opened(path) as file:
        try:
            # Room is made for as much as is asked for: not for more than there is.
            size = os.fstat(file.fileno()).st_size
            content = file.read(min(size, most_bytes) + 1)
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    if len(content) > most_bytes:
        raise InputError(f"{path}: larger than {most_bytes} bytes, which is the limit")
    return content


def read_text(path: Path, most_bytes: int) -> str:
    """Return a file's content as text.

    Raises:
        InputError: as `read_content`, or it is not UTF-8.
    """
    try:
        return read_content(path, most_bytes).decode()
    except UnicodeDecodeError:
        raise InputError(f"{path}: not UTF-8") from None


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Give a path beside the file to write to; it takes the file's place when all went well.

    Its ending is the file's, which some writers look at.

    Raises:
        OSError: the file cannot be written.
    """
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}{path.suffix}")
    os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666))
    try:
        yield temporary
        with temporary.open("rb") as file:
            os.fsync(file.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def write_text(path: Path, text: str) -> None:
    """Write a file in UTF-8 whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    write_bytes(path, text.encode())
