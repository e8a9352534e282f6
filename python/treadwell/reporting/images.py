"""Pictures for the page, as data URIs of sane size."""

import io
import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PIL import Image, UnidentifiedImageError

from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.reporting.data_uri import data_uri, jpeg_uri

_LARGEST: Final = 400_000
"""Bytes of a picture that goes into the page as it is."""
_LARGEST_READ: Final = 100_000_000
_WIDEST: Final = 1400
"""Pixels."""
_LARGEST_VIDEO: Final = 6_000_000
_LONGEST_S: Final = 120.0
"""Seconds that drawing a run's pictures may take."""
_TYPES: Final = {".mp4": "video/mp4", ".gif": "image/gif"}


@dataclass(frozen=True, slots=True)
class Shot:
    """A picture of the strip: its data URI, and what it shows."""

    uri: str
    caption: str


def picture_uri(path: Path) -> str:
    """Return a picture as a data URI, smaller where it is large.

    Raises:
        InputError: it is no picture, or far too large for one.
    """
    try:
        content = read_content(path, _LARGEST_READ)
        with Image.open(io.BytesIO(content), formats=["PNG"]) as picture:
            picture.load()
            if len(content) <= _LARGEST and picture.width <= 2 * _WIDEST:
                return data_uri("image/png", content)
            picture.thumbnail((_WIDEST, 4 * _WIDEST))
            return jpeg_uri(picture)
    except OSError as error:
        told = "is no whole PNG file" if error.strerror is None else error.strerror
        raise InputError(f"{path}: {told}") from None
    except (UnidentifiedImageError, Image.DecompressionBombError, SyntaxError, ValueError):
        raise InputError(f"{path}: is no whole PNG file") from None


def strip(folder: Path) -> Sequence[Shot]:
    """Return pictures of a run's course, from its beginning to its end.

    They are drawn in a process of their own: MuJoCo dies of some models that were changed on
    purpose, and the page is to come all the same.

    Raises:
        InputError: result or audit are missing or broken.
    """
    words = [sys.executable, "-P", "-m", "treadwell.reporting.strip", str(folder.absolute())]
    try:
        done = subprocess.run(words, capture_output=True, timeout=_LONGEST_S, check=False)
        document = json.loads(done.stdout)
        if "error" in document:
            raise InputError(str(document["error"]))
        return [Shot(*pair) for pair in document["shots"]]
    except (OSError, ValueError, subprocess.TimeoutExpired):
        raise InputError(f"{folder / 'model.mjb'}: cannot be drawn; it may be broken") from None


def film_uri(path: Path) -> str | None:
    """Return a film as a data URI; None where it is too large to go into a page."""
    if path.stat().st_size > _LARGEST_VIDEO:
        return None
    return data_uri(_TYPES[path.suffix.lower()], read_content(path, _LARGEST_VIDEO))
