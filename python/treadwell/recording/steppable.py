"""Which surfaces that a run knew as stairs are stairs for its robot: for `map.png`.

The recognizer of stairs keeps every level surface with an edge, the top of a wall, too; the planner
looks what feet can do. A person who looks at the picture would call only some of them stairs.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from treadwell.map_memory import FLOOR, RememberedMap
from treadwell.trace import StairTrace

if TYPE_CHECKING:
    # A replay keeps stairs without MuJoCo, which reads a robot.
    from treadwell.robot.load import Robot
    from treadwell.scenario.model import Scenario

_KNEE: Final = 0.285
"""Height of a person's knee, of that of the whole body (Drillis and Contini 1966): what is higher
is a wall or furniture, and no stair."""
_ALONG: Final = (0.2, 0.35, 0.5, 0.65, 0.8)
"""Places on an edge, as parts of its length, at which what lies beyond it is looked for."""
_BEYOND: Final = (1, 2, 3, 4)
"""Cells beyond an edge at which it is."""
_SURE: Final = 2
"""From so many cells on a cell of the map has seen only what lies beyond the edge."""


@dataclass(frozen=True, slots=True)
class StepLimits:
    """Which changes of height are steps for a robot, m.

    Attributes:
        floor: up to this it is one floor.
        up: the highest step up.
        down: the highest step down.
        knee: what is higher is no stair for anybody of its size.
    """

    floor: float
    up: float
    down: float
    knee: float

    def steps(self, rise: float) -> bool:
        """Say whether a change of height is a step that the robot takes."""
        return self.floor < rise <= self.up or self.floor < -rise <= self.down


def step_limits(scenario: "Scenario", robot: "Robot") -> StepLimits:
    """Return the limits of a run, with what a measured height may be off."""
    from treadwell.solving.robot_limits import limits_of

    own = limits_of(scenario, robot)
    up, down = (own.for_(sign).highest + own.tolerance for sign in (1.0, -1.0))
    return StepLimits(own.floor_max, up, down, _KNEE * robot.file.body.height)


def told_apart(
    stairs: Sequence[StairTrace], remembered: RememberedMap, limits: StepLimits
) -> tuple[list[StairTrace], list[StairTrace]]:
    """Return the stairs that the robot can step on or off, and those that are too high for it.

    What differs from all around it by more than a knee, or by nothing, is neither.

    Args:
        stairs: as they were seen.
        remembered: what the map said of the cells around them.
        limits: of the robot.
    """
    steps, too_high = [], []
    for stair in stairs:
        rises = [rise for rise in _rises(stair, stairs, remembered) if rise is not None]
        if any(map(limits.steps, rises)):
            steps.append(stair)
        elif any(limits.floor < abs(rise) <= limits.knee for rise in rises):
            too_high.append(stair)
    return steps, too_high


def _rises(
    stair: StairTrace, stairs: Sequence[StairTrace], remembered: RememberedMap
) -> Iterator[float | None]:
    """Yield the change of height onto a stair over each of its two edges, None where unseen."""
    front, back = stair.front[:, :2], stair.back[:, :2]
    over = front.mean(axis=0) - back.mean(axis=0)
    over /= max(float(np.hypot(*over)), 1e-9)
    others = [other for other in stairs if other is not stair]
    for (left, right), out in ((front, over), (back, -over)):
        found = [_beyond(left + part * (right - left), out, others, remembered) for part in _ALONG]
        heights = [height for height in found if not math.isnan(height)]
        yield stair.height() - float(np.median(heights)) if heights else None


def _beyond(
    at: NDArray[np.float64],
    out: NDArray[np.float64],
    others: Sequence[StairTrace],
    remembered: RememberedMap,
) -> float:
    """Return the height of what is next beyond a place on an edge, m; NaN where nothing was."""
    for cells in _BEYOND:
        place = at + cells * remembered.cell * out
        for other in others:
            if contains(outline(other), place):
                return other.height()
        if cells >= _SURE:
            x, y = (place - remembered.origin) / remembered.cell
            row, col = math.floor(y), math.floor(x)
            rows, cols = remembered.kind.shape
            if 0 <= row < rows and 0 <= col < cols and remembered.kind[row, col] == FLOOR:
                return float(remembered.height[row, col])
    return math.nan


def outline(stair: StairTrace) -> NDArray[np.float64]:
    """Return a stair's corners from above, (4, 2) m: front left and right, back right and left."""
    corners: NDArray[np.float64] = np.vstack([stair.front, stair.back[::-1]])[:, :2]
    return corners


def contains(corners: NDArray[np.float64], point: NDArray[np.float64]) -> bool:
    """Say whether a point lies inside a convex polygon, whichever way round it is given."""
    along, to = np.concatenate([corners[1:], corners[:1]]) - corners, point - corners
    sides = along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]
    return bool((sides >= 0.0).all() or (sides <= 0.0).all())
