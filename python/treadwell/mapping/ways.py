"""A way over a floor of one's own."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Climb, FloorView, Goal, Staircase, Ways
from treadwell.core_settings import over
from treadwell.errors import InputError
from treadwell.mapping.checks import (
    checked_tables,
    finite_numbers,
    own_part,
    positive,
    raw_tables,
)
from treadwell.mapping.map import Map
from treadwell.protocols import FloorMap, Setup
from treadwell.scenario.overrides import Overrides

_TRUSTED: Final = {"terrain": {"left_out": "far_levels"}}
"""A robot on its way doubts levels that it has not been near; a map that is given is believed."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Way:
    """A way, or why there is none.

    Attributes:
        path: (n, 2) m, points from the start to the goal; None where there is no way.
        reason: why there is none, `word: sentence`; None where there is one.
        cost: what it costs, in metres of open floor; infinite where there is none, NaN of a
            planner of the user's.
        climbs: the legs that are climbed, as (first, last) points of the path and the steps.
        end: where it ends: `goal`; `border` of the view, behind which the goal lies; `hope`: on
            unseen ground or a stair behind which it may go on; `look`: from where more is to be
            seen. None where there is no way, and of a planner of the user's.
    """

    path: NDArray[np.float64] | None
    reason: str | None
    cost: float
    climbs: tuple[Climb, ...]
    end: str | None

    def __repr__(self) -> str:
        if self.path is None:
            return f"<Way: none; {self.reason}>"
        x, y = self.path[-1]
        to = f"{len(self.path)} points to ({x:.2f}, {y:.2f}) m"
        return f"<Way of {to}, the {self.end or 'end'}; costs {self.cost:.2f} m>"


def plan(
    view: Map | FloorView | FloorMap,
    start: tuple[float, float, float],
    goal: tuple[float, ...],
    *,
    planner: str | type | object = "a_star",
    robot: str | Path = "qrio",
    start_height: float | None = None,
    goal_radius: float = 0.1,
    overrides: Overrides = (),
) -> Way:
    """Plan a way over floor that is known.

    >>> view = mapping.floor_view(height, cell=0.04)
    >>> way = mapping.plan(view, start=(0, 0, 0), goal=(2, 0), planner="a_star", robot="qrio")
    >>> way.path, way.reason

    Args:
        view: what `Map.view` or `floor_view` returned, or an object with `origin`, `cell`, `kind`
            and `height` as these have them. A `Map` whose robot is named brings its stairs, too.
        start: where the robot stands: x and y, m, and its heading, rad.
        goal: the middle of the disc to go to: x and y, m; and, where several levels lie above each
            other, its height, m.
        planner: a name of `treadwell list components`, `package.module:Class`, or a class or an
            object with the methods of `treadwell.protocols.Planner`.
        robot: a robot's name or folder: how broad it is, what its feet can do.
        start_height: of the ground there, m; None: that of the floor which was seen next to it.
        goal_radius: of the disc, m.
        overrides: settings of `[navigation]`, as in `{"a_star.unknown_cost": 2.0}`; the robot's
            own are below them.

    Raises:
        InputError: an argument that cannot be; it is named.
    """
    # Late: MuJoCo reads the robot, and a map does without it.
    from treadwell.robot.load import load_robot

    world = view if isinstance(view, Map) else None
    floor = _floor(view)
    x, y, yaw = finite_numbers("start", start, 3)
    goal_x, goal_y, *level = finite_numbers("goal", goal, 3 if len(goal) == 3 else 2)
    radius = positive("goal_radius", goal_radius)
    if start_height is not None and not math.isfinite(start_height):
        raise InputError(f"start_height must be finite, got {start_height!r}")
    z = _height_at(floor, x, y) if start_height is None else start_height
    of_robot = load_robot(robot)
    raw = raw_tables(overrides)
    own, name = own_part("planner", planner, raw)
    tables = checked_tables(raw if own else {**raw, "planner": name})
    if own is not None:
        stairs = world.staircase() if world is not None else None
        return _own_way(
            own,
            (floor, stairs or Staircase()),
            Setup(
                (x, y, z, yaw),
                (Goal((goal_x, goal_y), radius, level[0] if level else None),),
                of_robot.description(),
                None,
            ),
        )
    settings = json.dumps(over(over(of_robot.file.navigation, _TRUSTED), tables))
    ways = Ways(name, json.dumps(of_robot.description()), settings)
    seen = world.core if world is not None else None
    if world is not None:
        # The core plans in the map's frame, in which its stairs are.
        ox, oy, oz = world.offset.tolist()
        floor = world.core.view()
    else:
        ox = oy = oz = 0.0
    height = level[0] - oz if level else None
    path, reason, cost, climbs, end = ways.plan(
        floor, (x - ox, y - oy, z - oz, yaw), (goal_x - ox, goal_y - oy, radius, height), seen
    )
    moved = None if path is None else path + np.array((ox, oy))
    return Way(moved, reason, cost, tuple(climbs), end)


def _floor(view: Map | FloorView | FloorMap) -> FloorView:
    if isinstance(view, Map):
        return view.view()
    return view if isinstance(view, FloorView) else FloorView.of(view)


def _height_at(view: FloorView, x: float, y: float) -> float:
    """Return how high the floor is there, m, or where it was seen next to there; 0 if nowhere."""
    rows, cols = np.nonzero(view.kind == 1)
    if not len(rows):
        return 0.0
    at = (np.array((x, y)) - view.origin) / view.cell - 0.5
    nearest = int(np.argmin((cols - at[0]) ** 2 + (rows - at[1]) ** 2))
    return float(view.height[rows[nearest], cols[nearest]])


def _own_way(
    planner: Any,  # noqa: ANN401 - checked for the protocol's method
    seen: tuple[FloorView, Staircase],
    setup: Setup,
) -> Way:
    """Ask a planner of the user's, which is told what it would be told in an episode."""
    if hasattr(planner, "begin"):
        planner.begin(setup)
    made = planner.plan(*seen, setup.start, setup.goals[0])
    if made is None:
        raise InputError("planner: plan() must return a Plan, got None")
    if made.path is None:
        return Way(None, str(made.reason) or "no_path: it said no reason", math.inf, (), None)
    path = np.asarray(made.path)
    if path.ndim != 2 or path.shape[1] != 2 or not np.isfinite(path).all():
        raise InputError(
            f"planner: plan().path must be finite numbers (n, 2), got {path.dtype} {path.shape}"
        )
    return Way(path.astype(np.float64), None, math.nan, (), None)
