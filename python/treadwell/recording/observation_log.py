"""`observations.mcap`: every observation of a run, bit for bit, in an open format that replays.

Channel `/observation` has one `treadwell_msgs/msg/Observation` a control tick, `/depth` one
`sensor_msgs/msg/Image` (32FC1, metres, NaN where nothing was seen) a camera frame: log time is its
arrival, publish time its exposure. Both are CDR with their ROS 2 definition inside, so that common
readers open them. Metadata `treadwell` says what was run; attachments hold the configuration and
the robot's description.
"""

import hashlib
import json
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Final

from mcap.exceptions import McapError
from mcap.reader import NonSeekingReader
from mcap.writer import CompressionType, Writer

from treadwell import __version__
from treadwell.errors import InputError, RecordingError
from treadwell.observation import Observation
from treadwell.recording import cdr
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario

NAME: Final = "observations.mcap"
_CHUNK: Final = 1 << 18
_LARGEST_RECORD: Final = 1 << 26


class ObservationLog:
    """Writes the file as the run goes on; what reached it stays readable."""

    def __init__(self, folder: Path, scenario: Scenario, robot: Robot) -> None:
        """Open the file and write what is run.

        Args:
            folder: the run's.
            scenario: as it is run.
            robot: the robot.

        Raises:
            RecordingError: the file cannot be written.
        """
        self._path = folder / NAME
        try:
            self._file = self._path.open("wb")
            self._writer = writer = Writer(
                self._file, chunk_size=_CHUNK, compression=CompressionType.ZSTD
            )
            writer.start(profile="ros2", library=f"treadwell {__version__}")
            self._observation = self._channel("/observation", "Observation", cdr.OBSERVATION)
            self._depth = self._channel("/depth", "sensor_msgs/msg/Image", cdr.IMAGE)
            words = {
                "version": __version__,
                "scenario": scenario.name,
                "seed": str(scenario.seed),
                "robot": robot.name,
                "robot_hash": folder_hash(robot.folder),
                "joints": ",".join(robot.joints),
            }
            writer.add_metadata("treadwell", words)
            for name, table in (
                ("configuration.json", scenario.configuration()),
                ("robot.json", robot.description()),
            ):
                text = json.dumps(table, allow_nan=False).encode()
                writer.add_attachment(0, 0, name, "application/json", text)
        except OSError as error:
            raise self._failed(error) from error

    def write(self, observation: Observation) -> None:
        """Append the measurements of a tick, and its frame where it has one.

        Raises:
            RecordingError: the file cannot be written.
        """
        time = observation.time_ns
        try:
            self._writer.add_message(self._observation, time, cdr.encode(observation), time)
            if observation.depth is not None:
                frame = observation.depth
                self._writer.add_message(
                    self._depth, frame.arrival_ns, cdr.encode_image(frame), frame.exposure_ns
                )
        except OSError as error:
            raise self._failed(error) from error

    def close(self) -> None:
        """Finish the file.

        Raises:
            RecordingError: the rest cannot be written.
        """
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.flush()
        except OSError as error:
            raise self._failed(error) from error
        finally:
            try:
                self._file.close()
            except OSError as error:
                raise self._failed(error) from error

    def _channel(self, topic: str, name: str, definition: str) -> int:
        full = name if "/" in name else f"treadwell_msgs/msg/{name}"
        schema = self._writer.register_schema(full, "ros2msg", definition.encode())
        return int(self._writer.register_channel(topic, "cdr", schema))

    def _failed(self, error: OSError) -> RecordingError:
        return RecordingError(
            f"{self._path}: writing failed, what was recorded before stays readable: "
            f"{error.strerror}"
        )


def read_observations(path: Path) -> Iterator[Observation]:
    """Return a file's observations in order.

    A file that breaks off gives what it has, and then raises.

    Raises:
        InputError: the file is missing, breaks off, or is none of this kind.
    """
    waiting: Observation | None = None
    with _opened(path) as file:
        try:
            reader = NonSeekingReader(file, record_size_limit=_LARGEST_RECORD)
            for _, channel, message in reader.iter_messages(log_time_order=False):
                if channel.topic == "/observation":
                    if waiting is not None:
                        yield waiting
                    waiting = cdr.decode(message.data)
                elif channel.topic == "/depth" and waiting is not None:
                    frame = cdr.decode_image(message.data, message.publish_time, message.log_time)
                    waiting = replace(waiting, depth=frame)
        except (McapError, ValueError, struct.error, EOFError, IndexError) as error:
            if waiting is not None:
                yield waiting
            raise InputError(f"{path}: breaks off or is no recording: {error}") from error
    if waiting is not None:
        yield waiting


def read_header(path: Path) -> dict[str, str]:
    """Return what the metadata says was run.

    Raises:
        InputError: the file is missing, or is none of this kind.
    """
    with _opened(path) as file:
        try:
            reader = NonSeekingReader(file, record_size_limit=_LARGEST_RECORD)
            for record in reader.iter_metadata():
                if record.name == "treadwell":
                    return dict(record.metadata)
        except (McapError, ValueError, struct.error, EOFError, IndexError) as error:
            raise InputError(f"{path}: breaks off or is no recording: {error}") from error
    raise InputError(f"{path}: was not written by treadwell")


def folder_hash(folder: Path) -> str:
    """Return the SHA-256 of a robot's files, names and contents, sorted by name."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0")
        digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()


def _opened(path: Path) -> BinaryIO:
    try:
        return path.open("rb")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
