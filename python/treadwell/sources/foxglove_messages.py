"""Foxglove's own messages, in protobuf, as those of ROS: what `export --to mcap` writes, too.

The bytes are read here: the library for protobuf would need Foxglove's generated classes beside it,
and of all messages six are of use. Field numbers: foxglove.dev, schemas of version 1.
"""

import struct
from collections import defaultdict
from collections.abc import Callable, Iterator
from types import SimpleNamespace as Message
from typing import Any, Final

import numpy as np

from treadwell.sources import ros_messages as ros
from treadwell.sources.frame import UnusableError
from treadwell.sources.pose_file import pose_of

_MOST_FIELDS: Final = 1_000_000
_VARINT, _EIGHT_BYTES, _BYTES, _FOUR_BYTES = 0, 1, 2, 5
_NUMBER_OF_TYPE: Final = {1: 2, 2: 1, 3: 4, 4: 3, 5: 6, 6: 5, 7: 7, 8: 8}
"""Type of a cloud's column as Foxglove counts -> as ROS does: signed and unsigned change places."""
_FAULTS: Final = (ValueError, IndexError, struct.error, OverflowError, TypeError)


class _Fields:
    """The fields of one message by number."""

    def __init__(self, data: bytes) -> None:
        """Take a message apart.

        Raises:
            ValueError: it is broken.
        """
        self._found: defaultdict[int, list[int | bytes]] = defaultdict(list)
        for count, (number, value) in enumerate(_wire(data)):
            if count > _MOST_FIELDS:
                raise ValueError("too many fields")
            self._found[number].append(value)

    def integer(self, number: int) -> int:
        """Return a whole number, 0 where it is not there."""
        value = self._found[number][-1] if self._found[number] else 0
        if isinstance(value, bytes):
            value = int.from_bytes(value, "little")
        return value

    def real(self, number: int) -> float:
        """Return a number of 64 bits, 0 where it is not there."""
        value = self._found[number][-1] if self._found[number] else bytes(8)
        return float(struct.unpack("<d", value)[0])  # type: ignore[arg-type]

    def content(self, number: int) -> bytes:
        """Return bytes, none where they are not there."""
        value = self._found[number][-1] if self._found[number] else b""
        if not isinstance(value, bytes):
            raise TypeError("a number in the place of bytes")
        return value

    def text(self, number: int) -> str:
        """Return a text."""
        return self.content(number).decode()

    def below(self, number: int) -> "_Fields":
        """Return a message within."""
        return _Fields(self.content(number))

    def all_below(self, number: int) -> "list[_Fields]":
        """Return all messages of a list."""
        return [_Fields(value) for value in self._found[number] if isinstance(value, bytes)]

    def reals(self, number: int) -> Any:  # noqa: ANN401
        """Return a list of numbers of 64 bits, packed or each for itself."""
        values = [value for value in self._found[number] if isinstance(value, bytes)]
        return np.frombuffer(b"".join(values), "<f8")

    def has(self, number: int) -> bool:
        """Whether a field is there."""
        return bool(self._found[number])


def _wire(data: bytes) -> Iterator[tuple[int, int | bytes]]:
    """Yield number and value of each field; numbers of four and eight bytes as these."""
    at, end = 0, len(data)
    while at < end:
        key, at = _varint(data, at)
        number, kind = key >> 3, key & 7
        if kind == _VARINT:
            value, at = _varint(data, at)
            yield number, value
            continue
        if kind == _BYTES:
            size, at = _varint(data, at)
        elif kind in (_EIGHT_BYTES, _FOUR_BYTES):
            size = 8 if kind == _EIGHT_BYTES else 4
        else:
            raise ValueError("a field of an unknown kind")
        if size > end - at:
            raise ValueError("a field that breaks off")
        yield number, data[at : at + size]
        at += size


def _varint(data: bytes, at: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 70, 7):
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
    raise ValueError("a number that has no end")


def _header(fields: _Fields, frame: int) -> Message:
    stamp = fields.below(1)
    time = Message(sec=stamp.integer(1), nanosec=stamp.integer(2))
    return Message(stamp=time, frame_id=fields.text(frame))


def _image(fields: _Fields) -> Message:
    return Message(
        header=_header(fields, 7),
        width=fields.integer(2),
        height=fields.integer(3),
        encoding=fields.text(4),
        step=fields.integer(5),
        is_bigendian=0,
        data=np.frombuffer(fields.content(6), np.uint8),
    )


def _calibration(fields: _Fields) -> Message:
    matrix, projection = fields.reals(6), fields.reals(8)
    return Message(
        header=_header(fields, 9),
        width=fields.integer(2),
        height=fields.integer(3),
        d=fields.reals(5),
        k=matrix if len(matrix) == 9 else np.zeros(9),
        p=projection if len(projection) == 12 else np.zeros(12),
    )


def _place(fields: _Fields, place: int, turn: int) -> tuple[Message, Message]:
    x, y = fields.below(place), fields.below(turn)
    return (
        Message(x=x.real(1), y=x.real(2), z=x.real(3)),
        Message(x=y.real(1), y=y.real(2), z=y.real(3), w=y.real(4)),
    )


def _own_pose(fields: _Fields, number: int) -> Any:  # noqa: ANN401
    """Return frame_from_sensor, (4, 4); None where the sensor is the frame's origin."""
    if not fields.has(number):
        return None
    place, turn = _place(fields.below(number), 1, 2)
    pose = pose_of(np.array([place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]))
    return None if np.array_equal(pose, np.eye(4)) else pose


def _cloud(fields: _Fields) -> Message:
    data, step = fields.content(6), fields.integer(4)
    columns = [
        Message(
            name=column.text(1),
            offset=column.integer(2),
            datatype=_NUMBER_OF_TYPE.get(column.integer(3), 0),
        )
        for column in fields.all_below(5)
    ]
    return Message(
        header=_header(fields, 2),
        own_pose=_own_pose(fields, 3),
        width=len(data) // step if step else 0,
        height=1,
        point_step=step,
        row_step=len(data),
        fields=columns,
        is_bigendian=False,
        data=np.frombuffer(data, np.uint8),
    )


def _scan(fields: _Fields) -> Message:
    ranges = fields.reals(6)
    first, last = fields.real(4), fields.real(5)
    return Message(
        header=_header(fields, 2),
        own_pose=_own_pose(fields, 3),
        angle_min=first,
        angle_increment=(last - first) / max(len(ranges) - 1, 1),
        range_min=0.0,
        range_max=np.inf,
        ranges=ranges,
    )


def _transform(fields: _Fields) -> Message:
    place, turn = _place(fields, 4, 5)
    return Message(
        header=_header(fields, 2),
        child_frame_id=fields.text(3),
        transform=Message(translation=place, rotation=turn),
    )


def _one_transform(fields: _Fields) -> Message:
    return Message(transforms=[_transform(fields)])


def _transforms(fields: _Fields) -> Message:
    return Message(transforms=[_transform(each) for each in fields.all_below(1)])


_READERS: Final[dict[str, tuple[str, Callable[[_Fields], Message]]]] = {
    "foxglove.RawImage": (ros.IMAGE, _image),
    "foxglove.CameraCalibration": (ros.INFO, _calibration),
    "foxglove.PointCloud": (ros.CLOUD, _cloud),
    "foxglove.LaserScan": (ros.SCAN, _scan),
    "foxglove.FrameTransform": (ros.TRANSFORMS[0], _one_transform),
    "foxglove.FrameTransforms": (ros.TRANSFORMS[0], _transforms),
}
KINDS: Final = {name: kind for name, (kind, _) in _READERS.items()}
"""Name of a message -> of that of ROS which says the same."""


def decode(data: bytes, name: str) -> Any:  # noqa: ANN401
    """Return a message as that of ROS.

    Args:
        data: as written.
        name: one of `KINDS`.

    Raises:
        UnusableError: it is broken.
    """
    try:
        return _READERS[name][1](_Fields(data))
    except _FAULTS:
        raise UnusableError("message that cannot be read") from None
