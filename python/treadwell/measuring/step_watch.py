"""What the robot knew of each step before it climbed it, against the truth; and of a basin's width.

For scoring alone: nothing of it may enter the core.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Stair
from treadwell.course.course import Course
from treadwell.episode import Episode, Step
from treadwell.judging.level_changes import LEAST_CHANGE, LOOKS_A_FOOTPRINT
from treadwell.trace import Sole

Floats = NDArray[np.float64]

HEIGHT_M, EDGE_M, HEADING_RAD = 0.003, 0.010, math.radians(3.0)
"""What is asked of a step's height, of its front edge and of its heading."""
_SAME_STEP_M = 0.06
"""A stair that is believed to begin further from the true edge is another one."""


@dataclass(frozen=True)
class StepError:
    """A step as it was believed to be before a foot left for it, minus what it was.

    Attributes:
        time: s.
        rise: m, true.
        height: m, of the surface against that which the robot stood on; NaN: not believed in.
        edge: m, where its front edge lies ahead of the robot, on the foot's line.
        heading: rad, of that edge.
    """

    time: float
    rise: float
    height: float
    edge: float
    heading: float

    def is_known(self) -> bool:
        """Whether the robot believed in it at all."""
        return math.isfinite(self.height)

    def within(self) -> bool:
        """Whether height, edge and heading are as near as is asked for."""
        edge = abs(self.edge) <= EDGE_M and abs(self.heading) <= HEADING_RAD
        return abs(self.height) <= HEIGHT_M and edge


@dataclass(frozen=True)
class KnownTop:
    """A surface that was believed in: a point on it in the map and its depth on the way, m."""

    x: float
    y: float
    z: float
    depth: float


@dataclass(frozen=True)
class Belief:
    """What was known while both soles stood on one level: stairs, the pose believed and true."""

    stairs: Sequence[Stair]
    believed: tuple[float, float, float, float]
    true: tuple[float, float, float, float]


class StepWatch:
    """Watches an episode.

    Attributes:
        steps: an entry for each step made from a stand of both soles on one level.
        planned: most steps that a plan had.
        tops: surfaces believed in at the last frame that had some.
    """

    def __init__(self, episode: Episode) -> None:
        """Watch this episode."""
        self._episode = episode
        self._belief: Belief | None = None
        self._measured: list[Stair] = []
        self._looks = [0, 0]
        self._prints: list[Sole | None] = [None, None]
        self.steps: list[StepError] = []
        self.planned = 0
        self.tops: tuple[KnownTop, ...] = ()

    def tick(self, step: Step) -> None:
        """Take in a control tick, after the judge has."""
        judge = self._episode.judge
        if step.observation.depth is not None:
            pilot = self._episode.pilot
            climbs = pilot.climbs() or []
            self.planned = max(self.planned, sum(len(climb.steps) for climb in climbs))
            stairs = pilot.staircase().stairs
            self._remember(stairs)
            if self._is_level():
                true = judge.observed
                pose = (true.x, true.y, true.z, true.yaw)
                self._belief = Belief([*self._measured, *stairs], step.estimate.pose, pose)
            if stairs:
                self.tops = tuple(KnownTop(*stair.reference, stair.depth) for stair in stairs)
        if judge.soles is None:
            return
        looks, touch = self._looks, judge.touch
        looks[0] = looks[0] + 1 if touch.left else 0
        if looks[0] == LOOKS_A_FOOTPRINT:
            self._footprint(0, judge.soles[0], 1e-9 * step.time_ns)
        looks[1] = looks[1] + 1 if touch.right else 0
        if looks[1] == LOOKS_A_FOOTPRINT:
            self._footprint(1, judge.soles[1], 1e-9 * step.time_ns)

    def _remember(self, stairs: Sequence[Stair]) -> None:
        """Keep stairs with a fitted front edge: from near by, that edge is out of view."""
        for stair in stairs:
            if stair.front_fit is not None:
                self._measured = [old for old in self._measured if not _is_same(old, stair)]
                self._measured.append(stair)

    def _is_level(self) -> bool:
        """Say whether both soles have taken their places, on one level."""
        left, right = self._prints
        if left is None or right is None or min(self._looks) < LOOKS_A_FOOTPRINT:
            return False
        return abs(left.z - right.z) < LEAST_CHANGE / 2

    def _footprint(self, side: int, sole: Sole, time: float) -> None:
        before, other = self._prints[side], self._prints[1 - side]
        self._prints[side] = sole
        if before is None or other is None or self._belief is None:
            return
        rise = sole.z - before.z
        first = abs(sole.z - other.z) >= LEAST_CHANGE
        if abs(rise) < LEAST_CHANGE or not first:
            return
        edge = true_edge(self._episode.course, before, sole)
        if edge is not None:
            self.steps.append(_error(self._belief, edge, sole.z, rise, time))
            # The next step is judged by what is known on this one: who does not stop on it is not.
            self._belief = None


def true_edge(course: Course, before: Sole, after: Sole) -> tuple[Floats, float] | None:
    """Return where a foot crossed an edge, (2,) world m, and the heading square to it, rad."""
    start, way = np.array([before.x, before.y]), np.array([after.x - before.x, after.y - before.y])
    points = start + np.linspace(0.0, 1.0, 400)[:, None] * way
    jumps = np.abs(np.diff(course.height_at(points)))
    if not len(jumps) or jumps.max() < LEAST_CHANGE / 2:
        return None
    crossing = points[int(np.argmax(jumps))]
    best, heading, on_edge = math.inf, 0.0, crossing
    for _, top in course.tops():
        corners = top.polygon[:, :2]
        for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            along = (end - begin) / np.linalg.norm(end - begin)
            normal = np.array([-along[1], along[0]])
            share = float((crossing - begin) @ along) / float(np.linalg.norm(end - begin))
            off = abs(float((crossing - begin) @ normal))
            if off < best and -0.05 < share < 1.05 and abs(normal @ way) > 0.5 * np.hypot(*way):
                best = off
                normal = normal if normal @ way > 0.0 else -normal
                heading = math.atan2(normal[1], normal[0])
                # The samples are a millimetre apart: to the edge itself.
                on_edge = crossing + way * ((begin - crossing) @ normal) / (way @ normal)
    return (on_edge, heading) if best < 0.005 else None


def _error(
    belief: Belief, edge: tuple[Floats, float], level: float, rise: float, time: float
) -> StepError:
    x, y = _seen_from(belief.true, edge[0])
    heading = edge[1] - belief.true[3]
    best = StepError(time, rise, math.nan, math.nan, math.nan)
    nearest = (True, _SAME_STEP_M)
    for stair in belief.stairs:
        left, right = (_seen_from(belief.believed, np.array(end[:2])) for end in stair.front)
        believed = math.atan2(-(left[0] - right[0]), left[1] - right[1])
        turn = math.remainder(believed - heading, 2 * math.pi)
        normal = np.array([math.cos(believed), math.sin(believed)])
        off = float(((left + right) / 2 - (x, y)) @ normal)
        height = stair.height - belief.believed[2] - (level - belief.true[2])
        # A measured edge counts before one that is only where the view ended.
        order = (stair.front_fit is None, abs(off))
        is_it = abs(off) < _SAME_STEP_M and abs(turn) < math.pi / 4
        if is_it and abs(height) < LEAST_CHANGE and order < nearest:
            nearest = order
            best = StepError(time, rise, height, off, turn)
    return best


def _is_same(first: Stair, second: Stair) -> bool:
    """Say whether two sights are of one stair."""
    (x, y, z), (other_x, other_y, other_z) = _front_middle(first), _front_middle(second)
    near = math.hypot(x - other_x, y - other_y) < _SAME_STEP_M
    return near and abs(z - other_z) < LEAST_CHANGE


def _front_middle(stair: Stair) -> tuple[float, float, float]:
    (x, y, z), (other_x, other_y, other_z) = stair.front
    return (x + other_x) / 2, (y + other_y) / 2, (z + other_z) / 2


def _seen_from(pose: tuple[float, float, float, float], point: Floats) -> Floats:
    """Return a point (2,) of the world or map in the frame of a robot at a pose (x, y, z, yaw)."""
    c, s = math.cos(pose[3]), math.sin(pose[3])
    dx, dy = point[0] - pose[0], point[1] - pose[1]
    return np.array([c * dx + s * dy, -s * dx + c * dy])
