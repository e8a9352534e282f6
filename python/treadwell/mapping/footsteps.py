"""Footsteps over heights of one's own."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from treadwell._core import FootstepLayer
from treadwell.errors import InputError
from treadwell.footstep_plan import FootstepPlan, plan_of


def plan_footsteps(
    height: ArrayLike,
    *,
    cell: float,
    start: tuple[float, float, float],
    goal: tuple[float, float],
    origin: tuple[float, float] = (0.0, 0.0),
    robot: str | Path = "qrio",
    goal_radius: float = 0.1,
    overrides: Mapping[str, Any] | None = None,
) -> FootstepPlan:
    """Plan where the feet of a robot go over ground whose heights are known.

    Args:
        height: (h, w) heights, m, of any float type: rows along y, columns along x; NaN or
            infinite where nothing is known.
        cell: side of a cell, m: at most half a sole's breadth; 1 cm is fine enough for `qrio`.
        start: where the robot stands, both feet side by side: x and y in metres, and its heading
            in radians.
        goal: where the middle between its feet is to be, m.
        origin: x and y of the outer corner of row 0 and column 0, m.
        robot: a robot by name, or its folder.
        goal_radius: how near to the goal is near enough, m.
        overrides: settings of `[navigation.footsteps]`, as in `{"expansions": 2000}`.

    Returns:
        The plan; without steps, its `reason` says why.

    Raises:
        InputError: an argument that cannot be used; it is named.
    """
    # Late: MuJoCo reads the robot, and a map does without it.
    from treadwell.robot.load import load_robot

    heights = _heights(height)
    for name, value in (("cell", cell), ("goal_radius", goal_radius)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} must be finite and > 0, got {value!r}")
    for name, numbers, count in (("start", start, 3), ("goal", goal, 2), ("origin", origin, 2)):
        if len(numbers) != count or not all(map(math.isfinite, numbers)):
            raise InputError(f"{name} must be {count} finite numbers, got {numbers!r}")
    description = json.dumps(load_robot(robot).description())
    layer = FootstepLayer(description, json.dumps(dict(overrides or {})))
    lattice = ((float(origin[0]), float(origin[1])), float(cell))
    found, reason = layer.plan(heights, lattice, start, (*goal, goal_radius))
    if found is None:
        return FootstepPlan((), reason)
    return plan_of(found)


def _heights(height: ArrayLike) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    """Heights as the core takes them."""
    given = np.asarray(height)
    if given.ndim != 2 or given.dtype.kind not in "fiu":
        raise InputError(
            f"height must be an array of numbers (rows, columns), got {given.dtype} {given.shape}"
        )
    return np.ascontiguousarray(given, dtype=np.float32)
