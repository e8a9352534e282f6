"""Ranges and bearings to things that have names, and a robot's odometry: the UTIAS MRCLAM folders.

`Odometry.dat`: time s, forward m/s, turn rad/s; a row holds until the next. `Measurement.dat`: time
s, barcode, range m, bearing rad. `Barcodes.dat`: subject, barcode. Lines that begin with # are
remarks. The first subjects are robots, which move. `Landmark_Groundtruth.dat`, where it is there:
subject, x, y m, and their standard deviations; nothing is made of it but figures of how good a map
is.
"""

import math
from collections import Counter
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from pathlib import Path
from typing import Final

import numpy as np

from treadwell.errors import InputError
from treadwell.sources.frame import Floats
from treadwell.sources.packed import unpacked

SURVEYED = "Landmark_Groundtruth.dat"
ODOMETRY, MEASUREMENTS, BARCODES = "Odometry.dat", "Measurement.dat", "Barcodes.dat"
LARGEST_FILE: Final = 1 << 26
"""Bytes, unpacked."""
ROBOTS: Final = 5
"""How many subjects are robots, where nobody says otherwise: those of MRCLAM are the first five."""
LARGEST: Final = 1e6
"""No number of a log is further from 0, times apart."""
LATEST_S: Final = 1e12
"""No time is further from 0."""
LONGEST_S: Final = 1e5
"""No two rows lie further apart, and no reading further after the last of the odometry: a day."""
LARGEST_NAME: Final = 2**31


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """What was seen at one time.

    Attributes:
        time: s, by the log's clock.
        readings: (n, 2): range m, bearing rad, counter-clockwise from straight ahead.
        names: (n) subjects.
    """

    time: float
    readings: Floats
    names: tuple[int, ...]


@dataclass(slots=True, eq=False)
class LandmarkLog:
    """A log.

    Attributes:
        path: the folder.
        odometry: (n, 3): time s, forward m/s, turn rad/s, counter-clockwise.
        looks: in the order of time.
        frames: how many readings there are, those that cannot be used among them.
        unused: reason -> count of those.
        surveyed: subject -> x, y m, where they were surveyed, in a frame of its own.
    """

    path: Path
    odometry: Floats
    looks: list[Look]
    frames: int
    unused: Counter[str] = field(default_factory=Counter)
    kind: str = "landmark log"
    surveyed: dict[int, tuple[float, float]] = field(default_factory=dict)


def has_landmarks(path: Path) -> bool:
    """Whether a folder is such a log."""
    return all((path / name).exists() for name in (ODOMETRY, MEASUREMENTS, BARCODES))


def open_landmark_log(path: Path, robots: int = ROBOTS) -> LandmarkLog:
    """Read a log.

    Args:
        path: the folder.
        robots: readings of the subjects up to this number are left out.

    Raises:
        InputError: a file is missing or broken, or time goes back in it.
    """
    odometry = _table(path / ODOMETRY, 3)
    if not odometry:
        raise InputError(f"{path / ODOMETRY}: has not one row")
    subjects = {int(barcode): int(subject) for subject, barcode in _subjects(path / BARCODES)}
    rows = _table(path / MEASUREMENTS, 4)
    if rows and rows[-1][0] > odometry[-1][0] + LONGEST_S:
        raise InputError(f"{path / MEASUREMENTS}: ends more than {LONGEST_S:g} s after {ODOMETRY}")
    log = LandmarkLog(path, np.array(odometry), [], len(rows))
    if (path / SURVEYED).exists():
        places = _table(path / SURVEYED, 5, ordered=False)
        log.surveyed = {int(row[0]): (row[1], row[2]) for row in places}
    kept = []
    for time, barcode, distance, bearing in rows:
        subject = subjects.get(int(barcode)) if barcode == int(barcode) else None
        if subject is None:
            log.unused["barcode of no subject"] += 1
        elif subject <= robots:
            log.unused["another robot was seen"] += 1
        elif distance <= 0.0:
            log.unused["range not above 0"] += 1
        else:
            kept.append((time, subject, distance, bearing))
    for time, group in groupby(kept, key=lambda row: row[0]):
        seen = list(group)
        readings = np.array([row[2:] for row in seen], dtype=np.float64)
        log.looks.append(Look(time, readings, tuple(row[1] for row in seen)))
    return log


def _subjects(path: Path) -> list[list[float]]:
    rows = _table(path, 2, ordered=False)
    for row in rows:
        if any(value != int(value) or not 0 <= value < LARGEST_NAME for value in row):
            raise InputError(f"{path}: found {row[0]:g} {row[1]:g}; must be two whole numbers")
    return rows


def _table(path: Path, columns: int, *, ordered: bool = True) -> list[list[float]]:
    """Return rows of finite numbers; the first is the time, which does not go back, if ordered."""
    rows, lines = [], []
    with unpacked(path, LARGEST_FILE) as content:
        for number, line in enumerate(content.lines(), start=1):
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            try:
                row = [float(word) for word in words]
            except ValueError:
                row = []
            if len(row) != columns or not all(map(math.isfinite, row)):
                raise InputError(f"{path}: line {number}: must be {columns} finite numbers")
            if any(abs(value) > LARGEST for value in row[ordered:]):
                raise InputError(f"{path}: line {number}: no number may be above {LARGEST:g}")
            if ordered and abs(row[0]) > LATEST_S:
                raise InputError(f"{path}: line {number}: no time may be above {LATEST_S:g} s")
            rows.append(row)
            lines.append(number)
    for (before, row), number in zip(pairwise(rows), lines[1:], strict=True):
        if ordered and row[0] < before[0]:
            raise InputError(f"{path}: line {number}: time goes back, {before[0]} to {row[0]} s")
        if ordered and row[0] - before[0] > LONGEST_S:
            raise InputError(
                f"{path}: line {number}: more than {LONGEST_S:g} s after the one before"
            )
    return rows
