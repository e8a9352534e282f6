"""What an agent is told: what the robot senses and believes, finite and bounded. No truth."""

import math
from typing import Any, Final

import gymnasium
import numpy as np
from numpy.typing import NDArray

from treadwell.environment.height_scan import HeightScan
from treadwell.episode import Step
from treadwell.robot.load import Robot

FARTHEST_M: Final = 20.0
"""Depths beyond are cut to this."""
MOST: Final = {
    "joint_positions": 2.0 * math.pi,
    "joint_velocities": 100.0,
    "angular_velocity": 100.0,
    "specific_force": 1000.0,
    "foot_forces": 10_000.0,
    "pose": 10_000.0,
    "goal": 10_000.0,
    "gaze": math.pi,
}
"""Bound of either sign; values beyond are cut to it."""

Observed = dict[str, NDArray[Any]]


def observation_space(robot: Robot, scan: HeightScan | None = None) -> gymnasium.spaces.Dict:
    """Return the space: see `docs/how_to/gymnasium.md` for what each entry is."""
    camera, joints = robot.file.camera, len(robot.joints)
    shapes = {
        "joint_positions": (joints,),
        "joint_velocities": (joints,),
        "angular_velocity": (3,),
        "specific_force": (3,),
        "foot_forces": (2, 4),
        "pose": (4,),
        "goal": (2,),
        "gaze": (2,),
    }
    boxes: dict[str, gymnasium.Space[Any]] = {
        name: gymnasium.spaces.Box(-MOST[name], MOST[name], shape, np.float64)
        for name, shape in shapes.items()
    }
    size = (camera.height, camera.width)
    boxes["depth"] = gymnasium.spaces.Box(0.0, FARTHEST_M, size, np.float32)
    if scan is not None:
        boxes |= scan.spaces()
    return gymnasium.spaces.Dict(boxes)


def observed(
    step: Step,
    depth: NDArray[np.float32],
    goal: tuple[float, float],
    gaze: tuple[float, float],
) -> Observed:
    """Return what the agent is told.

    Args:
        step: the last control tick.
        depth: (h, w) m, the last image that arrived; NaN where nothing was seen.
        goal: (x, y) m in the map: the place that is pursued now.
        gaze: (pan, down) rad, where the head is told to look.
    """
    seen = step.observation
    x, y, _, yaw = step.estimate.pose
    ahead, left = goal[0] - x, goal[1] - y
    cos, sin = math.cos(yaw), math.sin(yaw)
    values = {
        "joint_positions": seen.joint_positions,
        "joint_velocities": seen.joint_velocities,
        "angular_velocity": seen.angular_velocity,
        "specific_force": seen.specific_force,
        "foot_forces": seen.foot_forces,
        "pose": np.array(step.estimate.pose),
        "goal": np.array([cos * ahead + sin * left, cos * left - sin * ahead]),
        "gaze": np.array(gaze),
    }
    told: Observed = {
        name: np.clip(np.asarray(value, dtype=np.float64), -MOST[name], MOST[name])
        for name, value in values.items()
    }
    told["depth"] = np.clip(np.nan_to_num(depth, nan=0.0), 0.0, FARTHEST_M).astype(np.float32)
    return told
