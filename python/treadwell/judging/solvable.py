"""Whether there is a way at all: a search on the true course within the robot's published limits.

What a robot refuses is justified where this finds none. Truth-side only: the core never asks.
"""

from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from treadwell.core_settings import navigation_parameters
from treadwell.course.build import LEVEL_TOLERANCE, Course
from treadwell.course.outlines import Floats
from treadwell.judging.true_ground import BARELY, Mask, TrueGround, edges_of
from treadwell.robot.load import Robot
from treadwell.scenario.events import Kidnap
from treadwell.scenario.model import Scenario

PROBE: Final = 0.005
"""Metres between two looks at the ground along a line over an edge."""
LONGEST_FLIGHT: Final = 6.0
"""Metres of treads in a row, on none of which the robot can stand as on a floor."""
MOST_EDGES: Final = 40
PART: Final = 40
"""Probes that are made at a time."""
FLAT: Final = 0.01
"""Metres by which a tread may differ from side to side."""
EVERY: Final = 0.08
"""Metres between two lines over the same edge."""
FOOT_GAP: Final = 0.01

Node = tuple[int, int, int]
"""Surface, row and column."""


@dataclass(frozen=True, slots=True)
class OneWay:
    """The limits of steps up, or of steps down, as in `[navigation.climbing.ascend]`."""

    highest: float
    front_x_limit: float
    back_x_limit: float


@dataclass(frozen=True, slots=True)
class Limits:
    """What a robot can do, by its folder and the scenario, metres."""

    radius: float
    tall: float
    sole: float
    pair: float
    floor_max: float
    tolerance: float
    side_room: float
    up: OneWay
    down: OneWay

    @property
    def half_width(self) -> float:
        """Half of what both feet need on a stair."""
        return self.pair / 2 + self.side_room

    def for_(self, rise: float) -> OneWay:
        """Return the limits of a change of height."""
        return self.up if rise > 0.0 else self.down


def limits_of(scenario: Scenario, robot: Robot) -> Limits:
    """Return a robot's limits; where nothing is published, the core's defaults hold."""
    body, sole = robot.file.body, robot.file.legs.left.sole
    parameters = navigation_parameters(scenario, robot)
    climbing: dict[str, Any] = parameters.get("climbing", {})
    up, down = climbing.get("ascend", {}), climbing.get("descend", {})
    planner = parameters.get(scenario.navigation.planner, {})
    turned = body.depth if planner.get("footprint") == "oriented" else None
    return Limits(
        radius=turned / 2 if turned else body.radius,
        tall=body.height,
        sole=sole.length,
        pair=2 * sole.width + FOOT_GAP,
        floor_max=climbing.get("floor_max", 0.01),
        tolerance=climbing.get("tolerance", 0.0025),
        side_room=climbing.get("side_room", 0.02),
        up=OneWay(
            up.get("step_max_z", 0.050),
            up.get("front_x_limit", -0.025),
            up.get("back_x_limit", -0.005),
        ),
        down=OneWay(
            -down.get("step_min_z", -0.050),
            down.get("front_x_limit", 0.015),
            down.get("back_x_limit", 0.025),
        ),
    )


def is_solvable(scenario: Scenario, course: Course, robot: Robot) -> bool | None:
    """Say whether a way leads from the start over all points to pass to the goal.

    None where the robot is carried elsewhere on the way: from where, the search does not know.

    Args:
        scenario: as it is run.
        course: built from it.
        robot: whose limits hold.
    """
    if any(isinstance(event, Kidnap) for event in scenario.event):
        return None
    limits = limits_of(scenario, robot)
    stops = [scenario.start.position, *scenario.goal.via, scenario.goal.position]
    ground = TrueGround(course, stops, radius=limits.radius, tall=limits.tall)
    stand = ground.standing(limits.pair / 2, limits.floor_max)
    reached = _reached(ground, stand, limits, _start(ground, stand, scenario, course))
    heights = [None] * len(scenario.goal.via) + [scenario.goal.height]
    return all(
        _holds(ground, reached, stop, scenario.goal.radius, height)
        for stop, height in zip(stops[1:], heights, strict=True)
    )


def _start(ground: TrueGround, stand: Mask, scenario: Scenario, course: Course) -> set[Node]:
    """Return where the robot begins: where it stands, or what is free within a step of it."""
    x, y = scenario.start.position
    row, column = ground.index(x, y)
    reach = 3
    found: list[tuple[int, Node]] = []
    for r in range(row - reach, row + reach + 1):
        for c in range(column - reach, column + reach + 1):
            for surface in np.flatnonzero(stand[:, r, c]):
                if abs(ground.height[surface, r, c] - course.start.height) <= LEVEL_TOLERANCE:
                    away = (r - row) ** 2 + (c - column) ** 2
                    found.append((away, (int(surface), r, c)))
    nearest = min((away for away, _ in found), default=0)
    return {node for away, node in found if away == nearest}


def _reached(ground: TrueGround, stand: Mask, limits: Limits, start: set[Node]) -> Mask:
    """Return what can be reached on foot and over edges."""
    links: dict[Node, list[Node]] = defaultdict(list)
    for here, there in _climbs(ground, stand, limits):
        links[here].append(there)
    around = _around(ground, stand, limits)
    reached = np.zeros_like(stand)
    front = deque(start)
    for node in start:
        reached[node] = True
    while front:
        node = front.popleft()
        for other in (*around(node), *links.get(node, ())):
            if not reached[other]:
                reached[other] = True
                front.append(other)
    return reached


def _around(ground: TrueGround, stand: Mask, limits: Limits) -> Callable[[Node], Iterator[Node]]:
    """Return what says where one step on foot leads from a node."""
    most = limits.floor_max + BARELY
    height, rows, columns = ground.height, *stand.shape[1:]

    def around(node: Node) -> Iterator[Node]:
        surface, row, column = node
        level = float(height[node])
        for r, c in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if 0 <= r < rows and 0 <= c < columns:
                if stand[surface, r, c]:
                    yield surface, r, c
                for other in np.flatnonzero(stand[:, r, c]) if several[r, c] else ():
                    if other != surface and abs(height[other, r, c] - level) <= most:
                        yield int(other), r, c

    # Of most cells there is one surface, and its neighbours' are the same.
    edge = np.zeros(stand.shape[1:], dtype=bool)
    which = np.where(stand.any(axis=0), stand.argmax(axis=0), -1)
    edge[1:] |= which[1:] != which[:-1]
    edge[:-1] |= which[1:] != which[:-1]
    edge[:, 1:] |= which[:, 1:] != which[:, :-1]
    edge[:, :-1] |= which[:, 1:] != which[:, :-1]
    several = edge | (stand.sum(axis=0) > 1)
    return around


def _climbs(ground: TrueGround, stand: Mask, limits: Limits) -> Iterator[tuple[Node, Node]]:
    """Yield from where to where straight ways over edges lead that the robot can climb."""
    feet, ways = _feet(ground, limits)
    if not len(feet):
        return
    step = 2 * PROBE * ways
    before, behind = ground.heights(feet - step), ground.heights(feet + step)
    highest = max(limits.up.highest, limits.down.highest) + limits.tolerance
    for i in range(len(feet)):
        rises = np.abs(before[:, i][:, None] - behind[:, i][None, :])
        if ((rises > limits.floor_max) & (rises <= highest)).any():
            for ahead in (ways[i], -ways[i]):
                climb = _Line(ground, stand, limits, feet[i], ahead).climb()
                if climb is not None:
                    yield climb


def _feet(ground: TrueGround, limits: Limits) -> tuple[Floats, Floats]:
    """Return points on edges, far enough from their ends, and the edges' normals, (n, 2) both."""
    feet, ways = [], []
    room = limits.half_width
    for top in ground.tops:
        for begin, end, normal in edges_of(top):
            length = float(np.linalg.norm(end - begin))
            if length >= 2 * room:
                count = 1 + int((length - 2 * room) / EVERY)
                for share in np.linspace(room / length, 1.0 - room / length, count):
                    feet.append(begin + share * (end - begin))
                    ways.append(normal)
    return np.array(feet).reshape(-1, 2), np.array(ways).reshape(-1, 2)


class _Line:
    """A straight way over an edge: the ground along it, looked at as far as it is asked for."""

    def __init__(
        self, ground: TrueGround, stand: Mask, limits: Limits, foot: Floats, ahead: Floats
    ) -> None:
        """Look at nothing yet.

        Args:
            ground: the course.
            stand: where the robot can stand.
            limits: the robot's.
            foot: a point of the edge.
            ahead: unit vector, the way of walking.
        """
        self._ground, self._stand, self._limits = ground, stand, limits
        self._foot, self._ahead = foot, ahead
        self._side = limits.half_width * np.array([-ahead[1], ahead[0]])
        self._known: dict[int, Floats] = {}

    def climb(self) -> tuple[Node, Node] | None:
        """Return from where to where it leads; None where the robot cannot go."""
        for surface in np.flatnonzero(np.isfinite(self._heights(-1))):
            level = float(self._heights(-1)[surface])
            behind = self._follow(level, -1)
            ahead = None if behind is None else self._follow(level, 1)
            if behind is None or ahead is None or not ahead[1]:
                continue
            edges = [(at, -rise) for at, rise in reversed(behind[1])] + ahead[1]
            if self._fits(edges):
                return behind[0], ahead[0]
        return None

    def _follow(self, level: float, way: int) -> tuple[Node, list[tuple[float, float]]] | None:
        """Go along the line until the robot could stand; return where, and the edges between."""
        edges: list[tuple[float, float]] = []
        for i in range(-1, way * int(LONGEST_FLIGHT / PROBE), way):
            heights = self._heights(i)
            if not np.isfinite(heights).any():
                return None
            surface = int(np.nanargmin(np.abs(heights - level)))
            rise = float(heights[surface]) - level
            if abs(rise) > self._limits.floor_max:
                edges.append(((i + 0.5) * PROBE - way * PROBE / 2, rise))
            level = float(heights[surface])
            x, y = self._point((i + 0.5) * PROBE)
            row, column = self._ground.index(x, y)
            inside = 0 <= row < self._stand.shape[1] and 0 <= column < self._stand.shape[2]
            if not inside or len(edges) > MOST_EDGES:
                return None
            # Ahead there has to be the edge that the line is about, or one stands still.
            if self._stand[surface, row, column] and (edges or way < 0):
                return (surface, row, column), edges
        return None

    def _fits(self, edges: list[tuple[float, float]]) -> bool:
        limits = self._limits
        for number, (at, rise) in enumerate(edges):
            own = limits.for_(rise)
            if abs(rise) > own.highest + limits.tolerance:
                return False
            beyond = 0.05
            if number + 1 < len(edges):
                depth = edges[number + 1][0] - at
                following = limits.for_(edges[number + 1][1])
                needed = own.front_x_limit + limits.sole - following.back_x_limit
                if depth < needed - PROBE:
                    return False
                beyond = depth / 2
            if not self._wide(at + beyond):
                return False
        return True

    def _wide(self, at: float) -> bool:
        """Say whether both feet have the same floor at a place of the line."""
        middle = self._foot + at * self._ahead
        three = self._ground.heights(np.stack([middle, middle - self._side, middle + self._side]))
        return all(
            bool((np.abs(three[:, side][:, None] - three[:, 0][None, :]) <= FLAT).any())
            for side in (1, 2)
        )

    def _point(self, at: float) -> tuple[float, float]:
        x, y = (self._foot + at * self._ahead).tolist()
        return x, y

    def _heights(self, i: int) -> Floats:
        """Return the surfaces' heights at the i-th place from the edge; never on the edge."""
        part, place = divmod(i, PART)
        if part not in self._known:
            at = PROBE * (np.arange(part * PART, (part + 1) * PART) + 0.5)
            self._known[part] = self._ground.heights(self._foot + at[:, None] * self._ahead)
        heights: Floats = self._known[part][:, place]
        return heights


def _holds(
    ground: TrueGround,
    reached: Mask,
    place: tuple[float, float],
    radius: float,
    height: float | None,
) -> bool:
    """Say whether a reached node lies in a disc."""
    row, column = ground.index(*place)
    cells = int(radius / ground.cell) + 1
    for r in range(row - cells, row + cells + 1):
        for c in range(column - cells, column + cells + 1):
            x, y = ground.centre(r, c)
            if (x - place[0]) ** 2 + (y - place[1]) ** 2 > radius**2:
                continue
            for surface in np.flatnonzero(reached[:, r, c]):
                level = float(ground.height[surface, r, c])
                if height is None or abs(level - height) <= LEVEL_TOLERANCE:
                    return True
    return False
