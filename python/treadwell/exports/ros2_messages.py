"""Messages of ROS 2, made of a run's numbers: what `export --to rosbag2` writes.

`rosbags` brings ROS's own definitions (those of Humble, which later releases have kept) and packs
them as CDR. Frames and units are ROS's (REP 103): x forward, y left, z up, but a camera's optical
frame, whose z looks along the axis; metres, radians and seconds.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from rosbags.typesys import Stores, get_typestore

from treadwell.poses import Floats
from treadwell.recording.recorded_camera import RecordedCamera

SECOND: Final = 1_000_000_000
_FLOAT32: Final = 7
"""Type of a cloud's column, as `sensor_msgs/PointField` counts them."""
_NOT_MEASURED: Final = -1.0
"""First entry of a covariance: the quantity is not measured (`sensor_msgs/Imu`)."""
_SQUARE, _FULL = 9, 36
"""Entries of a covariance of three and of six quantities; all zero: unknown."""

Quaternion = tuple[float, float, float, float]
"""x, y, z, w."""


class Ros2Messages:
    """Makes messages, and packs them.

    Attributes:
        store: ROS's definitions.
    """

    def __init__(self) -> None:
        """Read the definitions."""
        self.store = get_typestore(Stores.ROS2_HUMBLE)

    def packed(self, message: Any) -> bytes:  # noqa: ANN401 - a class of the library's making
        """Return a message as CDR, little-endian."""
        return bytes(self.store.serialize_cdr(message, message.__msgtype__))

    def image(self, stamp_ns: int, frame: str, depth: NDArray[np.float32]) -> Any:  # noqa: ANN401
        """Return a depth image.

        Args:
            stamp_ns: of its exposure.
            frame: the camera's optical frame.
            depth: (h, w) m, NaN where nothing was seen.
        """
        height, width = depth.shape
        return self._new(
            "sensor_msgs/msg/Image",
            header=self._header(stamp_ns, frame),
            height=height,
            width=width,
            encoding="32FC1",
            is_bigendian=0,
            step=4 * width,
            data=_bytes(depth.astype("<f4", copy=False)),
        )

    def camera_info(self, stamp_ns: int, frame: str, camera: RecordedCamera) -> Any:  # noqa: ANN401
        """Return what a camera without distortion sees."""
        focal, (column, row) = camera.focal, camera.centre
        k = [focal, 0.0, column, 0.0, focal, row, 0.0, 0.0, 1.0]
        p = [focal, 0.0, column, 0.0, 0.0, focal, row, 0.0, 0.0, 0.0, 1.0, 0.0]
        window = self._new(
            "sensor_msgs/msg/RegionOfInterest",
            x_offset=0,
            y_offset=0,
            height=0,
            width=0,
            do_rectify=False,
        )
        return self._new(
            "sensor_msgs/msg/CameraInfo",
            header=self._header(stamp_ns, frame),
            height=camera.height,
            width=camera.width,
            distortion_model="plumb_bob",
            d=np.zeros(5),
            k=np.array(k),
            r=np.eye(3).ravel(),
            p=np.array(p),
            binning_x=0,
            binning_y=0,
            roi=window,
        )

    def cloud(self, stamp_ns: int, frame: str, points: NDArray[np.float32]) -> Any:  # noqa: ANN401
        """Return a cloud in the order of an image.

        Args:
            stamp_ns: of its exposure.
            frame: what the points are in.
            points: (h, w, 3) m, NaN where nothing was seen.
        """
        height, width, _ = points.shape
        fields = [
            self._new(
                "sensor_msgs/msg/PointField", name=name, offset=4 * i, datatype=_FLOAT32, count=1
            )
            for i, name in enumerate("xyz")
        ]
        return self._new(
            "sensor_msgs/msg/PointCloud2",
            header=self._header(stamp_ns, frame),
            height=height,
            width=width,
            fields=fields,
            is_bigendian=False,
            point_step=12,
            row_step=12 * width,
            data=_bytes(points.astype("<f4", copy=False)),
            is_dense=not np.isnan(points).any(),
        )

    def odometry(
        self,
        stamp_ns: int,
        frames: tuple[str, str],
        pose: tuple[Sequence[float], Quaternion],
        twist: tuple[Sequence[float], Sequence[float]],
    ) -> Any:  # noqa: ANN401
        """Return odometry.

        Args:
            stamp_ns: its time.
            frames: the parent and the child.
            pose: place x, y, z m and turn of the child in the parent.
            twist: velocity m/s and angular velocity rad/s of the child, in the child's axes.
        """
        linear, angular = (self._vector(each) for each in twist)
        unknown = np.zeros(_FULL)
        return self._new(
            "nav_msgs/msg/Odometry",
            header=self._header(stamp_ns, frames[0]),
            child_frame_id=frames[1],
            pose=self._new(
                "geometry_msgs/msg/PoseWithCovariance", pose=self._pose(*pose), covariance=unknown
            ),
            twist=self._new(
                "geometry_msgs/msg/TwistWithCovariance",
                twist=self._new("geometry_msgs/msg/Twist", linear=linear, angular=angular),
                covariance=unknown,
            ),
        )

    def transforms(self, told: Sequence[tuple[int, str, str, Sequence[float], Quaternion]]) -> Any:  # noqa: ANN401
        """Return transforms: of each its time ns, parent, child, place x, y, z m and turn."""
        rows = [
            self._new(
                "geometry_msgs/msg/TransformStamped",
                header=self._header(stamp_ns, parent),
                child_frame_id=child,
                transform=self._new(
                    "geometry_msgs/msg/Transform",
                    translation=self._vector(place),
                    rotation=self._turn(turn),
                ),
            )
            for stamp_ns, parent, child, place, turn in told
        ]
        return self._new("tf2_msgs/msg/TFMessage", transforms=rows)

    def grid(
        self,
        stamp_ns: int,
        frame: str,
        origin: tuple[float, float],
        cell: float,
        cells: NDArray[np.int8],
    ) -> Any:  # noqa: ANN401
        """Return an occupancy grid.

        Args:
            stamp_ns: its time.
            frame: what the grid stands in.
            origin: x and y of the outer corner of its first cell, m.
            cell: side of a cell, m.
            cells: (rows, cols), row along y: 0 free, 100 occupied, -1 unknown.
        """
        rows, cols = cells.shape
        info = self._new(
            "nav_msgs/msg/MapMetaData",
            map_load_time=self._time(stamp_ns),
            resolution=cell,
            width=cols,
            height=rows,
            origin=self._pose((*origin, 0.0), (0.0, 0.0, 0.0, 1.0)),
        )
        header = self._header(stamp_ns, frame)
        return self._new(
            "nav_msgs/msg/OccupancyGrid", header=header, info=info, data=cells.ravel().copy()
        )

    def imu(self, stamp_ns: int, frame: str, angular: Floats, force: Floats) -> Any:  # noqa: ANN401
        """Return what an inertial measurement unit measured: no attitude.

        Args:
            stamp_ns: its time.
            frame: the unit's.
            angular: (3,) rad/s.
            force: (3,) m/s², specific force: +9.81 upwards at rest.
        """
        unknown = np.zeros(_SQUARE)
        none = unknown.copy()
        none[0] = _NOT_MEASURED
        return self._new(
            "sensor_msgs/msg/Imu",
            header=self._header(stamp_ns, frame),
            orientation=self._turn((0.0, 0.0, 0.0, 1.0)),
            orientation_covariance=none,
            angular_velocity=self._vector(angular.tolist()),
            angular_velocity_covariance=unknown,
            linear_acceleration=self._vector(force.tolist()),
            linear_acceleration_covariance=unknown,
        )

    def joints(
        self,
        stamp_ns: int,
        names: Sequence[str],
        position: Floats,
        velocity: Floats,
        effort: Floats | None = None,
    ) -> Any:  # noqa: ANN401
        """Return joints' angles rad, speeds rad/s and, where they are known, torques N m."""
        return self._new(
            "sensor_msgs/msg/JointState",
            header=self._header(stamp_ns, ""),
            name=list(names),
            position=position,
            velocity=velocity,
            effort=np.zeros(0) if effort is None else effort,
        )

    def pose(self, stamp_ns: int, frame: str, place: Sequence[float], turn: Quaternion) -> Any:  # noqa: ANN401
        """Return a pose with its time."""
        header = self._header(stamp_ns, frame)
        return self._new(
            "geometry_msgs/msg/PoseStamped", header=header, pose=self._pose(place, turn)
        )

    def text(self, text: str) -> Any:  # noqa: ANN401
        """Return a text."""
        return self._new("std_msgs/msg/String", data=text)

    @cached_property
    def _types(self) -> Any:  # noqa: ANN401
        return self.store.types

    def _new(self, kind: str, **fields: object) -> Any:  # noqa: ANN401
        return self._types[kind](**fields)

    def _time(self, stamp_ns: int) -> Any:  # noqa: ANN401
        seconds, rest = divmod(stamp_ns, SECOND)
        return self._new("builtin_interfaces/msg/Time", sec=seconds, nanosec=rest)

    def _header(self, stamp_ns: int, frame: str) -> Any:  # noqa: ANN401
        return self._new("std_msgs/msg/Header", stamp=self._time(stamp_ns), frame_id=frame)

    def _pose(self, place: Sequence[float], turn: Quaternion) -> Any:  # noqa: ANN401
        x, y, z = place
        point = self._new("geometry_msgs/msg/Point", x=x, y=y, z=z)
        return self._new("geometry_msgs/msg/Pose", position=point, orientation=self._turn(turn))

    def _vector(self, numbers: Sequence[float]) -> Any:  # noqa: ANN401
        x, y, z = numbers
        return self._new("geometry_msgs/msg/Vector3", x=x, y=y, z=z)

    def _turn(self, turn: Quaternion) -> Any:  # noqa: ANN401
        x, y, z, w = turn
        return self._new("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)


def _bytes(array: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.frombuffer(np.ascontiguousarray(array).tobytes(), np.uint8)
