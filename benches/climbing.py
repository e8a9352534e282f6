"""Stairs, sills and basins for walking trials: where the feet go, and in which order."""

import math
from dataclasses import dataclass
from functools import cache

import mujoco
import numpy as np

from treadwell._core import Walker
from treadwell.robot.load import load_robot
from treadwell.trials.stairs import Level as Tread

GAP_M = 0.015
"""Of a toe to a riser in front, of a heel to one behind (003, Table I), for `qrio`."""
HANG_M = 0.025
"""The most that a heel or a toe hangs over an edge (003, Table I)."""
STRIDE_M = 0.08
"""On one tread."""
RUN_M = 0.6
"""Level ground before the first and behind the last edge."""
LISTED = 12
"""Steps of a list on level ground."""
CAREFUL = 0.4
"""Share of them that are careful."""

Footstep = tuple[str, float, float, float, float, float, float, str]
Pose = tuple[float, float, float]


@dataclass(frozen=True)
class Sizes:
    """What of a trial goes by the robot's size.

    Attributes:
        scale: its legs over those of `qrio`: lengths go by it, times and speeds by its root.
        half_sole: half of a sole's length, m.
        stance: distance of the soles side by side, m.
    """

    scale: float = 1.0
    half_sole: float = 0.0525
    stance: float = 0.085

    @property
    def pace(self) -> float:
        """What times and speeds are multiplied by."""
        return math.sqrt(self.scale)


@cache
def sizes_of(name: str) -> Sizes:
    """Return the sizes of a robot."""
    robot = load_robot(name)
    description = robot.description()
    data = mujoco.MjData(robot.nominal)
    data.qpos[7:] = description["stand"]
    mujoco.mj_kinematics(robot.nominal, data)
    soles = [leg.sole for leg in (robot.file.legs.left, robot.file.legs.right)]
    left, right = (
        data.body(sole.link).xpos + data.body(sole.link).xmat.reshape(3, 3) @ sole.position
        for sole in soles
    )
    return Sizes(
        scale=description.get("scale", 1.0),
        half_sole=soles[0].length / 2,
        stance=description["gait"].get("stance_width") or float(left[1] - right[1]),
    )


@dataclass(frozen=True)
class Errors:
    """Bounds of what was seen wrong: heights and edges, metres."""

    height: float = 0.0
    x: float = 0.0


def course(rises: list[float], depths: list[float], sizes: Sizes) -> list[Tread]:
    """Return the levels; the robot stands at x = 0 with its toes at the first edge."""
    edge = sizes.half_sole + sizes.scale * (GAP_M if rises[0] > 0 else 0.005)
    run = sizes.scale * RUN_M
    lowest = min(0.0, *np.cumsum(rises))
    height = -float(lowest)
    treads = [Tread(edge - run, edge, height)]
    for rise, depth in zip(rises, [*depths, run], strict=True):
        height += rise
        treads.append(Tread(edge, edge + depth, height))
        edge += depth
    return treads


def seen(treads: list[Tread], errors: Errors, rng: np.random.Generator) -> list[Tread]:
    """Return the levels as they are believed to be, but for the one that the robot stands on."""
    edges = [tread.back + rng.uniform(-errors.x, errors.x) for tread in treads]
    heights = [tread.height + rng.uniform(-errors.height, errors.height) for tread in treads[1:]]
    believed = [Tread(treads[0].front, edges[0], treads[0].height)]
    for before, after, height in zip(edges[:-1], edges[1:], heights, strict=True):
        believed.append(Tread(before, after, height))
    return believed


@dataclass(frozen=True)
class Stand:
    """Where both feet are to stand side by side, and the level there."""

    x: float
    tread: Tread
    sizes: Sizes

    def foot(self, side: str, robot: Pose, ground: float) -> Footstep:
        """Return the footstep relative to the robot's frame over its ground."""
        half_sole, half = self.sizes.half_sole, self.sizes.stance / 2
        y = half if side == "left" else -half
        dx, dy = self.x - robot[0], y - robot[1]
        cos, sin = math.cos(robot[2]), math.sin(robot[2])
        bears = (
            max(-half_sole, self.tread.front - self.x),
            min(half_sole, self.tread.back - self.x),
        )
        place = (cos * dx + sin * dy, cos * dy - sin * dx, -robot[2])
        return (side, *place, self.tread.height - ground, *bears, "careful", (0.0, 0.0))


def stands(treads: list[Tread], sizes: Sizes) -> list[Stand]:
    """Return the stands one after the other: on each level as few as the legs' reach allows."""
    half_sole = sizes.half_sole
    gap, hang, stride = (sizes.scale * way for way in (GAP_M, HANG_M, STRIDE_M))
    out = []
    for index, tread in enumerate(treads[1:], start=1):
        rises = tread.height > treads[index - 1].height
        least = tread.front + half_sole + (-hang if rises else gap)
        first = tread.front + half_sole + (0.0 if rises else gap)
        if index + 1 == len(treads):
            out.append(Stand(first, tread, sizes))
            break
        rises_next = treads[index + 1].height > tread.height
        most = tread.back - half_sole + (-gap if rises_next else hang)
        goal = tread.back - half_sole + (-gap if rises_next else 0.0)
        at = max(min(first, most), least) if least <= most else (least + most) / 2
        out.append(Stand(at, tread, sizes))
        while goal - at > 0.01 * sizes.scale:
            at += min(goal - at, stride)
            out.append(Stand(at, tread, sizes))
    return out


def pairs(treads: list[Tread], sizes: Sizes) -> list[list[tuple[str, Stand]]]:
    """Return lists of footsteps with both feet on each stand."""
    return [[("left", stand), ("right", stand)] for stand in stands(treads, sizes)]


def alternating(treads: list[Tread], sizes: Sizes) -> list[list[tuple[str, Stand]]]:
    """Return one list with a foot a stand, the feet side by side at the end."""
    sides = ("left", "right")
    steps = [(sides[index % 2], stand) for index, stand in enumerate(stands(treads, sizes))]
    last, stand = steps[-1]
    return [[*steps, ("right" if last == "left" else "left", stand)]]


def level_steps(rng: np.random.Generator, sizes: Sizes) -> list[Footstep]:
    """Steps forward and back, aside and turning, walked and careful; the last feet together."""
    scale, half_sole, stance = sizes.scale, sizes.half_sole, sizes.stance
    steps: list[Footstep] = []
    feet = {"left": (0.0, stance / 2, 0.0), "right": (0.0, -stance / 2, 0.0)}
    turn, begins = rng.uniform(-0.12, 0.12), rng.integers(2)
    for index in range(LISTED):
        side, sign = (("left", 1.0), ("right", -1.0))[(index + begins) % 2]
        x, y, yaw = feet["right" if side == "left" else "left"]
        last = index + 1 == LISTED
        ahead = 0.0 if last else scale * rng.uniform(-0.03, 0.07)
        aside = sign * (stance + (0.0 if last else scale * rng.uniform(0.0, 0.03)))
        cos, sin = math.cos(yaw), math.sin(yaw)
        turned = yaw + (0.0 if last else 2.0 * sign * max(0.0, sign * turn))
        feet[side] = (x + cos * ahead - sin * aside, y + sin * ahead + cos * aside, turned)
        manner = "careful" if rng.random() < CAREFUL else "walked"
        steps.append((side, *feet[side], 0.0, -half_sole, half_sole, manner, (0.0, 0.0)))
    return steps


class Climber:
    """Gives the lists one after the other, and stands a while between them."""

    def __init__(
        self, lists: list[list[tuple[str, Stand]]], settle_s: float, start_s: float
    ) -> None:
        self.lists = lists
        self.settle_s = settle_s
        self.start_s = start_s
        self.steps: list[Footstep] = []
        self.done = 0
        self.since = start_s - settle_s
        self.finished = math.inf
        self.misstep: str | None = None

    def motion(self, now: float, walker: Walker, start_height: float) -> list[Footstep] | None:
        """Return the footsteps for this tick."""
        if self.steps and walker.standing:
            landed, _, misstep = walker.stepping
            if misstep or landed >= len(self.steps):
                self.since, self.steps = now, []
                self.done += not misstep
                self.misstep = misstep
                if misstep or self.done == len(self.lists):
                    self.finished = now
        elif not self.steps and now - self.since >= self.settle_s and self.finished > now:
            robot, ground = walker.odometry, start_height + walker.ground
            self.steps = [stand.foot(side, robot, ground) for side, stand in self.lists[self.done]]
        return self.steps or None

    def is_over(self, now: float) -> bool:
        """Return whether all is climbed, or a step was taken back, a second ago."""
        return now > self.finished + 1.0

    def seconds_per_stand(self) -> float:
        """Return the mean time for one list, standing included."""
        return (self.since - self.start_s) / self.done if self.done else math.nan
