"""What the core answered and what was true at each tick, as CDR messages, and back."""

import math
import struct
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.protocols import Pose

COMMAND: Final = """\
# What the core told the motors at one control tick; joints by the order in the metadata.
uint64 time_ns
# rad
float64[] positions
# rad/s
float64[] velocities
# N m, on top of the servo's own
float64[] torques
"""
ESTIMATE: Final = """\
# What the core believed at one control tick.
uint64 time_ns
# x, y, z m, yaw rad of the robot in the map
float64[4] pose
# the same by leg odometry alone, from the same start
float64[4] odometry
# name of the behaviour's state
string state
# what it declared: goal_reached, refused, or nothing; and why it refused
string outcome
string reason
"""
TRUTH: Final = """\
std_msgs/Header header
geometry_msgs/Pose pose
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""
HEAD: Final = b"\x00\x01\x00\x00"
"""Of every message: CDR, little-endian."""
SECOND: Final = 1_000_000_000
_MOST_JOINTS: Final = 1000
_LONGEST_TEXT: Final = 10_000

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Command:
    """What the core told the motors: `COMMAND`."""

    time_ns: int
    positions: Floats
    velocities: Floats
    torques: Floats


@dataclass(frozen=True, slots=True)
class Belief:
    """What the core believed: `ESTIMATE`; `outcome` and `reason` are empty where there was none."""

    time_ns: int
    pose: Pose
    odometry: Pose
    state: str
    outcome: str
    reason: str


def encode_command(time_ns: int, positions: Floats, velocities: Floats, torques: Floats) -> bytes:
    """Return the message `COMMAND`."""
    n = len(positions)
    # A sequence is its length in 4 bytes; float64 begin at multiples of 8 bytes.
    length = struct.pack("<II", n, 0)
    return b"".join(
        (
            HEAD,
            struct.pack("<QII", time_ns, n, 0),
            positions.astype("<f8", copy=False).tobytes(),
            length,
            velocities.astype("<f8", copy=False).tobytes(),
            length,
            torques.astype("<f8", copy=False).tobytes(),
        )
    )


def decode_command(data: bytes) -> Command:
    """Return what the message `COMMAND` says.

    Raises:
        ValueError: the message is none of this kind.
    """
    time_ns, n, _ = struct.unpack_from("<QII", _body(data, 20))
    if n > _MOST_JOINTS or len(data) != 4 + 24 + 8 * (3 * n + 1):
        raise ValueError("a command of the wrong length")
    arrays = [np.frombuffer(data, "<f8", n, 20 + 8 * i * (n + 1)).copy() for i in range(3)]
    return Command(time_ns, *arrays)


def encode_estimate(
    time_ns: int, pose: Pose, odometry: Pose, state: str, outcome: str | None, reason: str | None
) -> bytes:
    """Return the message `ESTIMATE`."""
    numbers = struct.pack("<Q8d", time_ns, *pose, *odometry)
    return HEAD + numbers + _text(state) + _text(outcome or "") + _text(reason or "")


def decode_estimate(data: bytes) -> Belief:
    """Return what the message `ESTIMATE` says.

    Raises:
        ValueError: the message is none of this kind.
    """
    numbers = struct.unpack_from("<Q8d", _body(data, 72))
    texts, at = [], 4 + 72
    for _ in range(3):
        if at + 4 > len(data):
            raise ValueError("an estimate of the wrong length")
        (length,) = struct.unpack_from("<I", data, at)
        if not 0 < length <= _LONGEST_TEXT or at + 4 + length > len(data):
            raise ValueError("an estimate of the wrong length")
        texts.append(bytes(data[at + 4 : at + 3 + length]).decode())
        at += 4 + (length + 3) // 4 * 4
    if at != len(data):
        raise ValueError("an estimate of the wrong length")
    pose: Pose = (numbers[1], numbers[2], numbers[3], numbers[4])
    odometry: Pose = (numbers[5], numbers[6], numbers[7], numbers[8])
    return Belief(numbers[0], pose, odometry, texts[0], texts[1], texts[2])


def encode_truth(time_ns: int, position: tuple[float, ...], quaternion: tuple[float, ...]) -> bytes:
    """Return the message `TRUTH`.

    Args:
        time_ns: nanoseconds since the start.
        position: x, y, z m, of the robot in the map.
        quaternion: x, y, z, w.
    """
    seconds, rest = divmod(time_ns, SECOND)
    head = struct.pack("<iII4s", seconds, rest, 4, b"map\0")
    # The header is 16 bytes long, so that the numbers lie on multiples of 8 without more.
    return HEAD + head + struct.pack("<7d", *position, *quaternion)


def decode_truth(data: bytes) -> tuple[float, ...]:
    """Return x, y, z m and the quaternion x, y, z, w of the message `TRUTH`.

    Raises:
        ValueError: the message is none of this kind.
    """
    if len(data) != 4 + 16 + 56:
        raise ValueError("a pose of the wrong length")
    pose = struct.unpack_from("<7d", _body(data, 72), 16)
    if not all(math.isfinite(value) for value in pose):
        raise ValueError("a pose that is not finite")
    return pose


def _text(text: str) -> bytes:
    content = text.encode()[: _LONGEST_TEXT - 4] + b"\0"
    return struct.pack("<I", len(content)) + content + b"\0" * (-len(content) % 4)


def _body(data: bytes, least: int) -> memoryview:
    if data[:4] != HEAD or len(data) < 4 + least:
        raise ValueError("no little-endian CDR message")
    return memoryview(data)[4:]
