"""The localizer `truth` knows the pose, and the result says that it was there."""

from pathlib import Path

import numpy as np
import pytest
from user_parts import Legs

import treadwell
from treadwell.poses import pose_matrix

TRUTH = "navigation.localizer=truth"


def test_its_estimate_is_the_true_pose() -> None:
    episode = treadwell.Episode("slalom", seed=3, overrides=(TRUTH, "time_limit=3"))
    for step in episode:
        # Of when the senses were read, not of a tick later: a robot that turns would seem behind.
        truth = episode.judge.observed.matrix()
        if step.time_ns:
            assert pose_matrix(*step.estimate.pose) == pytest.approx(truth, abs=1e-9)


@pytest.mark.parametrize(("localizer", "ablation"), [("truth", True), ("odometry", False)])
def test_only_its_runs_are_ablations(localizer: str, ablation: bool, tmp_path: Path) -> None:
    settings = (f"navigation.localizer={localizer}", "time_limit=0.5")
    done = treadwell.run("slalom", overrides=settings, out=tmp_path / "run", record=False)
    assert done.result.ablation is ablation
    assert done.document["ablation"] is ablation


def test_a_localizer_of_the_users_takes_its_place() -> None:
    episode = treadwell.Episode("slalom", overrides=(TRUTH,), localizer=Legs())
    assert not episode.ablation


def test_it_tells_the_core_nothing_but_the_pose() -> None:
    episode = treadwell.Episode("slalom", seed=3, overrides=(TRUTH, "time_limit=1"))
    plain = treadwell.Episode("slalom", seed=3, overrides=("time_limit=1",))
    step, other = episode.tick(), plain.tick()
    assert np.array_equal(step.observation.joint_positions, other.observation.joint_positions)
    assert step.estimate.odometry == other.estimate.odometry
