"""Terrain: a height field that a picture says, or that is drawn from the seed."""

import math
from io import BytesIO
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from treadwell.course.height_field import FieldPiece, FieldTop, HeightField
from treadwell.course.outlines import Floats, heading, left_of
from treadwell.course.pieces import Piece, Top, about_z, level
from treadwell.errors import InputError
from treadwell.files import read_content
from treadwell.random_streams import stream
from treadwell.scenario.ground_elements import Terrain

BELOW_M: Final = 0.05
"""Metres below its lowest place to which it is solid."""
WHITE: Final = 65535.0
MOST_HEIGHTS: Final = 4_000_000
"""As many as an MJCF world's height field may have."""
PER_WAVE: Final = 12
"""Heights along the shortest wave."""
COARSEST_M: Final = 0.05
"""Metres between two heights at most, where that is no more than `MOST_ALONG` of them."""
MOST_ALONG: Final = 1200
WAVES: Final = 32
"""Waves that are added, each with a length of once to twice the wavelength."""
_LARGEST_FILE: Final = 50_000_000
_GREY: Final = ("I;16", "I;16B", "I")
_FAULTS: Final = (OSError, ValueError, SyntaxError, EOFError, MemoryError, OverflowError)


def terrain_pieces(
    terrain: Terrain, name: str, seed: int, folder: Path
) -> tuple[list[Piece], list[Top]]:
    """Return the solid of a terrain and its surface.

    Args:
        terrain: the element.
        name: its name: it is drawn from that and the seed.
        seed: the episode's.
        folder: in which its picture lies.

    Raises:
        InputError: the picture is broken or no grey one of 16 bits.
    """
    length, width, top = terrain.size
    if terrain.file is not None:
        heights = top * shares((folder / terrain.file).resolve())
    else:
        heights = top * drawn_shares(terrain, name, seed)
    ahead = heading(terrain.yaw)
    field = HeightField(
        heights=heights,
        middle=np.array(terrain.position, np.float64),
        turn=np.column_stack([ahead, left_of(terrain.yaw)]),
        half=np.array([length, width]) / 2,
        bottom=-BELOW_M,
    )
    high = float(heights.max())
    corners = [np.column_stack([field.corners, np.full(4, z)]) for z in (-BELOW_M, high)]
    center = np.array([*field.middle, (high - BELOW_M) / 2])
    size = np.array([*field.half, (high + BELOW_M) / 2])
    piece = FieldPiece(
        "hull", "field", np.vstack(corners), center, size, about_z(terrain.yaw), field
    )
    outline = level("top", field.corners, float(heights.mean()))
    return [piece], [FieldTop("top", outline.polygon, field)]


def shares(path: Path) -> Floats:
    """Return a picture's heights, 0 black to 1 white; its lowest row first, (rows, columns).

    Raises:
        InputError: it cannot be read, or is no grey one of 16 bits, or too large or too small.
    """
    content = read_content(path, _LARGEST_FILE)
    try:
        with Image.open(BytesIO(content), formats=["PNG"]) as image:
            columns, rows = image.size
            if min(columns, rows) < 2 or columns * rows > MOST_HEIGHTS:
                raise InputError(
                    f"{path}: {columns}x{rows} pixels; a terrain has 2 or more along each side and "
                    f"at most {MOST_HEIGHTS} in all"
                )
            if image.mode not in _GREY:
                raise InputError(f"{path}: a picture of another kind; must be grey, of 16 bits")
            picture: Floats = np.array(image).astype(np.float64) / WHITE
    except (*_FAULTS, Image.DecompressionBombError) as error:
        raise InputError(f"{path}: cannot be read as a PNG picture: {error}") from None
    return np.clip(picture[::-1], 0.0, 1.0)


def drawn_shares(terrain: Terrain, name: str, seed: int) -> Floats:
    """Return heights that are drawn: 0 at the edges and in the lowest place, 1 in the highest.

    A sum of waves in all directions, of once to twice the wavelength, which fades towards the
    edges over half a wavelength, or a quarter of a side where that is less.
    """
    length, width, _ = terrain.size
    wave = terrain.drawn_wavelength()
    spacing = min(wave / PER_WAVE, max(COARSEST_M, max(length, width) / MOST_ALONG))
    x, y = (
        np.linspace(0.0, side, max(2, math.ceil(side / spacing) + 1)) for side in (length, width)
    )
    generator = stream(seed, f"course.{name}")
    heights = np.zeros((len(y), len(x)))
    for _ in range(WAVES):
        direction, phase = generator.uniform(0.0, 2.0 * math.pi, 2)
        number = 2.0 * math.pi / (wave * generator.uniform(1.0, 2.0))
        along, across = number * math.cos(direction) * x, number * math.sin(direction) * y
        # cos(a + b + p) without a cosine for each place
        heights += np.outer(np.cos(across + phase), np.cos(along))
        heights -= np.outer(np.sin(across + phase), np.sin(along))
    heights -= heights.min()
    heights *= np.outer(_fading(y, width, wave), _fading(x, length, wave))
    most = float(heights.max())
    return heights / most if most > 0.0 else heights


def _fading(places: Floats, side: float, wave: float) -> Floats:
    """Return 0 at both ends of a side, 1 within, and a smooth step between."""
    over = min(wave / 2, side / 4)
    inwards = np.clip(np.minimum(places, side - places) / over, 0.0, 1.0)
    smooth: Floats = inwards**2 * (3.0 - 2.0 * inwards)
    return smooth
