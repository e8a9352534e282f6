"""Floor, obstacles and the unknown, of heights of one's own."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from treadwell._core import FloorView
from treadwell.errors import InputError
from treadwell.mapping.checks import finite_numbers, positive


def floor_view(
    height: ArrayLike,
    *,
    cell: float,
    origin: tuple[float, float] = (0.0, 0.0),
    kind: ArrayLike | None = None,
    sightings: ArrayLike | None = None,
) -> FloorView:
    """Return a view as world models show it and planners read it.

    A world model in Python may return it from `view()`; `plan` and planners of one's own take it.

    >>> import numpy as np
    >>> from treadwell import mapping
    >>> height = np.zeros((50, 100))
    >>> height[20:30, 40:60] = 0.3                      # a box, seen from above
    >>> view = mapping.floor_view(height, cell=0.04)
    >>> free = view.passable(z=0.0, rise=0.015, radius=0.12)

    Args:
        height: (rows, cols) m, of any float type; rows along +y; NaN or infinite where unknown.
        cell: side of a cell, m.
        origin: (x, y) m, outer corner of row 0 and column 0.
        kind: (rows, cols): 0 unknown, 1 floor, 2 obstacle. None: all that is known is floor;
            `passable` still tells other levels.
        sightings: (rows, cols) frames that saw each cell; None: what is known was seen often.

    Raises:
        InputError: an argument that cannot be; it is named.
    """
    heights = _grid("height", height, "fiu", None, np.dtype(np.float32))
    known = np.isfinite(heights)
    heights = np.where(known, heights, np.float32(np.nan))
    shape = (heights.shape[0], heights.shape[1])
    if kind is None:
        kinds = known.astype(np.uint8)
    else:
        kinds = _grid("kind", kind, "iu", shape, np.dtype(np.uint8))
    made = SimpleNamespace(
        origin=finite_numbers("origin", origin, 2),
        cell=positive("cell", cell),
        kind=kinds,
        height=heights,
    )
    if sightings is not None:
        made.sightings = _grid("sightings", sightings, "iu", shape, np.dtype(np.uint16))
    return FloorView.of(made)


def _grid(
    name: str,
    values: ArrayLike,
    kinds: str,
    shape: tuple[int, int] | None,
    dtype: np.dtype[Any],
) -> NDArray[Any]:
    """Return an array as the core takes it."""
    given = np.asarray(values)
    wanted = "(rows, columns)" if shape is None else str(shape)
    if given.dtype.kind not in kinds or given.ndim != 2 or shape not in (None, given.shape):
        what = "numbers" if "f" in kinds else "whole numbers"
        raise InputError(f"{name} must be {what} {wanted}, got {given.dtype} {given.shape}")
    if "f" not in kinds and given.size:
        low, high = np.iinfo(dtype).min, np.iinfo(dtype).max
        if given.min() < low or given.max() > high:
            raise InputError(f"{name} must be from {low} to {high}, got {given.max()}")
    return np.ascontiguousarray(given, dtype)
