"""Whether there is a way at all: a search on the true course within the robot's published limits.

It asks for room for the body and the head, on walks and over climbs, for steps and treads that can
be climbed, and for slopes of 10 degrees or less. What a robot refuses is justified where this finds
none. Truth-side only: the core never asks.
"""

from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from treadwell.course.course import LEVEL_TOLERANCE, Course, Place
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Top
from treadwell.robot.load import Robot
from treadwell.scenario.events import Kidnap
from treadwell.scenario.model import Goal, Scenario
from treadwell.scenario.scaling import multiplied, to_robot
from treadwell.scenario.types import Scale
from treadwell.solving.climb_line import PROBE, ClimbLine, Node
from treadwell.solving.robot_limits import Limits, limits_of
from treadwell.solving.true_ground import Mask, TrueGround, edges_of
from treadwell.solving.true_solids import BARELY

SLABS: Final = "slabs"
"""Kind of the elements whose tops are tilted against each other."""
STONE: Final = "platform"
"""Kind of an element that can be a stone for one foot; steps of stairs are too narrow then."""
EVERY: Final = 0.08
"""Metres between two lines over the same edge."""


def is_solvable(scenario: Scenario, course: Course, robot: Robot) -> bool | None:
    """Say whether a way leads from the start over all points to pass to the goal.

    None where the search does not know: the robot is carried elsewhere on the way, or a way that
    it does not find may lead over stones with room for one foot, or over slabs.

    Args:
        scenario: as it is run.
        course: built from it.
        robot: whose limits hold.
    """
    if any(isinstance(event, Kidnap) for event in scenario.event):
        return None
    scenario = to_robot(scenario, robot)
    limits, start, goal = limits_of(scenario, robot), course.start, scenario.goal
    if robot.scale != 1.0:
        # The search's own lengths are those of a robot of scale 1.
        course, limits, start, goal = _shrunk(course, limits, goal, 1.0 / robot.scale)
    stops = [start.position, *goal.via, goal.position]
    ground = TrueGround(
        course, stops, radius=limits.radius, tall=limits.tall, steepest=limits.steepest
    )
    stand = ground.standing(limits.pair / 2, limits.floor_max)
    reached = _reached(ground, stand, limits, _start(ground, stand, start))
    heights = [None] * len(goal.via) + [goal.height]
    found = all(
        _holds(ground, reached, stop, goal.radius, height)
        for stop, height in zip(stops[1:], heights, strict=True)
    )
    return None if not found and _asks_for_single_feet(course, limits) else found


def _asks_for_single_feet(course: Course, limits: Limits) -> bool:
    """Say whether feet might go where the search, which keeps them side by side, does not look."""
    return any(
        element.kind == SLABS or (element.kind == STONE and _carries_one_foot(top, limits))
        for element, top in course.tops()
    )


def _carries_one_foot(top: Top, limits: Limits) -> bool:
    """Say whether a top has room for a sole, but in no direction for both feet side by side."""
    longest = max(float(np.linalg.norm(end - begin)) for begin, end, _ in edges_of(top))
    return limits.sole <= longest < 2 * limits.half_width


def _shrunk(
    course: Course, limits: Limits, goal: Goal, factor: float
) -> tuple[Course, Limits, Place, Goal]:
    """Return course, limits, start and goal with all lengths multiplied."""
    elements = tuple(element.multiplied(factor) for element in course.elements)
    start = course.start.multiplied(factor)
    smaller = replace(course, elements=elements, start=start, _by_name={})
    return smaller, limits.multiplied(factor), start, multiplied(goal, Scale(factor))


def _start(ground: TrueGround, stand: Mask, start: Place) -> set[Node]:
    """Return where the robot begins: where it stands, or what is free within a step of it."""
    x, y = start.position
    row, column = ground.index(x, y)
    reach = 3
    found: list[tuple[int, Node]] = []
    for r in range(row - reach, row + reach + 1):
        for c in range(column - reach, column + reach + 1):
            for surface in np.flatnonzero(stand[:, r, c]):
                if abs(ground.height[surface, r, c] - start.height) <= LEVEL_TOLERANCE:
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
                climb = ClimbLine(ground, stand, limits, feet[i], ahead).climb()
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
