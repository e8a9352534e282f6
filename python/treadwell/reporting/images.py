"""Pictures for the page, as data URIs of sane size."""

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PIL import Image, UnidentifiedImageError

from treadwell.errors import InputError

_LARGEST: Final = 400_000
"""Bytes of a picture that goes into the page as it is."""
_WIDEST: Final = 1400
"""Pixels."""
_LARGEST_VIDEO: Final = 6_000_000
_STRIP: Final = (320, 256)
"""Pixels of a picture of the strip."""
_MOMENTS: Final = (0.0, 0.33, 0.67, 1.0)
"""Of the run, of which the strip has pictures."""
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
        content = path.read_bytes()
        with Image.open(io.BytesIO(content), formats=["PNG"]) as picture:
            picture.load()
            if len(content) <= _LARGEST and picture.width <= 2 * _WIDEST:
                return _uri("image/png", content)
            picture.thumbnail((_WIDEST, 4 * _WIDEST))
            return _jpeg(picture)
    except OSError as error:
        told = "is no whole PNG file" if error.strerror is None else error.strerror
        raise InputError(f"{path}: {told}") from None
    except (UnidentifiedImageError, Image.DecompressionBombError, SyntaxError, ValueError):
        raise InputError(f"{path}: is no whole PNG file") from None


def strip(folder: Path) -> Sequence[Shot]:
    """Return pictures of a run's course, from its beginning to its end.

    Raises:
        InputError: result or audit are missing or broken.
    """
    from treadwell.film.film import scene_of, state_at
    from treadwell.film.poses import TICK_S

    scene = scene_of(folder, _STRIP)
    shots = []
    for share in _MOMENTS:
        row = round(share * (scene.poses.count - 1))
        time_s = (row + 1) * TICK_S
        picture = Image.fromarray(scene.picture(row))
        caption = f"{time_s:.1f} s {state_at(scene.result, time_s)}".rstrip()
        shots.append(Shot(_jpeg(picture), caption))
    return shots


def film_uri(path: Path) -> str | None:
    """Return a film as a data URI; None where it is too large to go into a page."""
    if path.stat().st_size > _LARGEST_VIDEO:
        return None
    return _uri(_TYPES[path.suffix.lower()], path.read_bytes())


def _jpeg(picture: Image.Image) -> str:
    buffer = io.BytesIO()
    picture.convert("RGB").save(buffer, "JPEG", quality=85)
    return _uri("image/jpeg", buffer.getvalue())


def _uri(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
