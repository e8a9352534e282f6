"""Files of strangers: no larger than was said before, and never something that is no file."""

from pathlib import Path

from treadwell.errors import InputError


def read_content(path: Path, most_bytes: int) -> bytes:
    """Return a file's content.

    Raises:
        InputError: it is missing, no file (a pipe would be waited for without end), or too large.
    """
    try:
        if path.exists() and not path.is_file():
            raise InputError(f"{path}: cannot be read: it is no file")
        with path.open("rb") as file:
            content = file.read(most_bytes + 1)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise InputError(f"{path}: cannot be read: not a file's name") from None
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
