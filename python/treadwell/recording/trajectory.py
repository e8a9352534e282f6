"""Trajectories in the format of the TUM RGB-D benchmark: time, position, quaternion xyzw."""

import math
from array import array
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import read_text, write_text
from treadwell.protocols import Pose

LARGEST_FILE = 100_000_000
"""Bytes."""
LATEST_S = 1e6
"""Seconds."""
ESTIMATE, TRUTH = "trajectory.tum", "trajectory_truth.tum"
"""Names of the two files in a run's folder."""


class Trajectory:
    """Poses of the robot frame in the map, one a camera frame; 64 bytes each."""

    def __init__(self, rows: NDArray[np.float64] | None = None) -> None:
        """Begin with rows as in the attribute `rows`, or with none."""
        self._numbers = array("d", [] if rows is None else rows.ravel())

    @property
    def rows(self) -> NDArray[np.float64]:
        """(n, 8): time s, x, y, z m, quaternion x, y, z, w."""
        return np.array(self._numbers).reshape(-1, 8)

    def add(self, time_ns: int, pose: NDArray[np.float64]) -> None:
        """Append a pose.

        Args:
            time_ns: nanoseconds since the start.
            pose: map_from_robot, (4, 4).
        """
        self._numbers.extend((1e-9 * time_ns, *pose[:3, 3].tolist(), *quaternion(pose[:3, :3])))

    def add_level(self, time_ns: int, pose: Pose) -> None:
        """Append a pose (x m, y m, z m, yaw rad): to the bit what `add` does of its matrix."""
        self._numbers.extend((1e-9 * time_ns, *pose[:3], *turned(pose[3])))

    def add_row(self, time_ns: int, pose: tuple[float, ...]) -> None:
        """Append a pose: x, y, z m, quaternion x, y, z, w."""
        self._numbers.extend((1e-9 * time_ns, *pose))

    def positions(self) -> NDArray[np.float64]:
        """Return the positions, (n, 3) m."""
        return self.rows[:, 1:4]

    def write(self, path: Path) -> None:
        """Write the file whole or not at all.

        Raises:
            OSError: the file cannot be written.
        """
        lines = ["# timestamp tx ty tz qx qy qz qw"]
        lines += [
            f"{row[0]:.9f} " + " ".join(f"{value:.9f}" for value in row[1:])
            for row in self.rows.tolist()
        ]
        write_text(path, "\n".join(lines) + "\n")


def read_trajectory(path: Path) -> NDArray[np.float64]:
    """Read a file, (n, 8): time s, position m, quaternion xyzw.

    Raises:
        InputError: it is missing, or a line is not of eight finite numbers, or time goes back.
    """
    lines = read_text(path, LARGEST_FILE).splitlines()
    rows: list[list[float]] = []
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            row = [float(word) for word in line.split()]
        except ValueError:
            row = []
        if len(row) != 8 or not np.isfinite(row).all():
            raise InputError(f"{path}: line {number}: must be eight finite numbers")
        if not 0.0 <= row[0] <= LATEST_S:
            raise InputError(f"{path}: line {number}: must have a time of 0 to {LATEST_S:g} s")
        if rows and row[0] <= rows[-1][0]:
            raise InputError(f"{path}: line {number}: time goes back")
        rows.append(row)
    return np.array(rows, dtype=np.float64).reshape(-1, 8)


def jumps(rows: NDArray[np.float64], stride: float) -> NDArray[np.intp]:
    """Return the indices of rows (n, 8) that lie farther from the one before than a robot walks.

    Args:
        rows: of a trajectory, one a camera frame.
        stride: m, farther than the robot comes in the time of a frame; where frames are missing,
            as many of it.
    """
    if len(rows) < 2:
        return np.empty(0, np.intp)
    times, ways = np.diff(rows[:, 0]), np.linalg.norm(np.diff(rows[:, 1:4], axis=0), axis=1)
    frames = np.maximum(times / np.median(times), 1.0)
    return np.flatnonzero(ways > stride * frames) + 1


def headings(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the headings (n,) rad of trajectory rows (n, 8)."""
    x, y, z, w = rows[:, 4:8].T
    angle: NDArray[np.float64] = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return angle


def turned(yaw: float) -> tuple[float, float, float, float]:
    """Return x, y, z, w of a turn about z, rad: to the bit that of its matrix."""
    c, s = math.cos(yaw), math.sin(yaw)
    trace = c + c + 1.0
    z, w = (s + s, 1.0 + trace) if trace > 1.0 else (1.0 + 1.0 - c - c, s + s)
    length = math.hypot(0.0, 0.0, z, w) * (1.0 if w >= 0.0 else -1.0)
    none = 0.0 / length
    return none, none, z / length, w / length


def quaternion(rotation: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Return x, y, z, w of a rotation (3, 3), w not negative (Shepperd's method)."""
    m = rotation.tolist()
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [m[0][0], m[1][1], m[2][2], trace]
    best = squares.index(max(squares))
    if best == 3:
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1.0 + trace]
    else:
        i, j, k = best, (best + 1) % 3, (best + 2) % 3
        q = [0.0, 0.0, 0.0, m[k][j] - m[j][k]]
        q[i] = 1.0 + m[i][i] - m[j][j] - m[k][k]
        q[j], q[k] = m[j][i] + m[i][j], m[k][i] + m[i][k]
    length = math.hypot(*q) * (1.0 if q[3] >= 0.0 else -1.0)
    x, y, z, w = (value / length for value in q)
    return x, y, z, w
