"""Made bags of ROS: what they hold is one list, which every kind of bag is written from."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys.store import Typestore
from source_builders import CAMERA, COLOURS, POINTS, picture

from treadwell.sources.bag_file import definitions

SECOND: Final = 1_000_000_000
ROS1, ROS2 = definitions(ros1=True), definitions(ros1=False)
TF: Final = "tf2_msgs/msg/TFMessage"
Told = tuple[str, str, int, Callable[[Typestore], Any]]
"""Topic, type, time in ns, and what makes the message."""


def _new(store: Typestore, kind: str, **fields: Any) -> Any:  # noqa: ANN401
    return store.types[kind](**fields)


def _header(store: Typestore, time_ns: int, frame: str) -> Any:  # noqa: ANN401
    stamp = _new(
        store, "builtin_interfaces/msg/Time", sec=time_ns // SECOND, nanosec=time_ns % SECOND
    )
    fields = {"seq": 0} if store is ROS1 else {}
    return _new(store, "std_msgs/msg/Header", stamp=stamp, frame_id=frame, **fields)


def _pose(store: Typestore, row: Iterable[float], kind: str) -> Any:  # noqa: ANN401
    x, y, z, qx, qy, qz, qw = row
    turn = _new(store, "geometry_msgs/msg/Quaternion", x=qx, y=qy, z=qz, w=qw)
    if kind == "Transform":
        place = _new(store, "geometry_msgs/msg/Vector3", x=x, y=y, z=z)
        return _new(store, "geometry_msgs/msg/Transform", translation=place, rotation=turn)
    place = _new(store, "geometry_msgs/msg/Point", x=x, y=y, z=z)
    return _new(store, "geometry_msgs/msg/Pose", position=place, orientation=turn)


def transform(
    parent: str, child: str, time_ns: int, row: Iterable[float], topic: str = "/tf"
) -> Told:
    def make(store: Typestore) -> Any:  # noqa: ANN401
        one = _new(
            store,
            "geometry_msgs/msg/TransformStamped",
            header=_header(store, time_ns, parent),
            child_frame_id=child,
            transform=_pose(store, row, "Transform"),
        )
        return _new(store, TF, transforms=[one])

    return topic, TF, time_ns, make


def odometry(parent: str, child: str, time_ns: int, row: Iterable[float]) -> Told:
    def make(store: Typestore) -> Any:  # noqa: ANN401
        zero = _new(store, "geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        still = _new(store, "geometry_msgs/msg/Twist", linear=zero, angular=zero)
        none = np.zeros(36)
        return _new(
            store,
            "nav_msgs/msg/Odometry",
            header=_header(store, time_ns, parent),
            child_frame_id=child,
            pose=_new(
                store,
                "geometry_msgs/msg/PoseWithCovariance",
                pose=_pose(store, row, "Pose"),
                covariance=none,
            ),
            twist=_new(
                store, "geometry_msgs/msg/TwistWithCovariance", twist=still, covariance=none
            ),
        )

    return "/odom", "nav_msgs/msg/Odometry", time_ns, make


def image(
    time_ns: int,
    numbers: NDArray[Any] | None = None,
    encoding: str = "32FC1",
    topic: str = "/camera/depth/image_raw",
    frame: str = "camera",
    padding: int = 0,
) -> Told:
    numbers = picture().astype("<f4") if numbers is None else numbers

    def make(store: Typestore) -> Any:  # noqa: ANN401
        rows = np.frombuffer(numbers.tobytes(), np.uint8).reshape(len(numbers), -1)
        rows = np.pad(rows, ((0, 0), (0, padding)))
        return _new(
            store,
            "sensor_msgs/msg/Image",
            header=_header(store, time_ns, frame),
            height=len(numbers),
            width=numbers.shape[1],
            encoding=encoding,
            is_bigendian=int(numbers.dtype.byteorder == ">"),
            step=rows.shape[1],
            data=rows.ravel(),
        )

    return topic, "sensor_msgs/msg/Image", time_ns, make


def info(time_ns: int = SECOND, topic: str = "/camera/depth/camera_info", **changed: float) -> Told:
    c = {**CAMERA, "d": 0.0, **changed}

    def make(store: Typestore) -> Any:  # noqa: ANN401
        k = np.array([c["fx"], 0.0, c["cx"], 0.0, c["fy"], c["cy"], 0.0, 0.0, 1.0])
        d, r, p = np.full(5, c["d"]), np.eye(3).ravel(), np.zeros(12)
        letters = {"d": d, "k": k, "r": r, "p": p}
        if store is ROS1:
            letters = {name.upper(): value for name, value in letters.items()}
        area = _new(
            store,
            "sensor_msgs/msg/RegionOfInterest",
            x_offset=0,
            y_offset=0,
            height=0,
            width=0,
            do_rectify=False,
        )
        return _new(
            store,
            "sensor_msgs/msg/CameraInfo",
            header=_header(store, time_ns, "camera"),
            height=int(c["height"]),
            width=int(c["width"]),
            distortion_model="plumb_bob",
            binning_x=0,
            binning_y=0,
            roi=area,
            **letters,
        )

    return topic, "sensor_msgs/msg/CameraInfo", time_ns, make


def cloud(
    time_ns: int,
    points: NDArray[np.float64] = POINTS,
    kind: str = "<f4",
    frame: str = "camera",
    topic: str = "/points",
) -> Told:
    types = [("pad", "u1", 4), *((name, kind) for name in "xyz"), ("rgb", f"{kind[0]}u4")]
    rows = np.zeros(len(points), types)
    for number, name in enumerate("xyz"):
        rows[name] = points[:, number]
    red, green, blue = np.resize(COLOURS, (len(points), 3)).T.astype(np.uint32)
    rows["rgb"] = red << 16 | green << 8 | blue

    def make(store: Typestore) -> Any:  # noqa: ANN401
        number = {"f4": 7, "f8": 8, "i2": 3}
        fields = [
            _new(
                store,
                "sensor_msgs/msg/PointField",
                name=name,
                offset=rows.dtype.fields[name][1],  # type: ignore[index]
                datatype=7 if name == "rgb" else number[kind[1:]],
                count=1,
            )
            for name in ("x", "y", "z", "rgb")
        ]
        return _new(
            store,
            "sensor_msgs/msg/PointCloud2",
            header=_header(store, time_ns, frame),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=kind[0] == ">",
            point_step=rows.itemsize,
            row_step=rows.nbytes,
            data=np.frombuffer(rows.tobytes(), np.uint8),
            is_dense=False,
        )

    return topic, "sensor_msgs/msg/PointCloud2", time_ns, make


def scan(time_ns: int, ranges: Iterable[float], topic: str = "/scan") -> Told:
    def make(store: Typestore) -> Any:  # noqa: ANN401
        return _new(
            store,
            "sensor_msgs/msg/LaserScan",
            header=_header(store, time_ns, "camera"),
            angle_min=-np.pi / 2,
            angle_max=np.pi / 2,
            angle_increment=np.pi / 2,
            time_increment=0.0,
            scan_time=0.1,
            range_min=0.1,
            range_max=30.0,
            ranges=np.array(list(ranges), np.float32),
            intensities=np.zeros(0, np.float32),
        )

    return topic, "sensor_msgs/msg/LaserScan", time_ns, make


TURN: Final = 0.7071067811865476
MOUNT: Final = (0.5, 0.0, 1.0, 0.0, 0.0, TURN, TURN)
"""Of the camera on the robot: a quarter turn to the left."""


def way(last: int = 3) -> list[Told]:
    """A robot that goes a metre a second along x, with a camera fixed to it."""
    mount = transform("base", "camera", 0, MOUNT, "/tf_static")
    steps = range(SECOND, last * SECOND + 1, SECOND // 100)
    return [mount, *(transform("map", "base", t, (t / SECOND, 0, 0, 0, 0, 0, 1)) for t in steps)]


def depth_bag() -> list[Told]:
    """Three depth images of a robot that moves, with all that they need."""
    images = [image(t * SECOND + 3_000_000) for t in (1, 2, 3)]
    return [info(), *way(), *images]


KINDS: Final = ("mcap", "ros1 bag", "ros2 bag", "ros2 mcap", "db3")


def write_bag(folder: Path, kind: str, told: Iterable[Told]) -> Path:
    """Write a bag of a kind, and return what to open."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = sorted(told, key=lambda each: each[2])
    if kind == "ros1 bag":
        path = folder / "a.bag"
        with Writer1(path) as writer:
            ids: dict[str, Any] = {}
            for topic, name, time_ns, make in rows:
                if topic not in ids:
                    ids[topic] = writer.add_connection(topic, name, typestore=ROS1)
                data = ROS1.serialize_ros1(make(ROS1), name)
                writer.write(ids[topic], time_ns, data)
        return path
    path = folder / "bag"
    plugin = StoragePlugin.SQLITE3 if kind in ("ros2 bag", "db3") else StoragePlugin.MCAP
    with Writer2(path, version=9, storage_plugin=plugin) as writer2:
        ids = {}
        for topic, name, time_ns, make in rows:
            if topic not in ids:
                ids[topic] = writer2.add_connection(topic, name, typestore=ROS2)
            writer2.write(ids[topic], time_ns, ROS2.serialize_cdr(make(ROS2), name))
    if kind in ("ros2 bag", "ros2 mcap"):
        return path
    return next(path.glob("*.db3" if kind == "db3" else "*.mcap"))
