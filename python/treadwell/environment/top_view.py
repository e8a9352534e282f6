"""A picture of the course from above, drawn with numpy alone: no display, no graphics card."""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.course.outlines import Floats, convex_outline, rectangle, signed_distance
from treadwell.course.pieces import bounds
from treadwell.episode import Episode

LONG_SIDE: Final = 320
"""Pixels of the picture's longer side."""
MARGIN_M: Final = 0.4
LOW_M: Final = 0.3
"""Height from which on a walkable top has the lightest grey."""
GROUND, OBSTACLE, GOAL = (225, 226, 230), (40, 42, 48), (120, 190, 60)
ROBOT, NOSE, BELIEVED = (228, 87, 46), (255, 255, 255), (255, 95, 162)

Picture = NDArray[np.uint8]


class TopView:
    """Draws an episode, always the same part of the world."""

    def __init__(self, episode: Episode) -> None:
        """Choose what is in the picture: the course, the start and the goal."""
        self._episode = episode
        goal = episode.scenario.goal
        course = episode.course
        places = np.array([course.start.position, goal.position, *goal.via])
        pieces = [piece for one in course.elements if one.present for piece in one.pieces]
        low, high = bounds(pieces, places)
        low, high = low - MARGIN_M, high + MARGIN_M
        self._cell = float((high - low).max()) / LONG_SIDE
        cols, rows = (max(1, math.ceil(size / self._cell)) for size in high - low)
        xs = low[0] + (np.arange(cols) + 0.5) * self._cell
        ys = low[1] + (np.arange(rows)[::-1] + 0.5) * self._cell
        grid = np.meshgrid(xs, ys)
        self._points: Floats = np.stack(grid, axis=-1)

    def draw(self) -> Picture:
        """Return (h, w, 3) uint8: the truth, and where the robot believes to be."""
        episode = self._episode
        picture: Picture = np.empty((*self._points.shape[:2], 3), dtype=np.uint8)
        picture[:] = GROUND
        self._draw_course(picture)
        radius = episode.scenario.goal.radius
        self._disc(picture, episode.goal, radius, GOAL)
        body, frame = episode.robot.file.body, episode.judge.frame
        here = np.array([frame.x, frame.y])
        half = 0.5 * (body.depth or 2.0 * body.radius)
        width = body.width or 2.0 * body.radius
        self._fill(picture, rectangle(here, frame.yaw, (-half, half), width), ROBOT)
        self._fill(picture, rectangle(here, frame.yaw, (0.3 * half, half), 0.3 * width), NOSE)
        return picture

    def mark(self, picture: Picture, place: tuple[float, float]) -> None:
        """Draw where the robot believes to be, (x, y) m."""
        self._disc(picture, place, 3.0 * self._cell, BELIEVED)

    def _draw_course(self, picture: Picture) -> None:
        episode = self._episode
        data = episode.simulation.data
        for element in episode.course.elements:
            if element.name not in episode.events.present:
                continue
            shift = episode.events.place(element, data)[:2]
            if element.walkable:
                for top in sorted(element.tops, key=lambda top: float(top.polygon[:, 2].max())):
                    share = min(1.0, float(top.polygon[:, 2].max()) / LOW_M)
                    shade = tuple(round(200 - 90 * share - 8 * i) for i in range(3))
                    outline = convex_outline(top.polygon[:, :2] + shift)
                    self._fill(picture, outline, shade)
            else:
                for piece in episode.events.stands(element).pieces:
                    self._fill(picture, piece.outline + shift, OBSTACLE)

    def _disc(
        self, picture: Picture, place: tuple[float, float], radius: float, colour: tuple[int, ...]
    ) -> None:
        away = np.hypot(self._points[..., 0] - place[0], self._points[..., 1] - place[1])
        picture[away <= radius] = colour

    def _fill(self, picture: Picture, outline: Floats, colour: tuple[int, ...]) -> None:
        """Paint a convex polygon, its pixels' middles inside it."""
        low, high = outline.min(axis=0), outline.max(axis=0)
        near = ((self._points >= low) & (self._points <= high)).all(axis=-1)
        if near.any() and len(outline) > 2:
            inside = signed_distance(outline, self._points[near]) <= 0.0
            rows, cols = np.nonzero(near)
            picture[rows[inside], cols[inside]] = colour
