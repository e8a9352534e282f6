"""Two steps up or down, and the footsteps that take a robot over them: both feet on each level."""

import math
from dataclasses import dataclass
from typing import Any, Final

from treadwell._core import Walker
from treadwell.trials.world import Footstep, Size

TREAD_M: Final = 0.12
GAP_M: Final = 0.015
"""Of a toe to a riser in front, of a heel to one behind."""
HANG_M: Final = 0.025
"""The most that a heel or a toe hangs over an edge."""
STRIDE_M: Final = 0.08
"""On one tread."""
RUN_M: Final = 0.6
"""Level ground before the first and behind the last edge."""
WIDTH_M: Final = 1.0
SETTLES_S: Final = 0.5
"""All of these for a scale of 1."""
STEPS: Final = 2
SIDES: Final = ("left", "right")


@dataclass(frozen=True, slots=True)
class Level:
    """A level from `front` to `back` along x, m."""

    front: float
    back: float
    height: float


def levels(size: Size, rise_m: float) -> list[Level]:
    """Return the levels; the robot stands at x = 0 with its toes before the first edge.

    Args:
        size: of the robot.
        rise_m: of each step; below zero: down.
    """
    scale = size.scale
    tread = max(TREAD_M * scale, size.sole_m + GAP_M * scale)
    edge = 0.5 * size.sole_m + (GAP_M if rise_m > 0.0 else 0.005) * scale
    height = max(0.0, -STEPS * rise_m)
    found = [Level(edge - RUN_M * scale, edge, height)]
    for number in range(STEPS):
        height += rise_m
        depth = tread if number + 1 < STEPS else RUN_M * scale
        found.append(Level(edge, edge + depth, height))
        edge += depth
    return found


def elements(found: list[Level], scale: float) -> list[dict[str, Any]]:
    """Return the levels as elements of a scenario."""
    return [
        {
            "kind": "platform",
            "name": f"level {index}",
            "position": [0.5 * (level.front + level.back), 0.0],
            "yaw": 0.0,
            "size": [level.back - level.front, WIDTH_M * scale, level.height],
        }
        for index, level in enumerate(found)
        if level.height > 1e-6
    ]


@dataclass(frozen=True, slots=True)
class _Stand:
    """Where both feet are to stand side by side."""

    x: float
    level: Level

    def foot(
        self, side: str, size: Size, robot: tuple[float, float, float], ground: float
    ) -> Footstep:
        """Return the footstep relative to the robot's frame over its ground."""
        half = 0.5 * size.sole_m
        y = 0.5 * size.stance_m * (1.0 if side == "left" else -1.0)
        dx, dy = self.x - robot[0], y - robot[1]
        cos, sin = math.cos(robot[2]), math.sin(robot[2])
        bears = (max(-half, self.level.front - self.x), min(half, self.level.back - self.x))
        place = (cos * dx + sin * dy, cos * dy - sin * dx, -robot[2])
        return (side, *place, self.level.height - ground, *bears, "careful", (0.0, 0.0))


def _stands(found: list[Level], size: Size) -> list[_Stand]:
    """Return the stands one after the other: on each level as few as the legs' reach allows."""
    half, scale, out = 0.5 * size.sole_m, size.scale, []
    gap, hang = GAP_M * scale, HANG_M * scale
    for index, level in enumerate(found[1:], start=1):
        rises = level.height > found[index - 1].height
        least = level.front + half + (-hang if rises else gap)
        first = level.front + half + (0.0 if rises else gap)
        if index + 1 == len(found):
            out.append(_Stand(first, level))
            break
        most = level.back - half + (-gap if rises else hang)
        goal = level.back - half + (-gap if rises else 0.0)
        at = max(min(first, most), least) if least <= most else 0.5 * (least + most)
        out.append(_Stand(at, level))
        while goal - at > 0.01 * scale:
            at += min(goal - at, STRIDE_M * scale)
            out.append(_Stand(at, level))
    return out


class Climber:
    """Gives the footsteps onto one level after the other, and stands a while between them.

    Attributes:
        misstep: why a step was taken back, or None.
        finished: when all was climbed, or a step taken back, s; infinite until then.
    """

    def __init__(self, found: list[Level], size: Size) -> None:
        """Plan the stands."""
        self._stands, self._size = _stands(found, size), size
        self._settle = SETTLES_S * size.scale**0.5
        self._steps: list[Footstep] = []
        self._done = 0
        self._since = self._settle
        self.misstep: str | None = None
        self.finished = math.inf

    @property
    def has_climbed(self) -> bool:
        """Whether both feet stand on the last level."""
        return self._done == len(self._stands)

    @property
    def count(self) -> int:
        """How many stands there are."""
        return len(self._stands)

    def motion(self, now: float, walker: Walker, start_height: float) -> list[Footstep] | None:
        """Return the footsteps for this tick."""
        if self._steps and walker.standing:
            landed, _, misstep = walker.stepping
            if misstep or landed >= len(self._steps):
                self._since, self._steps = now, []
                self._done += not misstep
                self.misstep = misstep
                if misstep or self.has_climbed:
                    self.finished = now
        elif not self._steps and now - self._since >= self._settle and self.finished > now:
            robot, ground = walker.odometry, start_height + walker.ground
            stand = self._stands[self._done]
            self._steps = [stand.foot(side, self._size, robot, ground) for side in SIDES]
        return self._steps or None
