"""Bags of ROS as frames: depth images, clouds and laser scans, placed by tf or odometry."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from treadwell.errors import InputError
from treadwell.recording.log_file import BrokenLogError
from treadwell.sources import ros_messages as ros
from treadwell.sources.bag_file import BagFile, Message, open_bag_file
from treadwell.sources.camera_file import read_camera
from treadwell.sources.cloud_table import Cloud
from treadwell.sources.clouds import around_its_middle
from treadwell.sources.depth_image import DepthUnit
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame, UnusableError
from treadwell.sources.transforms import Transforms

_WORDS: Final = {
    ros.IMAGE: "depth image",
    ros.COMPRESSED: "depth image",
    ros.CLOUD: "cloud",
    ros.SCAN: "laser scan",
}
_PACKED: Final = "/compressedDepth"


@dataclass(slots=True)
class _Survey:
    """What a bag holds: range data by topic, cameras, transforms."""

    transforms: Transforms = field(default_factory=Transforms)
    ranges: Counter[str] = field(default_factory=Counter)
    infos: dict[str, Any] = field(default_factory=dict)
    none: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class Bag:
    """A bag of ROS.

    Attributes:
        kind: "mcap", "ros1 bag" or "ros2 bag".
        path: the file or folder.
        frames: how many messages there are on the topics that are read.
        unused: reason -> count, of the frames so far.
        notes: what its user should know.
    """

    kind: str
    path: Path
    file: BagFile
    transforms: Transforms
    topics: list[str]
    cameras: dict[str, PinholeCamera]
    scale: float
    pose_within: float
    frames: int
    found: list[str]
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the frames that have all that is needed, in the order in which they were recorded.

        Raises:
            InputError: the bag is broken before its first frame.
        """
        self.unused.clear()
        self.notes[:] = self.found
        units = {topic: DepthUnit(self.notes) for topic in self.topics}
        for topic, log_ns, data in _whole(self.file.messages(self.topics), self.notes):
            try:
                message = self.file.decode(topic, data)
                yield self._frame(topic, message, ros.stamp_of(message, log_ns), units[topic])
            except UnusableError as reason:
                self.unused[str(reason)] += 1

    def _frame(self, topic: str, message: Any, time: float, unit: DepthUnit) -> RangeFrame:  # noqa: ANN401
        frame, kind = str(message.header.frame_id), self.file.topics[topic]
        root = self.transforms.root(frame)
        if root is None:
            self._note(f"no transform says where the frame {frame[:60]!r} is")
            raise UnusableError("no transform from the sensor's frame")
        pose = self.transforms.pose(frame, time, self.pose_within)
        own = getattr(message, "own_pose", None)
        if own is not None:
            pose = pose @ own
        self._note(f"poses are in the frame {root[:60]!r}")
        if kind in (ros.IMAGE, ros.COMPRESSED):
            camera = self.cameras[topic]
            depth = unit.metres(ros.depth_of(message, kind, camera, self.scale))
            return RangeFrame(time, pose, camera, depth, None, "picture")
        if kind == ros.SCAN:
            scan = ros.scan_of(message)
            if np.isnan(scan[:, 0]).all():
                raise UnusableError("no point")
            return RangeFrame(time, pose, None, None, scan, "scan")
        return self._cloud(message, time, pose, in_root=own is None and frame.lstrip("/") == root)

    def _cloud(self, message: Any, time: float, pose: Floats, *, in_root: bool) -> RangeFrame:  # noqa: ANN401
        """Return a cloud; where its sensor was is not known of one that is in the world's frame."""
        points, colour = ros.cloud_of(message)
        if in_root:
            self._note("clouds are in the world's frame: where their sensor was is not known")
            frame = around_its_middle(Cloud(points, colour), time, self.notes)
            if frame is None:
                raise UnusableError("no point")
            return frame
        near = points.astype(np.float32)
        near[~near.any(axis=1)] = np.nan  # nothing is seen in the sensor itself
        if np.isnan(near[:, 0]).all():
            raise UnusableError("no point")
        return RangeFrame(time, pose, None, None, near, "cloud", colour)

    def _note(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)


def open_bag(
    path: Path, camera: Path | None, topics: Sequence[str], pose_within: float
) -> Bag | None:
    """Open a bag, and look through it for cameras and transforms; None: it is not named like one.

    Args:
        path: the file or folder.
        camera: a `camera.toml` that takes the place of a camera's info.
        topics: those to read; none: the only one that has range data.
        pose_within: s, how far off in time a transform may be.

    Raises:
        InputError: it is broken, lacks what frames need, or leaves a choice of topics.
    """
    found = open_bag_file(path)
    if found is None:
        return None
    kind, file = found
    survey = _survey(path, file)
    chosen = _chosen(path, file, survey, topics)
    if not survey.transforms.count:
        raise InputError(
            f"{path}: has neither tf nor odometry, one of which must say where the sensor was"
        )
    cameras, scale = {}, ros.MILLIMETRES_A_METRE
    told = None if camera is None else read_camera(camera)
    if told is not None and told.depth_scale is not None:
        scale = told.depth_scale
    for topic in chosen:
        if file.topics[topic] in (ros.IMAGE, ros.COMPRESSED):
            own = told.camera() if told is not None else _camera(path, topic, survey)
            cameras[topic] = own
    if camera is not None and not cameras:
        raise InputError(f"--camera: found {camera}; {', '.join(chosen)} has no use for it")
    frames = sum(survey.ranges[topic] for topic in chosen)
    return Bag(
        kind,
        path,
        file,
        survey.transforms,
        chosen,
        cameras,
        scale,
        pose_within,
        frames,
        survey.notes,
    )


def _survey(path: Path, file: BagFile) -> _Survey:
    """Read all that is no range data, and count what is."""
    survey = _Survey()
    kinds = {*_WORDS, ros.INFO, ros.ODOMETRY, *ros.TRANSFORMS}
    wanted = [topic for topic, kind in file.topics.items() if kind in kinds]
    try:
        for topic, log_ns, data in _whole(file.messages(wanted), survey.notes):
            try:
                _take(survey, file, topic, log_ns, data)
            except UnusableError:
                _note(survey.notes, f"some messages of {topic[:100]} cannot be read")
    except BrokenLogError:
        raise
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None
    for frame in sorted(survey.transforms.doubted)[:10]:
        _note(survey.notes, f"the frame {frame[:60]!r} has two parents; the first one counts")
    return survey


def _take(survey: _Survey, file: BagFile, topic: str, log_ns: int, data: bytes) -> None:
    """Take in one message."""
    kind = file.topics[topic]
    if kind in _WORDS:
        seen = topic in survey.ranges or topic in survey.none
        picture = kind in (ros.IMAGE, ros.COMPRESSED)
        if picture and not seen and not ros.is_depth(file.decode(topic, data), kind):
            survey.none.add(topic)
        if topic not in survey.none:
            survey.ranges[topic] += 1
        return
    message = file.decode(topic, data)
    if kind == ros.INFO:
        survey.infos.setdefault(topic, message)
    elif kind == ros.ODOMETRY:
        pose = message.pose.pose
        survey.transforms.add_odometry(
            message.header.frame_id,
            message.child_frame_id,
            ros.stamp_of(message, log_ns),
            _numbers(pose.position, pose.orientation),
        )
    else:
        for each in message.transforms:
            survey.transforms.add(
                each.header.frame_id,
                each.child_frame_id,
                ros.stamp_of(each, log_ns),
                _numbers(each.transform.translation, each.transform.rotation),
                fixed=topic.endswith("tf_static"),
            )


def _numbers(place: Any, turn: Any) -> tuple[float, ...]:  # noqa: ANN401
    return place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w


def _chosen(path: Path, file: BagFile, survey: _Survey, topics: Sequence[str]) -> list[str]:
    """Return the topics that are read."""
    there = ", ".join(
        f"{topic[:100]} ({_WORDS[file.topics[topic]]})" for topic in sorted(survey.ranges)[:20]
    )
    if not survey.ranges:
        raise InputError(
            f"{path}: has no range data: depth images (sensor_msgs/Image of 16UC1 or 32FC1), "
            "clouds (PointCloud2) or laser scans (LaserScan)"
        )
    for topic in topics:
        if topic not in survey.ranges:
            raise InputError(f"--topic: found {topic[:100]}; {path} has {there}")
    if not topics and len(survey.ranges) > 1:
        raise InputError(
            f"{path}: has several topics with range data; name those to read by --topic: {there}"
        )
    return list(dict.fromkeys(topics)) or list(survey.ranges)


def _camera(path: Path, topic: str, survey: _Survey) -> PinholeCamera:
    """Return the camera of a topic's images: of the info beside them."""
    plain = topic.removesuffix(_PACKED)
    near = plain.rpartition("/")[0]
    there = [name for name in survey.infos if name.rpartition("/")[0] in (near, plain)]
    beside = f"{near}/camera_info" if f"{near}/camera_info" in there else there[0] if there else ""
    if not beside or (len(there) > 1 and not beside.endswith("/camera_info")):
        lacks = _without_info(plain, there, survey)
        raise InputError(f"{path}: {topic}: {lacks}; name a camera.toml by --camera")
    info = survey.infos[beside]
    camera = ros.camera_of(info, topic)
    if camera is None:
        raise InputError(
            f"{path}: {beside}: is of no pinhole camera: its size and focal lengths must be "
            "positive; name a camera.toml by --camera"
        )
    if "rect" not in topic and ros.is_distorted(info):
        _note(survey.notes, f"the lens of {topic[:100]} is distorted, which is not taken out")
    return camera


def _without_info(plain: str, there: Sequence[str], survey: _Survey) -> str:
    """Say of an image without a camera where its info was looked for, and which there are."""
    near = plain.rpartition("/")[0]
    found = ", ".join(name[:100] for name in sorted(there or survey.infos)[:20])
    if there:
        return f"has several camera infos beside it, none called camera_info ({found})"
    elsewhere = f"; elsewhere there is {found}" if found else ""
    return f"has no camera info ({near}/camera_info or {plain}/camera_info){elsewhere}"


def _whole(messages: Iterator[Message], notes: list[str]) -> Iterator[Message]:
    """Yield messages up to where their file breaks off, which becomes a note."""
    given = 0
    try:
        for message in messages:
            given += 1
            yield message
    except BrokenLogError as error:
        if not given:
            raise
        _note(notes, f"{error}; what came before is used")


def _note(notes: list[str], note: str) -> None:
    if note not in notes:
        notes.append(note)
