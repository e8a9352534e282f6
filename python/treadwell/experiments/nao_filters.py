"""The same walk as other filters believe it: M5, Fig. 5 of Maier 2012."""

from dataclasses import replace

import numpy as np

from treadwell.measuring.walk_watch import Walk
from treadwell.recording.trajectory import ESTIMATE, headings, read_trajectory
from treadwell.replaying.replay import replay
from treadwell.runner import Run


def with_other_draws(run: Run, draw: int) -> Run:
    """Replay a run with other random numbers in the filter; return it with what that one believed.

    Truth, odometry and all that was sensed stay those of the run, so that the filters are
    compared on the same data. A replay that was interrupted or failed makes the run one that was.

    Args:
        run: recorded, with a `Walk` as its findings.
        draw: `navigation.monte_carlo.seed` of the replay, which lies beside the run.
    """
    walk: Walk = run.findings
    settings = (f"navigation.monte_carlo.seed={draw}",)
    beside = run.folder.with_name(f"{run.folder.name}-replayed")
    again = replay(run.folder, overrides=settings, out=beside)
    if again.interrupted:
        return _ended(run, "interrupted", again.result.replay.error)
    rows = read_trajectory(again.folder / ESTIMATE)
    if again.result.replay.error is not None or len(rows) != len(walk.times):
        frames = f"error: {len(rows)} camera frames replayed of {len(walk.times)}"
        return _ended(run, "error", again.result.replay.error or frames)
    believed = np.column_stack([rows[:, 1:4], headings(rows)])
    return replace(run, findings=replace(walk, believed=believed))


def _ended(run: Run, outcome: str, reason: str | None) -> Run:
    result = run.result.model_copy(update={"outcome": outcome, "reason": reason, "passed": False})
    return replace(run, result=result)
