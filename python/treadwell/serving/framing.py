"""How a message lies on the wire: the length of a header, the header, and the arrays.

    8 bytes   length of the header, bytes; unsigned, little-endian
    header    one JSON object, UTF-8. Its key `arrays` lists what follows, in this order:
              {"name": text, "dtype": one of `DTYPES`, "shape": [whole numbers]}
    arrays    the numbers of each, little-endian, last axis fastest, with nothing between

What comes from outside is refused, with a `ProtocolError`, before any room is made for it.
"""

import json
import math
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.scenario.messages import nearest, shortened, shown

DTYPES: Final = (
    "float64", "float32",
    "int64", "int32", "int16", "int8",
    "uint64", "uint32", "uint16", "uint8",
)  # fmt: skip
"""Types of an array's numbers, by their names in the header."""
LONGEST_HEADER: Final = 1_000_000
"""Bytes: a hundred times that of a robot with forty joints."""
MOST_BYTES: Final = 1 << 26
"""Of all arrays of a message: a depth image of 4096 by 4096 pixels."""
MOST_ARRAYS: Final = 32
MOST_AXES: Final = 8
PREFIX: Final = struct.Struct("<Q")
"""The length of the header."""
ARRAYS: Final = "arrays"

Receive = Callable[[int], bytes]
"""Returns as many bytes as asked for, or fewer where there are no more to come."""


class ProtocolError(InputError):
    """What the other side of a connection did is not as the protocol says; one clear message."""


@dataclass(frozen=True, slots=True, eq=False)
class Message:
    """One message.

    Attributes:
        header: what it says, without the list of its arrays.
        arrays: name -> array.
    """

    header: dict[str, Any]
    arrays: dict[str, NDArray[Any]] = field(default_factory=dict)


def pack(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None) -> bytes:
    """Return a message's bytes.

    Args:
        header: what JSON can hold, without the key `arrays`.
        arrays: name -> array of one of `DTYPES`.

    Raises:
        ProtocolError: no message holds this.
    """
    if ARRAYS in header:
        raise ProtocolError(f"the header: {ARRAYS}: is the list of the arrays, which is made here")
    given = arrays or {}
    listed = [
        {"name": name, "dtype": array.dtype.name, "shape": list(array.shape)}
        for name, array in given.items()
    ]
    _sizes(listed)  # what the other side would refuse is refused here
    try:
        whole = {**header, ARRAYS: listed}
        text = json.dumps(whole, allow_nan=False, ensure_ascii=False).encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise ProtocolError(f"the header is not JSON: {error}") from None
    if len(text) > LONGEST_HEADER:
        raise ProtocolError(_too_long(len(text)))
    parts = [
        array.astype(array.dtype.newbyteorder("<"), order="C", copy=False).tobytes()
        for array in given.values()
    ]
    return PREFIX.pack(len(text)) + text + b"".join(parts)


def read_message(receive: Receive) -> Message | None:
    """Return the next message; None where the other side has ended between two messages.

    Args:
        receive: gives what comes.

    Raises:
        ProtocolError: it breaks off, or is no message.
    """
    prefix = receive(PREFIX.size)
    if not prefix:
        return None
    (length,) = PREFIX.unpack(_whole(prefix, PREFIX.size, "the length of a header"))
    if length > LONGEST_HEADER:
        raise ProtocolError(_too_long(length))
    text = _whole(receive(length), length, "a header")
    try:
        header = json_of(text, "the header")
    except InputError as error:
        raise ProtocolError(shortened(str(error), 300)) from None
    if not isinstance(header, dict):
        raise ProtocolError(f"the header: found {shown(header)}; must be a JSON object")
    listed = header.pop(ARRAYS, [])
    arrays = {}
    for entry, size in zip(listed, _sizes(listed), strict=True):
        name = entry["name"]
        data = _whole(receive(size), size, f"the array {shortened(name, 60)!r}")
        kind = np.dtype(entry["dtype"])
        array = np.frombuffer(data, kind.newbyteorder("<")).astype(kind)
        arrays[name] = array.reshape(entry["shape"])
    return Message(header, arrays)


def _sizes(listed: object) -> list[int]:
    """Return the bytes of each array of a list.

    Raises:
        ProtocolError: the list is none, or of more than a message may hold.
    """
    if not isinstance(listed, list) or len(listed) > MOST_ARRAYS:
        raise ProtocolError(f"the header: {ARRAYS}: must be a list of up to {MOST_ARRAYS} tables")
    sizes = [_size(entry, f"the header: {ARRAYS}.{i}") for i, entry in enumerate(listed)]
    names = [entry["name"] for entry in listed]
    if len(set(names)) < len(names):
        raise ProtocolError(f"the header: {ARRAYS}: two of them have one name")
    if sum(sizes) > MOST_BYTES:
        raise ProtocolError(f"arrays of {sum(sizes)} bytes; at most {MOST_BYTES} are allowed")
    return sizes


def _size(entry: object, where: str) -> int:
    if not isinstance(entry, dict) or entry.keys() != {"name", "dtype", "shape"}:
        raise ProtocolError(f"{where}: must be a table of name, dtype and shape")
    name, dtype, shape = entry["name"], entry["dtype"], entry["shape"]
    if not isinstance(name, str):
        raise ProtocolError(f"{where}.name: found {shown(name)}; must be a text")
    if dtype not in DTYPES:
        raise ProtocolError(
            f"{where}.dtype: found {shown(dtype)}; must be one of {', '.join(DTYPES)}"
            f"{nearest(dtype, DTYPES)}"
        )
    whole = isinstance(shape, list) and all(type(n) is int and n >= 0 for n in shape)
    if not whole or len(shape) > MOST_AXES:
        raise ProtocolError(
            f"{where}.shape: found {shown(shape)}; must be up to {MOST_AXES} whole numbers"
        )
    item = np.dtype(dtype).itemsize
    # An axis without an entry must not hide one that no array can have.
    if item * math.prod(max(n, 1) for n in shape) > MOST_BYTES:
        raise ProtocolError(f"{where}.shape: found {shown(shape)}: more than {MOST_BYTES} bytes")
    return item * math.prod(shape)


def _whole(data: bytes, length: int, what: str) -> bytes:
    if len(data) < length:
        raise ProtocolError(
            f"the connection ended within {what}: {len(data)} of {length} bytes came"
        )
    return data


def _too_long(length: int) -> str:
    return (
        f"a header of {length} bytes; at most {LONGEST_HEADER} are allowed "
        "(a message begins with the length of its header in 8 bytes, little-endian)"
    )
