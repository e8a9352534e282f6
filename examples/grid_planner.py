"""A planner of one's own: A* over the cells in which the robot has room, kept while it holds.

PYTHONPATH=. treadwell run slalom --set navigation.planner=grid_planner:GridPlanner
"""

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from treadwell.protocols import FloorView, Goal, Plan, Pose, Setup, Staircase

Numbers = NDArray[np.float64]
Cells = tuple[NDArray[np.int64], NDArray[np.int64]]
SIDES = [(dr, dc) for dr in (-1, 0, 1) for dc in (-1, 0, 1) if dr or dc]


class GridPlanner:
    """Finds the shortest way that keeps away from what blocks.

    Args:
        rise: changes of height that are walked over, m.
        spare: room that is wanted beside the robot, m; nearer costs more.
        unseen: what a metre costs more beside what was not seen: an obstacle hides its own back.
        worse: a way is kept until it costs so many times what it did.
    """

    def __init__(
        self, rise: float = 0.015, spare: float = 0.15, unseen: float = 1.0, worse: float = 1.1
    ) -> None:
        self.rise, self.spare, self.unseen, self.worse, self.radius = (
            rise,
            spare,
            unseen,
            worse,
            0.12,
        )
        self.path: Numbers | None = None
        self.paid, self.length = np.empty(0), 0

    def begin(self, setup: Setup) -> None:
        """Called once, before the first tick."""
        self.radius, self.path = setup.robot["body"]["radius"], None

    def forget(self) -> None:
        """Called when the robot found itself elsewhere: the map begins anew."""
        self.path = None

    def plan(self, view: FloorView, _stairs: Staircase, start: Pose, goal: Goal) -> Plan:
        """Return the way before while it holds, else a new one."""
        here = self._cells(view, np.array([start[:2]]))
        price = self._price(view, start[2], here)
        if self.path is not None and self._holds(view, price, start, goal):
            return Plan(self.path, replanned=False)
        self.path = self._search(view, price, here, goal)
        if self.path is None:
            return Plan(None, "blocked: no way through what was seen")
        self.length, self.paid = len(self.path), price[self._cells(view, self.path)]
        return Plan(self.path)

    def _price(self, view: FloorView, z: float, here: Cells) -> Numbers:
        """Return what a metre costs in each cell, endless where there is no room."""
        free = view.passable(z, self.rise, self.radius)
        wide = (z, self.rise, self.radius + self.spare)
        room = np.minimum(view.clearance(), self.radius + self.spare)
        price = 1.0 + 4.0 * (self.radius + self.spare - room) / self.spare
        price += self.unseen * (view.passable(*wide) & ~view.passable(*wide, unknown=False))
        # Where the robot stands there is room, whatever the map says.
        rows, cols = np.indices(free.shape)
        free |= np.hypot(rows - here[0][0], cols - here[1][0]) * view.cell < self.radius
        return np.where(free, price, np.inf)

    def _holds(self, view: FloorView, price: Numbers, start: Pose, goal: Goal) -> bool:
        """Drop what is passed of the way, and say whether it is as good as it was."""
        assert self.path is not None
        passed = np.argmin(np.hypot(*(self.path - start[:2]).T))
        self.path, self.paid = self.path[passed:], self.paid[passed:]
        row, col = self._cells(view, self.path)
        inside = (row >= 0) & (col >= 0) & (row < price.shape[0]) & (col < price.shape[1])
        dear = price[row[inside], col[inside]].sum() > self.worse * self.paid[inside].sum()
        # A way that ends at the border of what was seen is planned on from half of it.
        short = math.dist(self.path[-1], goal.position) > goal.radius
        return not dear and not (short and 2 * len(self.path) < self.length)

    def _cells(self, view: FloorView, points: Numbers) -> Cells:
        col, row = np.floor((points - view.origin) / view.cell).astype(int).T
        return row, col

    def _search(self, view: FloorView, price: Numbers, here: Cells, goal: Goal) -> Numbers | None:
        """Return points (n, 2) of the cheapest way to the goal, or to the border before it."""
        first = (int(here[0][0]), int(here[1][0]))
        last = (np.array(goal.position) - view.origin)[::-1] / view.cell - 0.5
        edge = np.array(price.shape) - 1
        outside = (last < 0).any() or (last > edge).any()
        cost, parent, queue, done = {first: 0.0}, {}, [(0.0, first)], set()
        while queue:
            _, cell = heapq.heappop(queue)
            if cell in done:
                continue
            done.add(cell)
            at_border = outside and (0 in cell or (edge == cell).any())
            if at_border or math.dist(cell, last) * view.cell < 0.5 * goal.radius:
                way = [cell]
                while way[-1] in parent:
                    way.append(parent[way[-1]])
                return (np.array(way[::-1])[:, ::-1] + 0.5) * view.cell + view.origin
            for dr, dc in SIDES:
                to = (cell[0] + dr, cell[1] + dc)
                if not (0 <= to[0] < price.shape[0] and 0 <= to[1] < price.shape[1]):
                    continue
                new = cost[cell] + math.hypot(dr, dc) * price[to]
                if new < cost.get(to, math.inf):
                    cost[to], parent[to] = new, cell
                    heapq.heappush(queue, (new + math.dist(to, last), to))
        return None
