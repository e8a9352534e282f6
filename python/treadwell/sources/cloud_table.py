"""A cloud as its file has it: columns of numbers by name, and the points that they make."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from io import StringIO
from itertools import islice
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.sources.frame import Floats
from treadwell.sources.packed import Content

MOST_POINTS: Final = 10_000_000
"""Of one cloud: with its file and what is made of it they take up to 2 GB of memory."""
LARGEST_FILE: Final = 3 << 28
"""Bytes of a cloud's file, unpacked: with its packed points and what is made of it up to 2 GB."""
FARTHEST_M: Final = 1e8
"""No coordinate of a projection of the Earth is larger: what is beyond is no point."""
MOST_FIELDS: Final = 1000
_ROWS_AT_A_TIME: Final = 100_000


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """The points of a file.

    Attributes:
        points: (n, 3) m as written, in the file's own coordinates; NaN where there is none.
        colour: (n, 3) red, green, blue, or None.
        viewpoint: x, y, z m and quaternion x, y, z, w of the sensor, where the file says it.
        notes: what its user should know.
    """

    points: Floats
    colour: NDArray[np.uint8] | None
    viewpoint: tuple[float, ...] | None = None
    notes: list[str] = field(default_factory=list)


def check_count(where: object, count: int) -> None:
    """Refuse a cloud of no or too many points.

    Raises:
        InputError: it is one.
    """
    if count < 1:
        raise InputError(f"{where}: holds not one point")
    if count > MOST_POINTS:
        raise InputError(
            f"{where}: {count} points, {MOST_POINTS} are allowed, which take 2 GB of memory: thin "
            "the cloud out first, or cut it into several"
        )


def checked_points(columns: Mapping[str, NDArray[Any]], notes: list[str]) -> Floats:
    """Return the points (n, 3) of columns x, y, z, NaN for those that are none.

    Args:
        columns: of any type of number; with x, y and z.
        notes: is told how many are none for being too far away.
    """
    points = np.empty((len(columns["x"]), 3))
    with np.errstate(invalid="ignore"):  # some NaN are told by the processor
        for number, name in enumerate("xyz"):
            points[:, number] = columns[name]
        far = (np.abs(points) > FARTHEST_M).any(axis=1)
    none = far | ~np.isfinite(points).all(axis=1)
    points[none] = np.nan
    beyond = int(np.count_nonzero(far))
    if beyond:
        notes.append(f"{beyond} points have a coordinate beyond {FARTHEST_M:g} m and are left out")
    return points


def packed_colour(column: NDArray[Any]) -> NDArray[np.uint8] | None:
    """Return red, green, blue (n, 3) of a column whose 32 bits hold them, as PCL writes them."""
    if column.dtype.kind not in "fiu" or column.dtype.itemsize != 4:
        return None
    bits = np.ascontiguousarray(column).view(f"{column.dtype.byteorder}u4").astype(np.uint32)
    return np.stack([(bits >> shift).astype(np.uint8) for shift in (16, 8, 0)], axis=1)


def text_rows(content: Content, count: int, width: int, wanted: Sequence[int]) -> Floats:
    """Return some columns of the next rows of numbers, (n, columns) in 64 bits.

    Args:
        content: the file, where the rows begin.
        count: how many there must be.
        width: numbers of a row, at least.
        wanted: columns, in the order in which they are returned.

    Raises:
        InputError: there are fewer rows, or one is none of numbers.
    """
    rows = np.empty((count, len(wanted)))
    lines = (line for line in content.lines() if line.strip())
    done = 0
    while done < count:
        block = list(islice(lines, min(_ROWS_AT_A_TIME, count - done)))
        if not block:
            raise InputError(f"{content.path}: breaks off: {done} points of {count}")
        try:
            table = np.loadtxt(StringIO("".join(block)), comments=None, usecols=wanted, ndmin=2)
        except (ValueError, IndexError) as error:
            what = " ".join(str(error).split())[:150]
            raise InputError(
                f"{content.path}: between points {done} and {done + len(block)}: a row that is not "
                f"of {width} numbers: {what}"
            ) from None
        rows[done : done + len(block)] = table
        done += len(block)
    return rows
