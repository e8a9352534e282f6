"""Random obstacles that leave a way: drawn from the seed until a path from start to goal exists."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from treadwell.course.outlines import Floats, convex_outline, near, signed_distance
from treadwell.course.pieces import Piece, simple_pieces
from treadwell.errors import InputError
from treadwell.random_streams import stream
from treadwell.scenario.drawn_elements import Scatter
from treadwell.scenario.elements import Box, Cylinder

LOWEST = 0.08
"""Metres: a scattered obstacle is at least so high."""
LAYOUTS = 50
DRAWS = 50
"""Places tried for one obstacle before its layout is given up."""
MOST_DRAWS = 4000
"""Places tried in all: a hopeless element is refused within a second or two."""
CELL = 0.03


def scattered(
    scatter: Scatter,
    name: str,
    *,
    seed: int,
    stops: Sequence[Floats],
    solid: Sequence[Piece],
    tops: Sequence[Floats],
    passage: float,
) -> list[Box | Cylinder]:
    """Return the obstacles of a scatter element, named `<name>.<number>`.

    Args:
        scatter: the element.
        name: its name.
        seed: the episode's seed.
        stops: start, points to pass and goal in this order, world x, y.
        solid: the obstacles that are already there.
        tops: outlines (n, 2) of walkable tops, which stay free.
        passage: width of the path that must remain, metres.

    Raises:
        InputError: no layout leaves a path.
    """
    generator = stream(seed, f"course.{name}")
    ground = Ground(stops, [piece.outline for piece in solid], scatter.area, passage)
    taken = [piece.outline for piece in solid] + list(tops)
    budget = [MOST_DRAWS]
    for _ in range(LAYOUTS):
        layout = _layout(scatter, name, generator, stops, taken, passage, budget)
        if layout is None:
            continue
        outlines = [simple_pieces(item, name, seed)[0][0].outline for item in layout]
        if ground.is_connected(outlines):
            return layout
    raise InputError(
        f"course.{name}: no layout of {scatter.count} obstacles leaves a path {passage:.2f} m wide "
        "from start to goal; allowed: fewer or smaller obstacles, or a larger area"
    )


def _layout(
    scatter: Scatter,
    name: str,
    generator: np.random.Generator,
    stops: Sequence[Floats],
    taken: Sequence[Floats],
    passage: float,
    budget: list[int],
) -> list[Box | Cylinder] | None:
    """Return one layout that overlaps nothing; None when there is no place for it."""
    lower, upper = scatter.area
    layout: list[Box | Cylinder] = []
    outlines = list(taken)
    for number in range(1, scatter.count + 1):
        for _ in range(min(DRAWS, budget[0])):
            budget[0] -= 1
            item = _draw(f"{name}.{number}", scatter, generator, lower, upper)
            outline = simple_pieces(item, name, 0)[0][0].outline
            far = min(float(signed_distance(outline, stop[None])[0]) for stop in stops)
            if far > passage / 2 and not any(overlap(outline, other) for other in outlines):
                break
        else:
            return None
        layout.append(item)
        outlines.append(outline)
    return layout


def _draw(
    name: str,
    scatter: Scatter,
    generator: np.random.Generator,
    lower: Sequence[float],
    upper: Sequence[float],
) -> Box | Cylinder:
    x, y = (float(v) for v in generator.uniform(lower, upper))
    length, width, height = (float(v) for v in generator.uniform(*scatter.size, 3))
    yaw = float(generator.uniform(-math.pi, math.pi))
    round_one = bool(generator.integers(2))
    height = max(height, LOWEST)
    # The name has a dot, which no name in a file can have: so it is never taken. Every number is
    # within the element's own checked limits, so that nothing is left to check.
    if round_one:
        return Cylinder.model_construct(
            kind="cylinder",
            name=name,
            position=(x, y),
            radius=length / 2,
            height=height,
            texture=scatter.texture,
            mapped=scatter.mapped,
        )
    return Box.model_construct(
        kind="box",
        name=name,
        position=(x, y),
        yaw=yaw,
        size=(length, width, height),
        base=0.0,
        texture=scatter.texture,
        mapped=scatter.mapped,
    )


def overlap(first: Floats, second: Floats) -> bool:
    """Say whether two convex outlines (n, 2) overlap (separating axes)."""
    if (first.max(axis=0) < second.min(axis=0)).any() or (
        second.max(axis=0) < first.min(axis=0)
    ).any():
        return False  # the most, and quickly found
    edges = np.concatenate([np.roll(each, -1, axis=0) - each for each in (first, second)])
    x, y = edges[:, 1], -edges[:, 0]
    a, b = (np.outer(each[:, 0], x) + np.outer(each[:, 1], y) for each in (first, second))
    apart = (a.max(axis=0) < b.min(axis=0)) | (b.max(axis=0) < a.min(axis=0))
    return not bool(apart.any())


class Ground:
    """A grid seen from above that says whether a way through all stops remains."""

    def __init__(
        self,
        stops: Sequence[Floats],
        outlines: Sequence[Floats],
        area: Sequence[Sequence[float]],
        passage: float,
    ) -> None:
        """Lay the grid around everything that matters, a metre and a half to spare.

        Args:
            stops: the points to connect, world x, y.
            outlines: (n, 2) each: what stands there already.
            area: two opposite corners of where more will stand.
            passage: width of the path, metres.
        """
        corners = np.vstack([*stops, *np.array(area), *outlines])
        lower, upper = corners.min(axis=0) - 1.5, corners.max(axis=0) + 1.5
        self._cell = max(CELL, float((upper - lower).max()) / 600)
        x = np.arange(lower[0], upper[0], self._cell)
        y = np.arange(lower[1], upper[1], self._cell)
        grid_x, grid_y = np.meshgrid(x, y)
        self._shape = grid_x.shape
        self._points = np.column_stack([grid_x.ravel(), grid_y.ravel()])
        self._stops = [tuple(int(v) for v in ((stop - lower) / self._cell)[::-1]) for stop in stops]
        self._reach = passage / 2
        self._free = np.ones(self._shape, dtype=np.bool_)
        self._block(self._free, outlines)

    def is_connected(self, outlines: Sequence[Floats]) -> bool:
        """Say whether every stop can be reached from the first, with these outlines in the way."""
        free = self._free.copy()
        self._block(free, outlines)
        if not all(free[stop] for stop in self._stops):
            return False
        reached = np.zeros_like(free)
        front = [self._stops[0]]
        reached[front[0]] = True
        rows, columns = free.shape
        while front:
            row, column = front.pop()
            for r, c in (
                (row + 1, column),
                (row - 1, column),
                (row, column + 1),
                (row, column - 1),
            ):
                if 0 <= r < rows and 0 <= c < columns and free[r, c] and not reached[r, c]:
                    reached[r, c] = True
                    front.append((r, c))
        return all(bool(reached[stop]) for stop in self._stops)

    def _block(self, free: npt.NDArray[np.bool_], outlines: Sequence[Floats]) -> None:
        for outline in outlines:
            polygon = convex_outline(outline)
            close = near(polygon, self._points, self._reach)
            taken = signed_distance(polygon, self._points[close]) < self._reach
            free.ravel()[close[taken]] = False
