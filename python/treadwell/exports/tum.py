"""Trajectories as the TUM RGB-D benchmark has them, which evo opens.

A run's folder has them in this format already: they are read, checked and written, so that what
comes out is whole; of a run that was cut off they come out of its log.
evo's absolute pose error of the two, without alignment, is the translation
error in `result.json`: both take the distance in three dimensions at every camera frame.
"""

from collections.abc import Sequence
from pathlib import Path

from treadwell.errors import InputError
from treadwell.recording.cut_off import ways
from treadwell.recording.trajectory import ESTIMATE, TRUTH, Trajectory


def export_tum(source: Path, out: Path) -> Sequence[Path]:
    """Write `trajectory.tum` and `trajectory_truth.tum`.

    Raises:
        InputError: one of them is missing, broken or without a pose.
        OSError: a file cannot be written.
    """
    found = list(zip((ESTIMATE, TRUTH), ways(source), strict=True))
    for name, rows in found:
        if not len(rows):
            raise InputError(f"{source / name}: has not one pose")
    for name, rows in found:
        Trajectory(rows).write(out / name)
    return [out / name for name, _ in found]
