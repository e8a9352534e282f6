"""Trajectories as the TUM RGB-D benchmark has them, which evo opens.

A run's folder has them in this format already: they are read, checked and written, so that what
comes out is whole. evo's absolute pose error of the two, without alignment, is the translation
error in `result.json`: both take the distance in three dimensions at every camera frame.
"""

from collections.abc import Sequence
from pathlib import Path

from treadwell.errors import InputError
from treadwell.recording.trajectory import ESTIMATE, TRUTH, Trajectory, read_trajectory


def export_tum(source: Path, out: Path) -> Sequence[Path]:
    """Write `trajectory.tum` and `trajectory_truth.tum`.

    Raises:
        InputError: one of them is missing, broken or without a pose.
        OSError: a file cannot be written.
    """
    ways = [(name, read_trajectory(source / name)) for name in (ESTIMATE, TRUTH)]
    for name, rows in ways:
        if not len(rows):
            raise InputError(f"{source / name}: has not one pose")
    for name, rows in ways:
        Trajectory(rows).write(out / name)
    return [out / name for name, _ in ways]
