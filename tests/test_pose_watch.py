"""The believed pose against the true one."""

import math
from typing import Any

import pytest
from episode_builders import trace, world

from treadwell.measuring.pose_watch import PoseErrors, PoseWatch
from treadwell.measuring.watch import Watch
from treadwell.poses import pose_matrix
from treadwell.trace import Sole

WORLD = world()

_watch: type[Watch] = PoseWatch


def soles(apart: float = 0.0) -> tuple[Sole, Sole]:
    forward = (1.0, 0.0)
    return Sole(0.0, 0.04, 0.0, forward), Sole(0.0, -0.04, apart, forward)


def watched(*frames: dict[str, Any]) -> PoseErrors:
    episode: Any = None
    watch = PoseWatch(episode)
    for changes in frames:
        watch.frame(trace(WORLD, 0, **changes))
    return watch.findings()


def frame(
    z: float = 0.0, yaw: float = 0.0, true_yaw: float = 0.0, **more: object
) -> dict[str, Any]:
    poses = {
        "map_from_robot": pose_matrix(0.0, 0.0, z, yaw),
        "truth_from_robot": pose_matrix(0.0, 0.0, 0.0, true_yaw),
    }
    return {"soles": soles(), "touch": (True, True)} | poses | more


def test_heights_count_while_both_soles_stand_on_one_level() -> None:
    found = watched(
        frame(z=0.004),
        frame(z=0.005, soles=soles(apart=0.03)),
        frame(z=0.006, touch=(True, False)),
        frame(z=-0.001),
    )
    assert found.heights == pytest.approx([0.004, -0.001])


def test_turns_add_up_and_the_headings_error_is_the_short_way_round() -> None:
    true = [math.radians(degrees) for degrees in (0.0, 120.0, 240.0, 350.0, 470.0)]
    found = watched(*[frame(yaw=yaw + 0.02, true_yaw=yaw) for yaw in true])
    assert found.turned == pytest.approx([yaw - true[0] for yaw in true])
    assert found.headings == pytest.approx([0.02] * len(true))
