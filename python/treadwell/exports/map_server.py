"""The map as an occupancy grid, which ROS's and Nav2's `map_server` loads: `map.pgm`, `map.yaml`.

The picture's rows go from the top (largest y) down; `origin` is the lower-left corner of its
lower-left pixel. By the trinary rule of map_server a pixel p is occupied where (255 - p) / 255 is
above `occupied_thresh`, free where it is below `free_thresh`, and unknown between: 0, 254 and 205
as map_saver writes them.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import write_bytes, write_text
from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, RememberedMap
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map

OCCUPIED, FREE, UNSEEN = 0, 254, 205
"""Values of a pixel."""
OCCUPIED_THRESH, FREE_THRESH = 0.65, 0.196
"""As map_saver has them: 205 lies between, (255 - 205) / 255 = 0.19608."""
STEP_M: Final = 0.02
"""Floors of neighbouring cells whose heights differ by more have an edge between them."""
_YAML: Final = """\
# {what}
image: {image}
mode: trinary
resolution: {resolution!r}
origin: [{x!r}, {y!r}, 0.0]
negate: 0
occupied_thresh: {occupied!r}
free_thresh: {free!r}
"""


def export_map_server(source: Path, out: Path) -> Sequence[Path]:
    """Write `map.pgm` and `map.yaml`, and the same with the edges of steps as obstacles.

    The second pair, `map_steps.*`, is for robots on wheels: what this robot climbs is none of
    theirs.

    Raises:
        InputError: the run has no map.
        OSError: a file cannot be written.
    """
    surface = seen_part(read_map(source / MAP).surface, source)
    pixels = np.full(surface.kind.shape, UNSEEN, np.uint8)
    pixels[surface.kind == FLOOR] = FREE
    pixels[surface.kind == OBSTACLE] = OCCUPIED
    written = _write(out, "map", "floor free, obstacles occupied", pixels, surface)
    stepped = pixels.copy()
    stepped[step_edges(surface)] = OCCUPIED
    return [
        *written,
        *_write(out, "map_steps", "edges of steps are obstacles, too", stepped, surface),
    ]


def seen_part(surface: RememberedMap, source: Path) -> RememberedMap:
    """Return the rectangle around what was seen.

    Raises:
        InputError: nothing was.
    """
    row, col = np.nonzero(surface.kind != UNKNOWN)
    if not row.size:
        raise InputError(f"{source / MAP}: the map has not one cell")
    top, left = int(row.min()), int(col.min())
    part = np.s_[top : int(row.max()) + 1, left : int(col.max()) + 1]
    x, y = surface.origin
    return RememberedMap(
        (x + left * surface.cell, y + top * surface.cell),
        surface.cell,
        surface.kind[part],
        surface.height[part],
        surface.sightings[part],
    )


def step_edges(surface: RememberedMap) -> NDArray[np.bool_]:
    """Return which floor cells lie beside one that is higher or lower by more than a step."""
    height = np.where(surface.kind == FLOOR, surface.height, np.nan)
    edge = np.zeros(height.shape, np.bool_)
    with np.errstate(invalid="ignore"):
        across = np.abs(np.diff(height, axis=1)) > STEP_M
        down = np.abs(np.diff(height, axis=0)) > STEP_M
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge


def _write(
    out: Path, stem: str, what: str, pixels: NDArray[np.uint8], surface: RememberedMap
) -> list[Path]:
    rows, cols = pixels.shape
    image, page = out / f"{stem}.pgm", out / f"{stem}.yaml"
    header = f"P5\n{cols} {rows}\n255\n".encode()
    write_bytes(image, header + np.ascontiguousarray(pixels[::-1]).tobytes())
    x, y = (_exact(value) for value in surface.origin)
    text = _YAML.format(
        what=what,
        image=image.name,
        resolution=_exact(surface.cell),
        x=x,
        y=y,
        occupied=OCCUPIED_THRESH,
        free=FREE_THRESH,
    )
    write_text(page, text)
    return [image, page]


def _exact(value: float) -> float:
    """Return a number without the last digits' rounding, to a nanometre."""
    return 0.0 if math.isclose(value, 0.0, abs_tol=5e-10) else round(value, 9)
