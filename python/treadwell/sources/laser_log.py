"""Logs of robots with a laser scanner: CARMEN's, and g2o's graphs with the scans at their nodes.

A line begins with what it is. `FLASER` (CARMEN, old): count, ranges, the laser's pose, the
odometry's, time. `ROBOTLASER1` (CARMEN): kind, first angle, field of view, step, farthest range,
accuracy, kind of remission, count, ranges, count, remissions, the laser's pose, the robot's, five
numbers, time. `VERTEX2` or `VERTEX_SE2` (g2o): number, x, y, yaw of the robot, as a graph was
solved; a scan behind one was taken there. Others, edges among them, are passed over.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.poses import pose_matrix
from treadwell.sources.frame import Floats, RangeFrame, UnusableError
from treadwell.sources.packed import unpacked

VERTICES: Final = ("VERTEX2", "VERTEX_SE2")
SCANS: Final = ("FLASER", "ROBOTLASER1")
_KNOWN: Final = {
    *VERTICES,
    *SCANS,
    *("EDGE2", "EDGE_SE2", "PARAM", "SYNC", "ODOM", "TRUEPOS", "RLASER", "RAWLASER1"),
}
LARGEST_FILE: Final = 1 << 30
"""Bytes, unpacked."""
MOST_READINGS: Final = 100_000
"""Of one scan: a hundredth of a degree all around has a third of them."""
_LINES_TO_KNOW_BY: Final = 200
SICK_FARTHEST_M: Final = 80.0
"""What the scanners of FLASER logs (SICK LMS) write above this is a code, and no range."""


@dataclass(frozen=True, slots=True, eq=False)
class _Scan:
    """One scan: when, and what was seen from where."""

    time: float | None
    points: NDArray[np.float32]
    world_from_laser: Floats
    robot_from_laser: Floats


@dataclass(slots=True, eq=False)
class LaserLog:
    """A log with scans.

    Attributes:
        path: the file.
        frames: how many lines with scans there are.
        kind: "laser log".
        unused: reason -> count, of the scans so far.
        notes: what its user should know.
    """

    path: Path
    frames: int
    kind: str = "laser log"
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the scans, points in z = 0 by their angle, in the order of the file.

        Raises:
            InputError: the file is broken.
        """
        self.unused.clear()
        self.notes.clear()
        vertex: Floats | None = None
        number = 0
        with unpacked(self.path, LARGEST_FILE) as content:
            for line in content.lines():
                word, _, rest = line.partition(" ")
                try:
                    if word in VERTICES:
                        vertex = _vertex(rest.split())
                    elif word in SCANS:
                        number += 1
                        yield self._frame(_READERS[word](rest.split()), number, vertex)
                except UnusableError as reason:
                    self.unused[str(reason)] += 1

    def _frame(self, scan: _Scan, number: int, vertex: Floats | None) -> RangeFrame:
        pose = scan.world_from_laser
        if vertex is not None:
            self._note("scans are placed at the graph's vertices before them")
            pose = vertex @ scan.robot_from_laser
        if not np.isfinite(pose).all():
            raise UnusableError("pose not finite")
        if np.isnan(scan.points[:, 0]).all():
            raise UnusableError("no point")
        if scan.time is None:
            self._note("scans have no time: their number in the file is taken for it")
        time = float(number) if scan.time is None else scan.time
        return RangeFrame(time, pose, None, None, scan.points, "scan")

    def _note(self, note: str) -> None:
        if note not in self.notes:
            self.notes.append(note)


def is_laser_log(path: Path) -> bool:
    """Whether a file begins like such a log.

    Raises:
        InputError: it is missing, cannot be read, or is no file.
    """
    with unpacked(path, LARGEST_FILE) as content:
        try:
            for number, line in enumerate(content.lines()):
                words = line.split(maxsplit=1)
                if words and words[0] in _KNOWN:
                    return True
                if number > _LINES_TO_KNOW_BY or "\0" in line:
                    break
        except InputError:
            return False
    return False


def open_laser_log(path: Path) -> LaserLog:
    """Open a log, and count its scans.

    Raises:
        InputError: it is broken, or has not one scan.
    """
    with unpacked(path, LARGEST_FILE) as content:
        scans = sum(
            line.startswith(tuple(f"{word} " for word in SCANS)) for line in content.lines()
        )
    if not scans:
        raise InputError(f"{path}: has not one scan: no line begins with {' or '.join(SCANS)}")
    return LaserLog(path, scans)


def _vertex(words: Sequence[str]) -> Floats:
    """Return where the robot is at a node; not finite where the line does not say it."""
    try:
        x, y, yaw = (float(word) for word in words[1:4])
    except ValueError:
        x = y = yaw = math.nan
    return _level(x, y, yaw)


def _level(x: float, y: float, yaw: float) -> Floats:
    if not all(math.isfinite(part) for part in (x, y, yaw)):
        return np.full((4, 4), np.nan)
    return pose_matrix(x, y, 0.0, yaw)


def _numbers(words: Sequence[str], count: int) -> list[float]:
    """Return the first numbers of words.

    Raises:
        UnusableError: there are fewer.
    """
    try:
        numbers = [float(word) for word in words[:count]]
    except ValueError:
        numbers = []
    if len(numbers) < count:
        raise UnusableError("line that is no whole scan")
    return numbers


def _count(word: Sequence[str]) -> int:
    (number,) = _numbers(word, 1)
    if not 0 <= number <= MOST_READINGS:
        raise UnusableError("line that is no whole scan")
    return int(number)


def _points(ranges: Sequence[float], first: float, step: float, most: float) -> NDArray[np.float32]:
    """Return points (n, 3) m of ranges at angles; NaN where a range says that nothing was seen."""
    if not ranges or not all(math.isfinite(number) for number in (first, step, most)):
        raise UnusableError("line that is no whole scan")
    distance = np.array(ranges)
    with np.errstate(invalid="ignore"):
        distance[~((distance > 0.0) & (distance < most))] = np.nan
    angle = first + step * np.arange(len(distance))
    ways = np.stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))], axis=1)
    points: NDArray[np.float32] = (distance[:, None] * ways).astype(np.float32)
    return points


def _old_scan(words: Sequence[str]) -> _Scan:
    """Return the scan of FLASER, half a turn from right to left; the pose is the laser's."""
    count = _count(words[:1])
    ranges = _numbers(words[1:], count)
    x, y, yaw, *_ = _numbers(words[1 + count :], 6)
    # 180 readings lie in the middles of as many degrees or at their beginnings: the format does not
    # say. 181 have one at each end.
    step = math.pi / (count - count % 2) if count > 1 else 0.0
    points = _points(ranges, -0.5 * math.pi, step, SICK_FARTHEST_M)
    return _Scan(_time(words[1 + count + 6 :]), points, _level(x, y, yaw), np.eye(4))


def _scan(words: Sequence[str]) -> _Scan:
    """Return the scan of ROBOTLASER1."""
    _, first, _, step, most, *_ = _numbers(words, 7)
    count = _count(words[7:8])
    ranges = _numbers(words[8:], count)
    after = 8 + count
    rest = words[after + 1 + _count(words[after : after + 1]) :]
    laser, robot = _level(*_numbers(rest, 6)[:3]), _level(*_numbers(rest, 6)[3:])
    points = _points(ranges, first, step, most)
    if np.isnan(robot).any() or np.isnan(laser).any():
        raise UnusableError("pose not finite")
    return _Scan(_time(rest[11:]), points, laser, np.linalg.inv(robot) @ laser)


def _time(words: Sequence[str]) -> float | None:
    """Return the time that begins a line's end: s, the host's name, s since the log began."""
    try:
        time = float(words[0])
    except (IndexError, ValueError):
        return None
    return time if math.isfinite(time) else None


_READERS: Final[dict[str, Callable[[Sequence[str]], _Scan]]] = {
    "FLASER": _old_scan,
    "ROBOTLASER1": _scan,
}
