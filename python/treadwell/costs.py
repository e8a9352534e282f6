"""What a metre of ground costs a robot, by hand and learned, on arrays (the handbook, 36.3.4).

The robot's own navigation does not read these costs yet.

>>> from treadwell import costs
>>> by_shape = costs.ground_costs("qrio").map(heights, cell=0.04)     # doctest: +SKIP
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from treadwell._core import GroundCosts, LocalRegression, PathWeights, SlipSense, gait_statistics

__all__ = [
    "GroundCosts",
    "LocalRegression",
    "PathWeights",
    "SlipSense",
    "gait_statistics",
    "ground_costs",
]


def ground_costs(
    robot: str | Path = "qrio", settings: Mapping[str, Any] | None = None
) -> GroundCosts:
    """Return what ground costs a robot by its shape, and what speed and curvature ask of it.

    Args:
        robot: its name or folder.
        settings: the tables `limits`, `motion` and `traversability` of `[costs]`, as in
            `{"limits": {"slope": 0.2}}`.

    Raises:
        InputError: the robot or a setting cannot be used; it is named.
    """
    # Late: a robot is read with MuJoCo, which costs on arrays do not need.
    from treadwell.robot.load import load_robot

    described = json.dumps(load_robot(robot).description())
    return GroundCosts(described, json.dumps(dict(settings or {})))
