"""Clouds of the Point Cloud Library: PCD, as text, binary or compressed.

Read here and not by a library: what is on the registry (pypcd4) believes the counts of a header and
takes all columns into memory, of which a map needs three. What is left is a table for numpy, and
LZF, for which there is a library.
"""

import math
import struct
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.sources.cloud_table import (
    LARGEST_FILE,
    MOST_FIELDS,
    Cloud,
    check_count,
    checked_points,
    packed_colour,
    text_rows,
)
from treadwell.sources.packed import Content
from treadwell.sources.pose_file import MOST_OFF_ONE

_TYPES: Final = {
    **{("F", size): f"<f{size}" for size in (4, 8)},
    **{("I", size): f"<i{size}" for size in (1, 2, 4, 8)},
    **{("U", size): f"<u{size}" for size in (1, 2, 4, 8)},
}
_MOST_LINES: Final = 1000
_LONGEST_FIELD: Final = 1 << 20
_NOWHERE: Final = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
_COLOURS: Final = ("rgb", "rgba")


@dataclass(frozen=True, slots=True)
class _Header:
    """Names, types and counts of the columns; how many points, how they are written; the sensor."""

    names: list[str]
    types: list[str]
    counts: list[int]
    points: int
    data: str
    viewpoint: tuple[float, ...] | None

    def column(self, name: str) -> int | None:
        """Return the number of a column's first value in a row of text; None: there is none."""
        if name not in self.names:
            return None
        return sum(self.counts[: self.names.index(name)])

    def row(self) -> np.dtype[Any]:
        """Return the type of a row of binary data; columns of no interest are gaps in it."""
        sizes = [
            np.dtype(kind).itemsize * count
            for kind, count in zip(self.types, self.counts, strict=True)
        ]
        fields = {
            name: (self.types[i], sum(sizes[:i]))
            for i, name in enumerate(self.names)
            if name in ("x", "y", "z", *_COLOURS)
        }
        return np.dtype(
            {
                "names": list(fields),
                "formats": [kind for kind, _ in fields.values()],
                "offsets": [offset for _, offset in fields.values()],
                "itemsize": sum(sizes),
            }
        )


def read_pcd(content: Content) -> Cloud:
    """Read a cloud from its file's beginning.

    Raises:
        InputError: it is broken, breaks off, or has no or too many points.
    """
    header = _header(content)
    check_count(content.path, header.points)
    size = header.row().itemsize * header.points
    if header.data != "ascii" and size > LARGEST_FILE:
        raise InputError(f"{content.path}: {size} bytes of points, {LARGEST_FILE} are allowed")
    columns = _READERS[header.data](content, header)
    notes: list[str] = []
    points = checked_points(columns, notes)
    colour = next((packed_colour(columns[name]) for name in _COLOURS if name in columns), None)
    return Cloud(points, colour, header.viewpoint, notes)


def _lines(content: Content) -> dict[str, list[str]]:
    """Return the lines of the header, first word -> the others; those that must be there are."""
    told: dict[str, list[str]] = {}
    for _ in range(_MOST_LINES):
        line = content.line()
        words = line.decode("ascii", "replace").split()
        if words and not words[0].startswith("#"):
            told[words[0].upper()] = words[1:]
        if not line or "DATA" in told:
            break
    if "COLUMNS" in told:  # before version 0.7
        told["FIELDS"] = told["COLUMNS"]
    if "POINTS" not in told and "WIDTH" in told and "HEIGHT" in told:
        sides = [_numbers(content, told, side)[0] for side in ("WIDTH", "HEIGHT")]
        told["POINTS"] = [str(math.prod(sides))]
    for key in ("FIELDS", "SIZE", "TYPE", "POINTS", "DATA"):
        if not told.get(key):
            raise InputError(f"{content.path}: {key}: missing; a PCD file begins with it")
    if told["DATA"][0] not in _READERS:
        raise InputError(
            f"{content.path}: DATA: found {told['DATA'][0][:40]}; must be {', '.join(_READERS)}"
        )
    return told


def _header(content: Content) -> _Header:
    """Read the header, and check what it says."""
    told, where = _lines(content), content.path
    names, kinds, sizes = told["FIELDS"], told["TYPE"], _numbers(content, told, "SIZE")
    counts = _numbers(content, told, "COUNT") if "COUNT" in told else [1] * len(names)
    if not len(names) == len(kinds) == len(sizes) == len(counts) <= MOST_FIELDS:
        found = ", ".join(str(len(each)) for each in (names, sizes, kinds, counts))
        raise InputError(f"{where}: FIELDS, SIZE, TYPE, COUNT: must be as many, got {found}")
    types = []
    for name, kind, size, count in zip(names, kinds, sizes, counts, strict=True):
        if (kind, size) not in _TYPES or not 0 <= count <= _LONGEST_FIELD:
            raise InputError(
                f"{where}: {name[:40]}: found {count} times {kind[:10]} of {size} bytes; must be F "
                "of 4 or 8, or I or U of 1, 2, 4 or 8"
            )
        types.append(_TYPES[kind, size])
    # A field of no values takes no room: it is not there.
    there = [number for number, count in enumerate(counts) if count]
    names, types = [names[i] for i in there], [types[i] for i in there]
    counts = [counts[i] for i in there]
    if missing := [name for name in "xyz" if name not in names]:
        raise InputError(f"{where}: FIELDS: has no {', '.join(missing)}")
    points = _numbers(content, told, "POINTS")[0]
    return _Header(names, types, counts, points, told["DATA"][0], _viewpoint(told))


def _numbers(content: Content, told: dict[str, list[str]], key: str) -> list[int]:
    words = told[key]
    if not words or not all(word.isascii() and word.isdigit() and len(word) < 16 for word in words):
        raise InputError(f"{content.path}: {key}: must be whole numbers, got {words[:3]}")
    return [int(word) for word in words]


def _viewpoint(told: dict[str, list[str]]) -> tuple[float, ...] | None:
    """Return where the sensor was, x, y, z m and x, y, z, w; None: the file does not say it."""
    try:
        x, y, z, qw, qx, qy, qz = (float(word) for word in told["VIEWPOINT"])
    except (KeyError, ValueError):
        return None
    found = (x, y, z, qx, qy, qz, qw)
    right = all(math.isfinite(part) for part in found)
    if not right or abs(math.hypot(*found[3:]) - 1.0) > MOST_OFF_ONE:
        return None
    return None if found == _NOWHERE else found


def _text(content: Content, header: _Header) -> dict[str, NDArray[Any]]:
    wanted = {
        name: number
        for name in ("x", "y", "z", *_COLOURS)
        if (number := header.column(name)) is not None
    }
    rows = text_rows(content, header.points, sum(header.counts), list(wanted.values()))
    columns: dict[str, NDArray[Any]] = {name: rows[:, number] for number, name in enumerate(wanted)}
    for name in _COLOURS:
        if name in columns:
            kind = header.types[header.names.index(name)]
            with np.errstate(all="ignore"):
                columns[name] = columns[name].astype(kind)
    return columns


def _binary(content: Content, header: _Header) -> dict[str, NDArray[Any]]:
    kind = header.row()
    data = content.read(kind.itemsize * header.points)
    return _columns(np.frombuffer(data, kind, len(data) // max(kind.itemsize, 1)), content, header)


def _columns(rows: NDArray[Any], content: Content, header: _Header) -> dict[str, NDArray[Any]]:
    if len(rows) < header.points:
        raise InputError(f"{content.path}: breaks off: {len(rows)} points of {header.points}")
    return {name: rows[name] for name in rows.dtype.names or ()}


def _compressed(content: Content, header: _Header) -> dict[str, NDArray[Any]]:
    """Return the columns of LZF data, which lie one behind the other."""
    import lzf

    wanted = (
        sum(
            np.dtype(kind).itemsize * count
            for kind, count in zip(header.types, header.counts, strict=True)
        )
        * header.points
    )
    sizes = content.read(8)
    if len(sizes) < 8:
        raise InputError(f"{content.path}: breaks off: 0 points of {header.points}")
    packed, unpacked = struct.unpack("<II", sizes)
    if unpacked != wanted:
        raise InputError(
            f"{content.path}: unpacks to {unpacked} bytes, {header.points} points have {wanted}"
        )
    data = content.read(min(packed, LARGEST_FILE))
    try:
        whole = lzf.decompress(data, unpacked) if len(data) == packed else None
    except ValueError:
        whole = None
    if whole is None or len(whole) != unpacked:
        raise InputError(f"{content.path}: breaks off, or its packed points are broken")
    columns: dict[str, NDArray[Any]] = {}
    begin = 0
    for name, kind, count in zip(header.names, header.types, header.counts, strict=True):
        size = np.dtype(kind).itemsize * count * header.points
        if name in ("x", "y", "z", *_COLOURS):
            column = np.frombuffer(whole, kind, count * header.points, begin)
            columns[name] = column.reshape(header.points, count)[:, 0]
        begin += size
    return columns


_READERS: Final = {"ascii": _text, "binary": _binary, "binary_compressed": _compressed}
