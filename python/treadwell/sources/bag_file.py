"""Bags of ROS as messages by topic: MCAP, ROS 1's `.bag`, and ROS 2's folders and databases.

MCAP is framed by our own reader, which is bounded; `rosbags` reads the other files, and makes
objects of all messages, by ROS's own definitions: those in the file are not asked, for they are a
stranger's and would become code.
"""

import bz2
import re
from collections.abc import Collection, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import lz4.frame

from treadwell.errors import InputError
from treadwell.files import opened, read_text
from treadwell.recording.log_file import LARGEST_RECORD, read_channels, read_messages
from treadwell.sources import foxglove_messages
from treadwell.sources.folders import files_in
from treadwell.sources.frame import UnusableError
from treadwell.sources.ros_messages import TRANSFORMS

if TYPE_CHECKING:
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2
    from rosbags.typesys.store import Typestore

METADATA: Final = "metadata.yaml"
_BEGIN: Final = b"#ROSBAG V2.0\n"
_LARGEST_METADATA: Final = 1_000_000
Message = tuple[str, int, bytes]
"""Topic, when it was recorded in ns, content."""


def ros2_name(name: str) -> str:
    """Return a type's name as ROS 2 writes it: of ROS 1 it lacks the middle."""
    package, _, rest = name.partition("/")
    return name if "/" in rest else f"{package}/msg/{rest}"


def definitions(*, ros1: bool) -> "Typestore":
    """Return ROS's own definitions of messages, those of ROS 1 with its transforms."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    if not ros1:
        return get_typestore(Stores.ROS2_HUMBLE)
    store = get_typestore(Stores.ROS1_NOETIC)
    for name in TRANSFORMS:
        store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", name))
    return store


class _Decoder:
    """Makes objects of messages, by ROS's own definitions."""

    def __init__(self, *, ros1: bool) -> None:
        self._ros1 = ros1
        self._store = definitions(ros1=ros1)

    def decode(self, data: bytes, kind: str) -> Any:  # noqa: ANN401
        """Return a message's content.

        Raises:
            UnusableError: it is broken.
        """
        try:
            if self._ros1:
                return self._store.deserialize_ros1(data, kind)
            return self._store.deserialize_cdr(data, kind)
        except Exception:
            raise UnusableError("message that cannot be read") from None


class McapFiles:
    """The `.mcap` files of a recording, one behind the other.

    Attributes:
        topics: name -> type, of the messages that can be read.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        """Look for topics.

        Raises:
            InputError: a file is none, or breaks off before its first channel.
        """
        self._paths = paths
        self.topics: dict[str, str] = {}
        self._ros1: set[str] = set()
        self._foxglove: dict[str, str] = {}
        for path in paths:
            for topic, channel in read_channels(path).items():
                if channel.encoding in ("cdr", "ros1"):
                    self.topics[topic] = ros2_name(channel.schema)
                if channel.encoding == "ros1":
                    self._ros1.add(topic)
                if channel.encoding == "protobuf" and channel.schema in foxglove_messages.KINDS:
                    self.topics[topic] = foxglove_messages.KINDS[channel.schema]
                    self._foxglove[topic] = channel.schema

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Yield the messages of some topics.

        Raises:
            BrokenLogError: a file breaks off, after all that is whole was given.
        """
        for path in self._paths:
            for message in read_messages(path, list(topics)):
                yield message.topic, message.log_ns, message.data

    def decode(self, topic: str, data: bytes) -> Any:  # noqa: ANN401
        """Return a message's content; see `_Decoder.decode`."""
        if topic in self._foxglove:
            return foxglove_messages.decode(data, self._foxglove[topic])
        decoder = self._of_ros1 if topic in self._ros1 else self._of_ros2
        return decoder.decode(data, self.topics[topic])

    @cached_property
    def _of_ros1(self) -> _Decoder:
        return _Decoder(ros1=True)

    @cached_property
    def _of_ros2(self) -> _Decoder:
        return _Decoder(ros1=False)


class RosbagsFile:
    """A bag that `rosbags` reads.

    Attributes:
        topics: name -> type, of its messages.
    """

    def __init__(self, path: Path, *, ros1: bool) -> None:
        """Open the bag and look for topics.

        Raises:
            InputError: it is broken.
        """
        self._path, self._ros1 = path, ros1
        self._decoder = _Decoder(ros1=ros1)
        self.topics: dict[str, str] = {}
        try:
            with self._reader() as reader:
                self.topics = {each.topic: each.msgtype for each in reader.connections}
        except Exception as error:
            raise self._broken(error) from None

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """Yield the messages of some topics.

        Raises:
            InputError: the bag is broken.
        """
        if not topics:
            return
        try:
            with self._reader() as reader:
                wanted = [each for each in reader.connections if each.topic in topics]
                for connection, time_ns, data in reader.messages(wanted):
                    yield connection.topic, time_ns, data
        except InputError:
            raise
        except Exception as error:
            raise self._broken(error) from None

    def decode(self, topic: str, data: bytes) -> Any:  # noqa: ANN401
        """Return a message's content; see `_Decoder.decode`."""
        return self._decoder.decode(data, self.topics[topic])

    def _reader(self) -> "Reader1 | Reader2":
        if not self._ros1:
            from rosbags.rosbag2 import Reader as Reader2

            return Reader2(self._path)
        from rosbags.rosbag1 import Reader as Reader1
        from rosbags.rosbag1 import reader

        # The library's own unpack whatever a few bytes ask for.
        reader.decompressors.update(bz2=_unpacked_bz2, lz4=_unpacked_lz4)
        return Reader1(self._path)

    def _broken(self, error: Exception) -> InputError:
        what = " ".join(str(error).split())[:200] or "its records are damaged"
        return InputError(f"{self._path}: breaks off or is no bag: {what}")


def _unpacked_bz2(data: bytes) -> bytes:
    return _bounded(bz2.BZ2Decompressor().decompress(data, LARGEST_RECORD + 1))


def _unpacked_lz4(data: bytes) -> bytes:
    return _bounded(lz4.frame.LZ4FrameDecompressor().decompress(data, LARGEST_RECORD + 1))


def _bounded(data: bytes) -> bytes:
    if len(data) > LARGEST_RECORD:
        raise ValueError(f"a chunk of more than {LARGEST_RECORD} bytes")
    return data


BagFile = McapFiles | RosbagsFile


def open_bag_file(path: Path) -> tuple[str, BagFile] | None:
    """Open a bag, and return which kind it is; None: it is not named like one.

    Raises:
        InputError: it is broken, or a part of it is no file.
    """
    if path.is_dir():
        return _folder(path) if (path / METADATA).exists() else None
    suffix = path.suffix.lower()
    if suffix not in (".mcap", ".bag", ".db3"):
        return None
    with opened(path) as file:
        if suffix == ".bag" and file.read(len(_BEGIN)) != _BEGIN:
            # The library reads all of a file that has no end of a line.
            raise InputError(f"{path}: is no bag of ROS 1: it must begin with #ROSBAG V2.0")
    if suffix == ".mcap":
        return "mcap", McapFiles([path])
    return ("ros1 bag" if suffix == ".bag" else "ros2 bag"), RosbagsFile(
        path, ros1=suffix == ".bag"
    )


def _folder(path: Path) -> tuple[str, BagFile]:
    told = read_text(path / METADATA, _LARGEST_METADATA)
    if re.search(r"compression_mode:\s*[\"']?file", told, re.IGNORECASE):
        raise InputError(f"{path}: its files are packed as a whole: unpack them first (zstd -d)")
    files = files_in(path)
    for file in files:
        if not file.is_dir():
            opened(file).close()
    logs = [file for file in files if file.suffix.lower() == ".mcap"]
    if logs:
        return "ros2 bag", McapFiles(logs)
    return "ros2 bag", RosbagsFile(path, ros1=False)
