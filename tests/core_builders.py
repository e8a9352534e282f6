"""The core alone: its settings, and observations of a robot that really walked, to feed it with."""

import json
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Pilot
from treadwell.core_settings import core_settings
from treadwell.course.build import build_course
from treadwell.episode import Episode
from treadwell.observation import Frame, Observation
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario


@cache
def settings_text(scenario: str = "slalom") -> str:
    robot = load_robot("qrio")
    made = load_scenario(scenario)
    return core_settings(made, robot, build_course(made, robot))


def settings(**navigation: object) -> dict[str, Any]:
    """The core's settings for the slalom, with some of `[navigation]` changed."""
    made: dict[str, Any] = json.loads(settings_text())
    made["navigation"].update(navigation)
    return made


def pilot(**navigation: object) -> Pilot:
    return Pilot(json.dumps(settings(**navigation)))


@cache
def observations(seconds: float = 2.0) -> tuple[Observation, ...]:
    """What a robot's senses told it while it looked around; it sees its feet after 0.7 s."""
    episode = Episode("slalom", seed=1)
    return tuple(copied(episode.tick().observation) for _ in range(round(seconds / 0.01)))


def copied(seen: Observation) -> Observation:
    frame = seen.depth
    return replace(
        seen,
        joint_positions=seen.joint_positions.copy(),
        joint_velocities=seen.joint_velocities.copy(),
        foot_forces=seen.foot_forces.copy(),
        depth=None if frame is None else replace(frame, depth=frame.depth.copy()),
    )


def with_depth(seen: Observation, depth: NDArray[Any]) -> Observation:
    """The same moment, another picture."""
    return replace(seen, depth=Frame(seen.time_ns, seen.time_ns, depth))


def blank(value: float = np.nan) -> NDArray[np.float32]:
    return np.full((72, 88), value, dtype=np.float32)
