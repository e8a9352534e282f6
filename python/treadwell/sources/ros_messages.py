"""What messages of ROS hold: depth images, clouds and laser scans, as arrays.

A message is an object with the fields of its definition, as `rosbags` makes it; those of ROS 1 and
2 are the same but for the names of a camera's matrices.
"""

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.sources.camera_file import MOST_PIXELS
from treadwell.sources.cloud_table import MOST_POINTS, checked_points, packed_colour
from treadwell.sources.depth_image import png_depth
from treadwell.sources.frame import Floats, PinholeCamera, UnusableError

IMAGE: Final = "sensor_msgs/msg/Image"
COMPRESSED: Final = "sensor_msgs/msg/CompressedImage"
CLOUD: Final = "sensor_msgs/msg/PointCloud2"
SCAN: Final = "sensor_msgs/msg/LaserScan"
INFO: Final = "sensor_msgs/msg/CameraInfo"
ODOMETRY: Final = "nav_msgs/msg/Odometry"
TRANSFORMS: Final = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
_DEPTHS: Final = {"16UC1": "u2", "mono16": "u2", "32FC1": "f4", "64FC1": "f8"}
"""Encoding of an image -> type of its numbers; integers are millimetres (REP 118)."""
MILLIMETRES_A_METRE: Final = 1000.0
_FIELDS: Final = ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")
"""Types of a cloud's columns by their numbers, from 1."""
_COLOURS: Final = ("rgb", "rgba")
_DEPTH_HEAD: Final = 12
"""Bytes before the PNG of a compressed depth image; they mean nothing of 16 bits."""
_BROKEN: Final = "message that cannot be read"


def stamp_of(message: Any, log_ns: int) -> float:  # noqa: ANN401
    """Return when a message was measured, s; where it does not say so, when it was recorded."""
    stamp = message.header.stamp
    time = stamp.sec + 1e-9 * stamp.nanosec
    return time if time > 0.0 else 1e-9 * log_ns


def is_depth(message: Any, kind: str) -> bool:  # noqa: ANN401
    """Whether an image is one of depths."""
    if kind == COMPRESSED:
        said = message.format.replace(" ", "")
        return "compressedDepth" in said and said.startswith("16UC1")
    return message.encoding in _DEPTHS


def depth_of(message: Any, kind: str, camera: PinholeCamera, scale: float) -> NDArray[Any]:  # noqa: ANN401
    """Return the depths (h, w) m of an image.

    Args:
        message: the image.
        kind: its type.
        camera: its size must be this one's.
        scale: units a metre of integers.

    Raises:
        UnusableError: it is broken, of another size or no depth image.
    """
    if not is_depth(message, kind):
        raise UnusableError("image that is not of depths")
    shape = camera.height, camera.width
    if kind == COMPRESSED:
        packed = bytes(message.data)[_DEPTH_HEAD:]
        return _scaled(png_depth(packed, shape), scale)
    if (message.height, message.width) != shape:
        raise UnusableError(f"image that is not {camera.width}x{camera.height}")
    number = np.dtype(f"{'>' if message.is_bigendian else '<'}{_DEPTHS[message.encoding]}")
    data, row = np.asarray(message.data, np.uint8), camera.width * number.itemsize
    if message.step < row or len(data) < message.step * (camera.height - 1) + row:
        raise UnusableError(_BROKEN)
    rows = np.lib.stride_tricks.as_strided(data, (camera.height, row), (message.step, 1))
    image = np.ascontiguousarray(rows).view(number)
    return _scaled(image, scale) if number.kind == "u" else image


def _scaled(image: NDArray[Any], scale: float) -> NDArray[np.float32]:
    scaled: NDArray[np.float32] = image.astype(np.float32) / np.float32(scale)
    return scaled


def camera_of(message: Any, topic: str) -> PinholeCamera | None:  # noqa: ANN401
    """Return the camera of its info; None: it says nothing that can be used.

    Args:
        message: the info.
        topic: of the images: where it says that they were rectified, the projection's numbers hold.
    """
    matrix = message.k if hasattr(message, "k") else message.K
    projection = message.p if hasattr(message, "p") else message.P
    fx, cx, fy, cy = matrix[0], matrix[2], matrix[4], matrix[5]
    if "rect" in topic and projection[0] > 0.0:
        fx, cx, fy, cy = projection[0], projection[2], projection[5], projection[6]
    numbers = [float(number) for number in (fx, fy, cx, cy)]
    width, height = int(message.width), int(message.height)
    right = all(math.isfinite(number) for number in numbers) and min(numbers[:2]) > 0.0
    if not (right and 0 < width <= MOST_PIXELS and 0 < height <= MOST_PIXELS):
        return None
    return PinholeCamera(width, height, *numbers)


def is_distorted(message: Any) -> bool:  # noqa: ANN401
    """Whether a camera's info tells of a lens that bends."""
    return bool(np.any(np.asarray(message.d if hasattr(message, "d") else message.D)))


def cloud_of(message: Any) -> tuple[Floats, NDArray[np.uint8] | None]:  # noqa: ANN401
    """Return the points (n, 3) m and the colours (n, 3) of a cloud.

    Raises:
        UnusableError: it is broken, has no x, y and z, or too many points.
    """
    count = message.width * message.height
    if not 0 < count <= MOST_POINTS:
        raise UnusableError("too many points" if count else "no point")
    mark, columns = ">" if message.is_bigendian else "<", {}
    for field in message.fields:
        if field.name in ("x", "y", "z", *_COLOURS):
            if not 1 <= field.datatype <= len(_FIELDS):
                raise UnusableError(_BROKEN)
            columns[field.name] = (f"{mark}{_FIELDS[field.datatype - 1]}", int(field.offset))
    if not {"x", "y", "z"} <= columns.keys():
        raise UnusableError("cloud without x, y and z")
    data = np.asarray(message.data, np.uint8)
    row, step = message.point_step * message.width, message.row_step
    if message.height == 1:
        step = row
    if step < row or len(data) < step * (message.height - 1) + row:
        raise UnusableError(_BROKEN)
    rows = np.lib.stride_tricks.as_strided(data, (message.height, row), (step, 1))
    try:
        kind = np.dtype(
            {
                "names": list(columns),
                "formats": [form for form, _ in columns.values()],
                "offsets": [offset for _, offset in columns.values()],
                "itemsize": message.point_step,
            }
        )
    except ValueError:
        raise UnusableError(_BROKEN) from None
    table = np.frombuffer(np.ascontiguousarray(rows).data, kind)
    points = checked_points({name: table[name] for name in "xyz"}, [])
    colour = next((packed_colour(table[name]) for name in _COLOURS if name in columns), None)
    return points, colour


def scan_of(message: Any) -> NDArray[np.float32]:  # noqa: ANN401
    """Return the points (n, 3) m of a laser scan, NaN where nothing was seen within its bounds.

    Raises:
        UnusableError: it is broken.
    """
    with np.errstate(invalid="ignore"):  # some NaN are told by the processor
        distance = np.asarray(message.ranges, np.float64)
    first, step = float(message.angle_min), float(message.angle_increment)
    if not (math.isfinite(first) and math.isfinite(step)) or not len(distance):
        raise UnusableError(_BROKEN)
    with np.errstate(invalid="ignore"):
        seen = (distance > 0.0) & (distance >= message.range_min) & (distance < message.range_max)
    distance = np.where(seen, distance, np.nan)
    angle = first + step * np.arange(len(distance))
    ways = np.stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))], axis=1)
    points: NDArray[np.float32] = (distance[:, None] * ways).astype(np.float32)
    return points
