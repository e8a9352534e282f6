"""The same walk as other filters believe it: M5, Fig. 5 of Maier 2012."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from treadwell.errors import SimulationError
from treadwell.judging.walk_watch import Walk
from treadwell.observation import Floats
from treadwell.poses import rotation_of
from treadwell.recording.trajectory import ESTIMATE, read_trajectory
from treadwell.replaying.replay import replay
from treadwell.runner import Run


def with_other_draws(run: Run, draw: int) -> Run:
    """Replay a run with other random numbers in the filter; return it with what that one believed.

    Truth, odometry and all that was sensed stay those of the run, so that the filters are
    compared on the same data.

    Args:
        run: recorded, with a `Walk` as its findings.
        draw: `navigation.monte_carlo.seed` of the replay, which lies beside the run.

    Raises:
        SimulationError: the replay has not as many frames as the walk.
    """
    walk: Walk = run.findings
    settings = (f"navigation.monte_carlo.seed={draw}",)
    beside = run.folder.with_name(f"{run.folder.name}-replayed")
    again = replay(run.folder, overrides=settings, out=beside)
    believed = _placed(again.folder)
    if believed.shape != walk.believed.shape:
        raise SimulationError(
            f"{again.folder}: {len(believed)} camera frames, the run has {len(walk.believed)}"
        )
    return replace(run, findings=replace(walk, believed=believed))


def _placed(folder: Path) -> Floats:
    """Return x, y, z m and heading rad of each camera frame of a replay, (n, 4)."""
    rows = read_trajectory(folder / ESTIMATE)
    rotations = [rotation_of(row) for row in rows[:, 4:].tolist()]
    headings = [math.atan2(rotation[1, 0], rotation[0, 0]) for rotation in rotations]
    return np.column_stack([rows[:, 1:4], headings])
