"""A robot's first steps: a metre straight ahead on level ground, with all its senses and noise."""

from pathlib import Path
from typing import Any

from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.scenario.model import Scenario

DISTANCE_M = 1.0
TIME_LIMIT_S = 60.0


def refused(folder: str | Path) -> list[str]:
    """Return what the navigation refuses of a robot that fits its own files, a line each."""
    try:
        Episode(_scenario(folder, 0))
    except InputError as error:
        return str(error).splitlines()
    return []


def walk_a_metre(folder: str | Path, seed: int = 0) -> dict[str, Any]:
    """Let a robot walk a metre in MuJoCo, and return how it went.

    Args:
        folder: the robot's name or folder.
        seed: of all that is random.

    Raises:
        InputError: the robot cannot be built.
    """
    episode = Episode(_scenario(folder, seed))
    first = last = None
    for step in episode:
        if step.state == "walk":
            first = step.time_ns if first is None else first
            last = step.time_ns
    verdict = episode.verdict
    assert verdict is not None
    walked = episode.judge.path_length
    seconds = 0.0 if first is None or last is None else 1e-9 * (last - first)
    return {
        "passed": verdict.outcome == "goal_reached" and episode.judge.falls == 0,
        "outcome": verdict.outcome,
        "reason": verdict.reason or episode.judge.fall,
        "walked": walked,
        "speed": walked / seconds if seconds > 0.0 else 0.0,
        "seconds": 1e-9 * episode.simulation.time_ns,
        "falls": episode.judge.falls,
    }


def _scenario(folder: str | Path, seed: int) -> Scenario:
    return Scenario.model_validate(
        {
            "schema": 1,
            "name": "a-metre",
            "robot": str(folder),
            "seed": seed,
            "time_limit": TIME_LIMIT_S,
            "start": {"position": [0.0, 0.0]},
            "goal": {"position": [DISTANCE_M, 0.0]},
        }
    )
