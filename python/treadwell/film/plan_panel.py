"""The final map from above, with the way so far and where the robot is: a film's second picture."""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, RememberedMap

Floats = NDArray[np.float64]
_PAPER: Final = (222, 224, 228)
_OBSTACLE: Final = (28, 28, 34)
_LOW, _HIGH = np.array([86.0, 118.0, 150.0]), np.array([250.0, 224.0, 150.0])
"""Colours of the lowest and the highest floor."""
_TRUE, _BELIEVED, _GOAL = (255, 255, 255), (225, 45, 130), (70, 150, 30)
_MARGIN: Final = 0.15
"""Metres around what is shown."""
_LEAST_SPAN: Final = 0.04
"""Metres of height that the colours span at least."""


class PlanPanel:
    """Draws the panel of each frame over one picture of the map."""

    def __init__(
        self,
        size: tuple[int, int],
        surface: RememberedMap | None,
        truth: Floats,
        estimate: Floats,
        goal: tuple[float, float, float],
    ) -> None:
        """Draw what stays.

        Args:
            size: width and height, pixels.
            surface: the map in the end; None without one.
            truth: (n, 4) time s and true place, m.
            estimate: (m, 4) time s and believed place, m.
            goal: x, y and radius, m.
        """
        self._truth, self._estimate = truth, estimate
        low, high = _bounds(surface, truth, goal)
        width, height = size
        self._scale = min(width / (high[0] - low[0]), height / (high[1] - low[1]))
        spare = np.array(size) / self._scale - (high - low)
        self._corner = low - spare / 2
        self._height = height
        self._base = self._draw_map(size, surface)
        draw = ImageDraw.Draw(self._base)
        (x, y), reach = self._pixel(goal[:2]), goal[2] * self._scale
        draw.ellipse((x - reach, y - reach, x + reach, y + reach), outline=_GOAL, width=2)

    def at(self, time_s: float, heading: float) -> NDArray[np.uint8]:
        """Return the panel at a time, (height, width, 3); heading: the robot's true one, rad."""
        picture = self._base.copy()
        draw = ImageDraw.Draw(picture)
        for rows, colour, width in (
            (self._truth, _TRUE, 3),
            (self._estimate, _BELIEVED, 1),
        ):
            passed = rows[rows[:, 0] <= time_s + 1e-9, 1:3]
            if len(passed) > 1:
                draw.line([self._pixel(place) for place in passed], fill=colour, width=width)
        passed = self._truth[self._truth[:, 0] <= time_s + 1e-9]
        if len(passed):
            x, y = self._pixel(passed[-1, 1:3])
            turn = [heading, heading + 2.5, heading - 2.5]
            corners = [(x + 9 * math.cos(a), y - 9 * math.sin(a)) for a in turn]
            draw.polygon(corners, fill=_BELIEVED, outline=(255, 255, 255))
        return np.asarray(picture, np.uint8)

    def _pixel(self, place: Floats | tuple[float, float]) -> tuple[float, float]:
        x = (float(place[0]) - self._corner[0]) * self._scale
        y = self._height - (float(place[1]) - self._corner[1]) * self._scale
        return float(x), float(y)

    def _draw_map(self, size: tuple[int, int], surface: RememberedMap | None) -> Image.Image:
        base = np.full((size[1], size[0], 3), _PAPER, np.uint8)
        if surface is None or not surface.kind.size:
            return Image.fromarray(base)
        u, v = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
        x = self._corner[0] + u / self._scale
        y = self._corner[1] + (self._height - v) / self._scale
        col = np.floor((x - surface.origin[0]) / surface.cell).astype(np.intp)
        row = np.floor((y - surface.origin[1]) / surface.cell).astype(np.intp)
        rows, cols = surface.kind.shape
        inside = (row >= 0) & (row < rows) & (col >= 0) & (col < cols)
        base[inside] = _cell_colours(surface)[row[inside], col[inside]]
        return Image.fromarray(base)


def _cell_colours(surface: RememberedMap) -> NDArray[np.uint8]:
    """Return the cells' colours, (rows, cols, 3)."""
    colours = np.empty((*surface.kind.shape, 3), np.uint8)
    colours[:] = _PAPER
    colours[surface.kind == OBSTACLE] = _OBSTACLE
    floor = surface.kind == FLOOR
    heights = surface.height[floor].astype(np.float64)
    heights = np.nan_to_num(heights)
    if heights.size:
        low, high = np.percentile(heights, [1, 99])
        share = np.clip((heights - low) / max(high - low, _LEAST_SPAN), 0.0, 1.0)[:, None]
        colours[floor] = (_LOW + share * (_HIGH - _LOW)).astype(np.uint8)
    return colours


def _bounds(
    surface: RememberedMap | None, truth: Floats, goal: tuple[float, float, float]
) -> tuple[Floats, Floats]:
    """Return the lower left and the upper right corner of what is shown, m."""
    x, y, radius = goal
    points = [np.array([(x - radius, y - radius), (x + radius, y + radius)]), truth[:, 1:3]]
    if surface is not None:
        row, col = np.nonzero(surface.kind != UNKNOWN)
        points.append((np.column_stack([col, row]) + 0.5) * surface.cell + surface.origin)
    every = np.vstack([each for each in points if len(each)])
    return every.min(axis=0) - _MARGIN, every.max(axis=0) + _MARGIN
