"""Clouds and meshes as PLY: text, or binary of either order of bytes; the corners alone are read.

Read here and not by a library: plyfile believes the counts of a header, makes a Python object of
each row of text, and reads the faces, too. What is left is a table for numpy.
"""

from dataclasses import dataclass, field
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
    text_rows,
)
from treadwell.sources.packed import Content

_TYPES: Final = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_COLOURS: Final = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
_MOST_LINES: Final = 10_000


@dataclass(slots=True)
class _Element:
    """A kind of thing that a file lists, and its properties: name -> type, None of a list."""

    name: str
    count: int
    properties: dict[str, str | None] = field(default_factory=dict)


def read_ply(content: Content) -> Cloud:
    """Read a cloud from its file's beginning.

    Raises:
        InputError: it is broken, breaks off, has no or too many points, or lists something else
            before them that is no table.
    """
    order, elements = _header(content)
    for element in elements:
        if element.name == "vertex":
            return _vertices(content, order, element)
        if None in element.properties.values():
            raise InputError(
                f"{content.path}: element {element.name[:40]}: has lists and stands before "
                "vertex; the points must come first"
            )
        _skip(content, order, element)
    raise InputError(f"{content.path}: has no element vertex, which would be its points")


def _header(content: Content) -> tuple[str, list[_Element]]:
    where = content.path
    if content.line().strip() != b"ply":
        raise InputError(f"{where}: is no PLY file: it must begin with the line ply")
    order: str | None = None
    elements: list[_Element] = []
    for _ in range(_MOST_LINES):
        line = content.line()
        if not line:
            raise InputError(f"{where}: breaks off in its header")
        match words := line.decode("ascii", "replace").split():
            case ["end_header"]:
                if order is None:
                    raise InputError(f"{where}: format: missing")
                return order, elements
            case ["format", word, _] if word in _ORDERS:
                order = _ORDERS[word]
            case [] | ["comment" | "obj_info", *_]:
                pass
            case _:
                if not _told(words, elements):
                    found = " ".join(words)[:60]
                    raise InputError(f"{where}: found {found!r} in a PLY file's header")
    raise InputError(f"{where}: a header of more than {_MOST_LINES} lines")


def _told(words: list[str], elements: list[_Element]) -> bool:
    """Take in what a line tells of elements; whether it is such a line."""
    match words:
        case ["element", name, count] if count.isascii() and count.isdigit():
            elements.append(_Element(name, int(count[:20])))
        case ["property", "list", _, _, name] if elements:
            elements[-1].properties[name] = None
        case ["property", kind, name] if elements and kind in _TYPES:
            there = elements[-1].properties
            if name in there or len(there) > MOST_FIELDS:
                return False
            there[name] = _TYPES[kind]
        case _:
            return False
    return True


def _row(order: str, element: _Element) -> np.dtype[Any]:
    return np.dtype([(name, f"{order}{kind}") for name, kind in element.properties.items()])


def _skip(content: Content, order: str, element: _Element) -> None:
    if order:
        content.read(min(_row(order, element).itemsize * element.count, LARGEST_FILE + 1))
        return
    for _ in range(element.count):
        if not content.line():
            return


def _vertices(content: Content, order: str, element: _Element) -> Cloud:
    where = content.path
    check_count(where, element.count)
    if missing := [name for name in "xyz" if element.properties.get(name) is None]:
        raise InputError(f"{where}: element vertex: has no property {', '.join(missing)}")
    if None in element.properties.values():
        raise InputError(f"{where}: element vertex: has a list; numbers alone are read")
    names = [name for names in ("xyz", *_COLOURS) for name in names if name in element.properties]
    columns: dict[str, NDArray[Any]]
    if order:
        kind = _row(order, element)
        size = kind.itemsize * element.count
        if size > LARGEST_FILE:
            raise InputError(f"{where}: {size} bytes of points, {LARGEST_FILE} are allowed")
        data = content.read(size)
        if len(data) < size:
            found = len(data) // kind.itemsize
            raise InputError(f"{where}: breaks off: {found} points of {element.count}")
        rows = np.frombuffer(data, kind)
        columns = {name: rows[name] for name in names}
    else:
        places = list(element.properties)
        wanted = [places.index(name) for name in names]
        table = text_rows(content, element.count, len(places), wanted)
        columns = {name: table[:, number] for number, name in enumerate(names)}
    notes: list[str] = []
    return Cloud(checked_points(columns, notes), _colour(columns, element), None, notes)


def _colour(columns: dict[str, NDArray[Any]], element: _Element) -> NDArray[np.uint8] | None:
    """Return red, green and blue (n, 3) where they are bytes, or shares of 1 in floats."""
    for names in _COLOURS:
        if all(name in columns for name in names):
            kinds = {element.properties[name] for name in names}
            if not (kinds <= {"f4", "f8"} or kinds == {"u1"}):
                return None
            full = 255.0 if kinds <= {"f4", "f8"} else 1.0
            parts = np.stack([columns[name] for name in names], axis=1).astype(np.float64)
            with np.errstate(invalid="ignore"):  # some NaN are told by the processor
                parts = np.clip(np.nan_to_num(parts) * full, 0.0, 255.0)
            return parts.astype(np.uint8)
    return None
