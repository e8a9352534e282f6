"""What the senses told: two messages of `observations.mcap` as CDR (of ROS 2), and back."""

import struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.observation import Frame, Observation

OBSERVATION: Final = """\
# The measurements of one control tick; joints by the order in the metadata.
uint64 time_ns
# rad
float64[] joint_positions
# rad/s
float64[] joint_velocities
# rad/s, in the frame of the inertial measurement unit
float64[3] angular_velocity
# m/s2, in the same
float64[3] specific_force
# N: front left, front right, rear left, rear right; left foot, then right
float64[8] foot_forces
"""
IMAGE: Final = """\
std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_LITTLE_ENDIAN: Final = b"\x00\x01\x00\x00"
LATEST_NS: Final = 10**15
"""A million seconds."""
_MOST_JOINTS: Final = 1000
_SECOND: Final = 1_000_000_000


def encode(observation: Observation) -> bytes:
    """Return an observation, without its frame, as the message `OBSERVATION`."""
    o = observation
    joints = len(o.joint_positions)
    # A sequence is its length in 4 bytes; float64 begin at multiples of 8 bytes.
    return b"".join(
        (
            _LITTLE_ENDIAN,
            struct.pack("<QII", o.time_ns, joints, 0),
            _bytes(o.joint_positions),
            struct.pack("<II", joints, 0),
            _bytes(o.joint_velocities),
            _bytes(o.angular_velocity),
            _bytes(o.specific_force),
            _bytes(o.foot_forces),
        )
    )


def decode(data: bytes, frame: Frame | None = None) -> Observation:
    """Return the observation of a message.

    Args:
        data: the message.
        frame: that arrived with it.

    Raises:
        ValueError: the message is none of this kind.
    """
    time_ns, joints, _ = struct.unpack_from("<QII", _body(data))
    if joints > _MOST_JOINTS or len(data) != 4 + 24 + 8 * (2 * joints + 14):
        raise ValueError("an observation of the wrong length")
    _check_time(time_ns)
    numbers = np.frombuffer(data, "<f8", joints, 20)
    rest = np.frombuffer(data, "<f8", joints + 14, 28 + 8 * joints)
    return Observation(
        time_ns=time_ns,
        joint_positions=numbers.copy(),
        joint_velocities=rest[:joints].copy(),
        angular_velocity=rest[joints : joints + 3].copy(),
        specific_force=rest[joints + 3 : joints + 6].copy(),
        foot_forces=rest[joints + 6 :].reshape(2, 4).copy(),
        depth=frame,
    )


def encode_image(frame: Frame) -> bytes:
    """Return a frame as the message `IMAGE`; its arrival is not in it."""
    rows, cols = frame.depth.shape
    seconds, rest = divmod(frame.exposure_ns, _SECOND)
    head = struct.pack("<iII7sx", seconds, rest, 7, b"camera\0")
    head += struct.pack("<III6sBx", rows, cols, 6, b"32FC1\0", 0)
    head += struct.pack("<II", 4 * cols, 4 * rows * cols)
    return _LITTLE_ENDIAN + head + np.ascontiguousarray(frame.depth, dtype="<f4").tobytes()


def decode_image(data: bytes, exposure_ns: int, arrival_ns: int) -> Frame:
    """Return the frame of a message.

    Args:
        data: the message.
        exposure_ns: nanoseconds since the start.
        arrival_ns: nanoseconds since the start.

    Raises:
        ValueError: the message is none of this kind.
    """
    rows, cols, _, encoding = struct.unpack_from("<III6s", _body(data), 20)
    if encoding != b"32FC1\0" or len(data) != 4 + 48 + 4 * rows * cols:
        raise ValueError("a depth image of the wrong length")
    _check_time(max(exposure_ns, arrival_ns))
    depth = np.frombuffer(data, "<f4", rows * cols, 52).reshape(rows, cols).astype(np.float32)
    return Frame(exposure_ns=exposure_ns, arrival_ns=arrival_ns, depth=depth)


def _check_time(time_ns: int) -> None:
    if time_ns > LATEST_NS:
        raise ValueError(f"a time of {time_ns / 1e9:g} s, {LATEST_NS / 1e9:g} are allowed")


def _body(data: bytes) -> memoryview:
    if data[:4] != _LITTLE_ENDIAN or len(data) < 4 + 24:
        raise ValueError("no little-endian CDR message")
    return memoryview(data)[4:]


def _bytes(array: NDArray[np.float64]) -> bytes:
    return np.ascontiguousarray(array, dtype="<f8").tobytes()
