"""`observations.mcap`: every observation of a run, bit for bit, in an open format that replays.

Channel `/observation` has one `treadwell_msgs/msg/Observation` a control tick, `/depth` one
`sensor_msgs/msg/Image` (32FC1, metres, NaN where nothing was seen) a camera frame: log time is its
arrival, publish time its exposure. `/command` (`JointTargets`) and `/estimate` (`Estimate`) are
what the core answered to the tick's observation; `/truth` (`geometry_msgs/msg/PoseStamped`) is
where the robot truly stood when the tick was over. All are CDR with their ROS 2 definition inside,
so that common readers open them. Metadata `treadwell` says what was run, with hashes; attachments
hold the configuration, the robot's description, and what the core was made of.

What `replay` hands to the core comes from `read_observations` alone, which skips all else.
"""

import hashlib
import json
import struct
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

from treadwell._core import Octree
from treadwell._core import version as core_version
from treadwell.errors import InputError, RecordingError
from treadwell.files import opened, read_content
from treadwell.observation import Frame, Observation
from treadwell.processor import processor
from treadwell.recording import cdr, messages
from treadwell.recording.file import write_fault
from treadwell.recording.log_file import (
    LARGEST_RECORD,
    BrokenLogError,
    Front,
    read_front,
    read_in_order,
)
from treadwell.recording.log_writer import Entry, LogWriter
from treadwell.scenario.model import Scenario
from treadwell.version import __version__

if TYPE_CHECKING:
    from treadwell.core_settings import CoreInput
    from treadwell.robot.load import Robot

NAME: Final = "observations.mcap"
CONFIGURATION, ROBOT, CORE, STATIC_MAP = (
    "configuration.json",
    "robot.json",
    "core.json",
    "static_map.ot",
)
"""Names of the attachments."""
_CHUNK: Final = 1 << 18


class ObservationLog:
    """Writes the file as the run goes on; what reached it stays readable."""

    def __init__(
        self, folder: Path, scenario: Scenario, robot: "Robot", core: "CoreInput | None" = None
    ) -> None:
        """Open the file and write what is run.

        Args:
            folder: the run's.
            scenario: as it is run.
            robot: the robot.
            core: what the core was made of; without it the file cannot be replayed.

        Raises:
            RecordingError: the file cannot be written.
        """
        self._path = folder / NAME
        try:
            self._file = self._path.open("wb")
            library = f"treadwell {__version__}"
            self._writer = writer = LogWriter(self._file, _CHUNK, "ros2", library)
            self._observation = self._channel("/observation", "Observation", cdr.OBSERVATION)
            self._depth = self._channel("/depth", "sensor_msgs/msg/Image", cdr.IMAGE)
            self._command = self._channel("/command", "JointTargets", messages.COMMAND)
            self._estimate = self._channel("/estimate", "Estimate", messages.ESTIMATE)
            pose = "geometry_msgs/msg/PoseStamped"
            self._truth = self._channel("/truth", pose, messages.TRUTH)
            words = {
                "version": __version__,
                "core_version": core_version(),
                "processor": processor(),
                "scenario_hash": hash_of(scenario.configuration()),
                "scenario": scenario.name,
                "seed": str(scenario.seed),
                "robot": robot.name,
                "robot_hash": folder_hash(robot.folder),
                "joints": ",".join(robot.joints),
            }
            writer.add_metadata("treadwell", words)
            tables = {CONFIGURATION: scenario.configuration(), ROBOT: robot.description()}
            if core is not None:
                tables[CORE] = _core_table(core)
            for name, table in tables.items():
                text = json.dumps(table, allow_nan=False).encode()
                writer.add_attachment(name, "application/json", text)
            if core is not None and core.static_map is not None:
                told = _octree_bytes(core.static_map)
                writer.add_attachment(STATIC_MAP, "application/octet-stream", told)
        except OSError as error:
            raise self._failed(error) from error

    def write(self, observation: Observation) -> None:
        """Append the measurements of a tick, and its frame where it has one.

        Raises:
            RecordingError: the file cannot be written.
        """
        self.append(self.observed(observation))

    def write_answer(self, time_ns: int, command: bytes, estimate: bytes) -> None:
        """Append what the core answered to a tick's observation, as `answered` has it.

        Raises:
            RecordingError: the file cannot be written.
        """
        self.append(self.answered(time_ns, command, estimate))

    def write_truth(
        self, time_ns: int, position: tuple[float, ...], quaternion: tuple[float, ...]
    ) -> None:
        """Append where the robot truly stands, as `stood` has it.

        Raises:
            RecordingError: the file cannot be written.
        """
        self.append(self.stood(time_ns, position, quaternion))

    def observed(self, observation: Observation) -> list[Entry]:
        """Return the messages of a tick's measurements, and of its frame where it has one."""
        time, frame = observation.time_ns, observation.depth
        entries = [(self._observation, time, time, cdr.encode(observation))]
        if frame is not None:
            image = cdr.encode_image(frame)
            entries.append((self._depth, frame.arrival_ns, frame.exposure_ns, image))
        return entries

    def answered(self, time_ns: int, command: bytes, estimate: bytes) -> list[Entry]:
        """Return the messages of what the core answered to a tick's observation.

        Args:
            time_ns: the observation's, nanoseconds since the start.
            command: the message `COMMAND`.
            estimate: the message `ESTIMATE`.
        """
        return [
            (self._command, time_ns, time_ns, command),
            (self._estimate, time_ns, time_ns, estimate),
        ]

    def stood(
        self, time_ns: int, position: tuple[float, ...], quaternion: tuple[float, ...]
    ) -> list[Entry]:
        """Return the message of where the robot truly stands.

        Args:
            time_ns: nanoseconds since the start.
            position: x, y, z m, of the robot's frame in the map.
            quaternion: x, y, z, w.
        """
        message = messages.encode_truth(time_ns, position, quaternion)
        return [(self._truth, time_ns, time_ns, message)]

    def append(self, entries: Iterable[Entry]) -> None:
        """Append messages.

        Raises:
            RecordingError: the file cannot be written.
        """
        try:
            self._writer.add_messages(entries)
        except OSError as error:
            raise self._failed(error) from error

    def flush(self) -> None:
        """Put what was appended into the file, where it outlives the process.

        Raises:
            RecordingError: the file cannot be written.
        """
        try:
            self._writer.flush()
        except OSError as error:
            raise self._failed(error) from error

    def close(self) -> None:
        """Finish the file.

        Raises:
            RecordingError: the rest cannot be written.
        """
        try:
            self._writer.finish()
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
        return self._writer.add_channel(topic, full, definition)

    def _failed(self, error: OSError) -> RecordingError:
        return RecordingError(
            f"{self._path}: writing failed, what was recorded before stays readable: "
            f"{write_fault(self._path, error)}"
        )


def read_observations(path: Path) -> Iterator[Observation]:
    """Return a file's observations in order: all that a replayed core is given, and no truth.

    A frame belongs to the first observation that is no earlier than its arrival. A file that breaks
    off gives what it has, and then raises.

    Raises:
        InputError: the file is missing, breaks off, or is none of this kind.
    """
    waiting: Observation | None = None
    frame: Frame | None = None
    try:
        for message in read_in_order(path, ("/observation", "/depth")):
            if message.topic == "/observation":
                if waiting is not None:
                    yield waiting
                    waiting = None
                waiting = replace(cdr.decode(message.data), depth=frame)
                frame = None
            else:
                frame = cdr.decode_image(message.data, message.publish_ns, message.log_ns)
                if waiting is not None and message.log_ns <= waiting.time_ns:
                    waiting, frame = replace(waiting, depth=frame), None
    except BrokenLogError:
        if waiting is not None:
            yield waiting
        raise
    except (ValueError, struct.error) as error:
        raise BrokenLogError(f"{path}: is no recording: {error}", 0) from None
    if waiting is not None:
        yield waiting


def read_answers(path: Path) -> Iterator[tuple[bytes, bytes]]:
    """Return what the core answered to each observation: the messages `COMMAND` and `ESTIMATE`.

    Raises:
        InputError: the file is missing, breaks off, or is none of this kind.
    """
    command, time_ns = b"", -1
    for message in read_in_order(path, ("/command", "/estimate")):
        if message.topic == "/command":
            command, time_ns = message.data, message.log_ns
        else:
            yield command if message.log_ns == time_ns else b"", message.data


def read_truth(path: Path) -> Iterator[tuple[float, ...]]:
    """Return where the robot truly stood after each tick: x, y, z m and x, y, z, w.

    For scores; nothing of it may enter the core.

    Raises:
        InputError: the file is missing, breaks off, or is none of this kind.
    """
    for message in read_in_order(path, ("/truth",)):
        try:
            yield messages.decode_truth(message.data)
        except ValueError as error:
            raise BrokenLogError(f"{path}: is no recording: {error}", 0) from None


def read_header(path: Path) -> dict[str, str]:
    """Return what the metadata says was run.

    Raises:
        InputError: the file is missing, or is none of this kind.
    """
    return header_of(read_front(path), path)


def header_of(front: Front, path: Path) -> dict[str, str]:
    """Return what the metadata of a file's front says was run.

    Raises:
        InputError: there is none.
    """
    if "treadwell" not in front.metadata:
        raise InputError(f"{path}: was not written by treadwell")
    return front.metadata["treadwell"]


def read_octree(content: bytes, where: str) -> Octree:
    """Return the octree of an attachment.

    Raises:
        InputError: it is none.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / STATIC_MAP
        path.write_bytes(content)
        try:
            return Octree.read(str(path))
        except InputError as error:
            raise InputError(f"{where}: {error}") from None


def hash_of(configuration: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a scenario as it is run, its keys sorted."""
    table = json.dumps(configuration, allow_nan=False, sort_keys=True)
    return hashlib.sha256(table.encode()).hexdigest()


def _octree_bytes(octree: Octree) -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / STATIC_MAP
        octree.write(str(path))
        return read_content(path, LARGEST_RECORD)


def _core_table(core: "CoreInput") -> dict[str, Any]:
    return {
        "settings": json.loads(core.settings),
        "robot_navigation": dict(core.robot_navigation),
        "given": dict(core.given),
    }


def folder_hash(folder: Path) -> str:
    """Return the SHA-256 of a robot's files, names and contents, sorted by name."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0")
        with opened(path) as file:
            while block := file.read(1 << 20):
                digest.update(block)
        digest.update(b"\0")
    return digest.hexdigest()
