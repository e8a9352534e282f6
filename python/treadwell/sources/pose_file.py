"""Poses in the TUM format, `time x y z qx qy qz qw` a line, and the one that a frame takes."""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from treadwell.errors import InputError
from treadwell.files import read_text
from treadwell.poses import rotation_of
from treadwell.sources.frame import Floats, UnusableError

LARGEST_FILE: Final = 200_000_000
"""Bytes: a million poses are a tenth of them."""
_LINE: Final = "time s, x y z m, qx qy qz qw, world from sensor"
MOST_OFF_ONE: Final = 0.01
"""By which a quaternion's length may differ from one: files keep four digits or more."""


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Where a sensor was, by time.

    Attributes:
        rows: (n, 8) in the order of time: s, x, y, z m, quaternion x, y, z, w; may hold NaN behind
            the time.
    """

    rows: Floats

    def nearest(self, time: float, within: float) -> Floats:
        """Return the pose (4, 4) that is nearest in time.

        Args:
            time: s.
            within: s, how far off it may be.

        Raises:
            UnusableError: there is none, or it is no pose.
        """
        return pose_of(self.rows[nearest(self.rows[:, 0], time, within, "pose"), 1:])


def nearest(times: Floats, time: float, within: float, what: str) -> int:
    """Return which of sorted times is nearest to one.

    Args:
        times: (n,) s.
        time: s.
        within: s, how far off it may be; as far and the rounding of times in a file is near enough.
        what: they are times of.

    Raises:
        UnusableError: none is that near.
    """
    behind = int(np.searchsorted(times, time))
    around = [number for number in (behind - 1, behind) if 0 <= number < len(times)]
    best = min(around, key=lambda number: abs(times[number] - time), default=None)
    if best is None or abs(times[best] - time) > within + 1e-6:
        raise UnusableError(f"no {what} within {1e3 * within:g} ms")
    return best


def pose_of(numbers: Floats) -> Floats:
    """Return the pose (4, 4) of x, y, z m and a quaternion x, y, z, w.

    Raises:
        UnusableError: a number is not finite, or the quaternion's length is not one.
    """
    if not np.isfinite(numbers).all():
        raise UnusableError("pose not finite")
    length = math.hypot(*numbers[3:])
    if not abs(length - 1.0) <= MOST_OFF_ONE:
        raise UnusableError("pose whose quaternion is not of length one")
    pose = np.eye(4)
    pose[:3, :3] = rotation_of([float(part) / length for part in numbers[3:]])
    pose[:3, 3] = numbers[:3]
    return pose


def read_poses(path: Path) -> Poses:
    """Read a file; lines that begin with # say nothing. NaN is kept: it makes frames unusable.

    Raises:
        InputError: it is missing, a line is not of eight numbers, or there is none.
    """
    if not os.path.lexists(path):
        raise InputError(f"{path}: missing; a line for each pose of the sensor: {_LINE}")
    rows: list[list[float]] = []
    for number, line in enumerate(read_text(path, LARGEST_FILE).splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            row = [float(word) for word in line.split()]
        except ValueError:
            row = []
        if len(row) != 8 or not math.isfinite(row[0]):
            raise InputError(f"{path}: line {number}: must be eight numbers: {_LINE}")
        rows.append(row)
    if not rows:
        raise InputError(f"{path}: holds not one pose")
    table = np.array(rows, dtype=np.float64)
    return Poses(table[np.argsort(table[:, 0], kind="stable")])
