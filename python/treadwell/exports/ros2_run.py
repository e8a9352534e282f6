"""A run as messages of ROS 2, in the order in which they came.

Frames (REP 105): `map`, below it `odom`, `base_link` (the robot's frame: midway between the soles,
on the ground, x forward), `camera_link` (x forward) and, fixed to it, `camera_optical_frame` (z
forward). Fixed to the link that carries it: `imu_link`. Stamps are seconds since the run's start,
those of images their exposure.
"""

import math
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from treadwell.careful_json import json_of
from treadwell.errors import InputError
from treadwell.exports.map_server import seen_part
from treadwell.exports.recorded_points import camera_poses
from treadwell.exports.ros2_messages import Quaternion, Ros2Messages
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.observation import Frame, Observation
from treadwell.poses import Floats, pose_matrix
from treadwell.protocols import Pose
from treadwell.recording.cut_off import is_cut_off, ways
from treadwell.recording.log_file import BrokenLogError, read_front, read_messages
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map
from treadwell.recording.messages import (
    Belief,
    decode_command,
    decode_estimate,
    decode_truth,
)
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.observation_log import (
    ROBOT,
    header_of,
    read_answers,
    read_observations,
)
from treadwell.recording.recorded_camera import RecordedCamera, recorded_camera
from treadwell.recording.trajectory import quaternion, turned

_SECOND: Final = 1_000_000_000
_OPTICAL: Final[Quaternion] = (-0.5, 0.5, -0.5, 0.5)
"""camera_link from camera_optical_frame (REP 103)."""
_LINK_FROM_OPTICAL: Final = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""The same as a matrix."""


class Told(NamedTuple):
    """A message: when it came, on which topic, and what."""

    time_ns: int
    topic: str
    message: Any


class _Mount(NamedTuple):
    """Where the inertial unit is: on which link, place m and turn."""

    link: str
    place: tuple[float, ...]
    turn: Quaternion


def run_messages(source: Path, ros: Ros2Messages) -> Iterator[Told]:
    """Yield a run's messages; of one without observations those of its way and its map.

    Args:
        source: the run's folder.
        ros: makes them.

    Raises:
        InputError: the run lacks a trajectory or the recording that belongs to its observations,
            or is broken; of one that was cut off what is whole comes.
    """
    last_ns = 0
    recorded = (source / OBSERVATIONS).is_file()
    for each in _recorded(source, ros) if recorded else _way(source, ros):
        last_ns = max(last_ns, each.time_ns)
        yield each
    if (source / MAP).is_file():
        surface = read_map(source / MAP).surface
        if surface.kind.any():
            yield Told(last_ns, "/map", _grid(ros, seen_part(surface, source), last_ns))


def _way(source: Path, ros: Ros2Messages) -> Iterator[Told]:
    """Yield what a run without observations knows: where the robot believed to be, and was."""
    estimate, truth = ways(source)
    if not len(estimate):
        raise InputError(f"{source}: has not one pose")
    true = {round(row[0] * _SECOND): row for row in truth.tolist()}
    for row in estimate.tolist():
        time_ns = round(row[0] * _SECOND)
        place, turn = row[1:4], (row[4], row[5], row[6], row[7])
        yield Told(time_ns, "/tf", ros.transforms([(time_ns, "map", "base_link", place, turn)]))
        yield Told(time_ns, "/estimate", ros.pose(time_ns, "map", place, turn))
        if time_ns in true:
            yield _true(ros, time_ns, true[time_ns][1:])


def _true(ros: Ros2Messages, time_ns: int, row: Sequence[float]) -> Told:
    turn = (row[3], row[4], row[5], row[6])
    return Told(time_ns, "/ground_truth", ros.pose(time_ns, "map", row[:3], turn))


def _recorded(source: Path, ros: Ros2Messages) -> Iterator[Told]:
    """Yield what a run's log and recording tell, tick by tick."""
    log = source / OBSERVATIONS
    run = _Run(log, camera_poses(source), ros)
    mount = run.mount
    fixed = [
        (0, "camera_link", "camera_optical_frame", (0.0, 0.0, 0.0), _OPTICAL),
        (0, mount.link, "imu_link", mount.place, mount.turn),
    ]
    yield Told(0, "/tf_static", ros.transforms(fixed))
    ticks = 0
    try:
        truth = read_messages(log, ("/truth",))
        for observation, answer, stood in zip(
            read_observations(log), read_answers(log), truth, strict=False
        ):
            ticks += 1
            yield from run.tick(observation, *answer)
            yield _true(ros, stood.log_ns, decode_truth(stood.data))
    except BrokenLogError:
        if not is_cut_off(source):
            raise
    except (ValueError, struct.error) as error:
        raise InputError(f"{log}: is no recording: {error}") from None
    if not ticks:
        raise InputError(f"{log}: holds not one observation with its answer")


class _Run:
    """Makes the messages of one tick after the other."""

    def __init__(self, log: Path, cameras: dict[int, Floats], ros: Ros2Messages) -> None:
        """Read what the log says of the robot.

        Args:
            log: the run's.
            cameras: map_from_camera (4, 4), by the time in ns at which the frame arrived.
            ros: makes the messages.

        Raises:
            InputError: it does not say it.
        """
        self._camera = recorded_camera(log)
        front = read_front(log)
        self._joints = header_of(front, log).get("joints", "").split(",")
        self.mount = _mount(front.attachments[ROBOT], f"{log}: {ROBOT}")
        self._rays = _rays(self._camera)
        self._cameras, self._ros = cameras, ros
        self._before: Belief | None = None

    def tick(self, observation: Observation, command: bytes, estimate: bytes) -> Iterator[Told]:
        """Yield the messages of a tick."""
        now, ros = observation.time_ns, self._ros
        belief, told = decode_estimate(estimate), decode_command(command)
        place, turn = belief.pose[:3], turned(belief.pose[3])
        yield Told(now, "/tf", ros.transforms(_placed(now, belief)))
        yield Told(now, "/odom", self._odometry(now, belief))
        yield Told(now, "/estimate", ros.pose(now, "map", place, turn))
        imu = ros.imu(now, "imu_link", observation.angular_velocity, observation.specific_force)
        yield Told(now, "/imu/data_raw", imu)
        position, velocity = observation.joint_positions, observation.joint_velocities
        yield Told(now, "/joint_states", ros.joints(now, self._joints, position, velocity))
        targets = ros.joints(now, self._joints, told.positions, told.velocities, told.torques)
        yield Told(now, "/joint_commands", targets)
        if self._before is None or self._before.state != belief.state:
            yield Told(now, "/behaviour", ros.text(belief.state))
        if observation.depth is not None:
            yield from self._frame(now, observation.depth, belief)
        self._before = belief

    def _frame(self, now: int, frame: Frame, belief: Belief) -> Iterator[Told]:
        ros, stamp, optical = self._ros, frame.exposure_ns, "camera_optical_frame"
        map_from_camera = self._cameras.get(now)
        if map_from_camera is not None:
            base_from_camera = np.linalg.solve(pose_matrix(*belief.pose), map_from_camera)
            turn = quaternion(base_from_camera[:3, :3] @ _LINK_FROM_OPTICAL.T)
            row = (stamp, "base_link", "camera_link", base_from_camera[:3, 3].tolist(), turn)
            yield Told(now, "/tf", ros.transforms([row]))
        info = ros.camera_info(stamp, optical, self._camera)
        yield Told(now, "/camera/depth/camera_info", info)
        yield Told(now, "/camera/depth/image_rect", ros.image(stamp, optical, frame.depth))
        if frame.depth.shape == self._rays.shape[:2]:
            points = self._rays * frame.depth[:, :, np.newaxis]
            yield Told(now, "/camera/depth/points", ros.cloud(stamp, optical, points))

    def _odometry(self, now: int, belief: Belief) -> Any:  # noqa: ANN401
        before, after = self._before, belief.odometry
        linear, rate = (0.0, 0.0, 0.0), 0.0
        if before is not None and now > before.time_ns:
            linear, rate = _velocity(before.odometry, after, (now - before.time_ns) / _SECOND)
        pose = after[:3], turned(after[3])
        twist = linear, (0.0, 0.0, rate)
        return self._ros.odometry(now, ("odom", "base_link"), pose, twist)


def _placed(now: int, belief: Belief) -> list[tuple[int, str, str, tuple[float, ...], Quaternion]]:
    """Return map -> odom -> base_link."""
    (x, y, z, yaw), (u, v, w, turn) = belief.pose, belief.odometry
    angle = math.remainder(yaw - turn, 2.0 * math.pi)
    c, s = math.cos(angle), math.sin(angle)
    shift = x - (c * u - s * v), y - (s * u + c * v), z - w
    return [
        (now, "map", "odom", shift, turned(angle)),
        (now, "odom", "base_link", (u, v, w), turned(turn)),
    ]


def _velocity(
    before: Pose, after: Pose, seconds: float
) -> tuple[tuple[float, float, float], float]:
    """Return velocity m/s in the axes of the pose after, and rate of turn rad/s."""
    x, y, z = ((b - a) / seconds for a, b in zip(before[:3], after[:3], strict=True))
    c, s = math.cos(after[3]), math.sin(after[3])
    turn = math.remainder(after[3] - before[3], 2.0 * math.pi)
    return (c * x + s * y, c * y - s * x, z), turn / seconds


def _rays(camera: RecordedCamera) -> NDArray[np.float32]:
    """Return the point (h, w, 3) that each pixel sees at a depth of 1 m."""
    column, row = camera.centre
    x = (np.arange(camera.width) - column) / camera.focal
    y = (np.arange(camera.height) - row) / camera.focal
    rays = np.ones((camera.height, camera.width, 3))
    rays[:, :, 0], rays[:, :, 1] = x[np.newaxis], y[:, np.newaxis]
    return rays.astype(np.float32)


def _mount(robot: bytes, where: str) -> _Mount:
    """Return where the inertial unit is, by the robot's description.

    Raises:
        InputError: it does not say it.
    """
    table = json_of(robot, f"{where}: is broken")
    with suppress(KeyError, TypeError, ValueError):
        imu = table["imu"]
        x, y, z = (float(number) for number in imu["position"])
        qw, qx, qy, qz = (float(number) for number in imu["orientation"])
        return _Mount(str(imu["link"]), (x, y, z), (qx, qy, qz, qw))
    raise InputError(f"{where}: imu: must have link, position and orientation")


def _grid(ros: Ros2Messages, surface: RememberedMap, time_ns: int) -> Any:  # noqa: ANN401
    cells = np.full(surface.kind.shape, -1, np.int8)
    cells[surface.kind == FLOOR], cells[surface.kind == OBSTACLE] = 0, 100
    return ros.grid(time_ns, "map", surface.origin, surface.cell, cells)
