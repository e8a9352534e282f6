"""The elements of a course as plain geometry: solid convex pieces, and the tops to walk on."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final, Literal, Self

import numpy as np
import numpy.typing as npt

from treadwell.course.outlines import (
    Floats,
    convex_outline,
    heading,
    left_of,
    near,
    rectangle,
    signed_distance,
)
from treadwell.random_streams import stream
from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.elements import (
    Box,
    Cylinder,
    Platform,
    Ramp,
    Rubble,
    Sill,
    Wall,
)
from treadwell.scenario.ground_elements import Patch

ROUND: Final = 24
"""Corners of the polygon that stands for a circle in clearances; it lies around the circle."""
PATCH: Final = (-0.02, 0.001)
"""Metres: from where to where a patch reaches. As thick as that a sole on it meets nothing else."""


@dataclass(frozen=True)
class Piece:
    """A solid convex piece in the world frame.

    A box has half extents `size` (x, y, z), a cylinder `size` = (radius, half height, 0) and a hull
    only its vertices. A hull's `center` and `size` are not used.
    """

    shape: Literal["box", "cylinder", "hull"]
    name: str
    vertices: Floats
    """(n, 3) corners in the world, metres."""
    center: Floats
    """(3,) world, metres."""
    size: Floats
    """(3,) metres."""
    quaternion: Floats
    """(4,) w, x, y, z: world from piece."""

    @property
    def outline(self) -> Floats:
        """The convex outline seen from above, (n, 2), counter-clockwise, metres."""
        return convex_outline(self.vertices[:, :2])

    @property
    def is_upright(self) -> bool:
        """Whether it is a box with a level top."""
        return self.shape == "box" and self.has_level_top

    @property
    def is_filled(self) -> bool:
        """Whether all over its outline it is solid from its lowest corner to `top_at`."""
        return self.is_upright

    def top_at(self, points: Floats) -> Floats:
        """Return up to where it reaches at points (n, 2) of its outline, m: its highest corner."""
        return np.full(len(points), self.vertices[:, 2].max())

    @property
    def has_level_top(self) -> bool:
        """Whether it is a box or a cylinder that stands upright."""
        level = bool(np.abs(self.quaternion[1:3]).max() < 1e-9)
        return self.shape in {"box", "cylinder"} and level

    def multiplied(self, factor: float) -> Self:
        """Return the piece with all its lengths multiplied, its distance from the origin, too."""
        lengths = (self.vertices, self.center, self.size)
        vertices, center, size = (factor * each for each in lengths)
        return replace(self, vertices=vertices, center=center, size=size)


@dataclass(frozen=True)
class Top:
    """A walkable surface: a plane convex polygon in the world frame, but for height fields."""

    part: str
    polygon: Floats
    """(n, 3) corners, counter-clockwise seen from above, metres."""

    def contains(self, points: Floats) -> npt.NDArray[np.bool_]:
        """Say for each point (n, 2) whether it lies above or under this surface."""
        outline, inside = self.polygon[:, :2], np.zeros(len(points), dtype=bool)
        close = near(outline, points, 1e-9)
        inside[close] = signed_distance(outline, points[close]) <= 1e-9
        return inside

    def height_at(self, points: Floats) -> Floats:
        """Return the height of the surface's plane at the points (n, 2), metres."""
        normal = self.normal
        offset = points - self.polygon[0, :2]
        height: Floats = self.polygon[0, 2] - offset @ normal[:2] / normal[2]
        return height

    @property
    def normal(self) -> Floats:
        """The unit normal, upwards, (3,)."""
        a, b, c = self.polygon[:3]
        normal = np.cross(b - a, c - a)
        unit: Floats = normal / np.linalg.norm(normal)
        return unit

    @property
    def height(self) -> float:
        """The mean height of its corners, metres: the height itself where it is level."""
        return float(self.polygon[:, 2].mean())

    def multiplied(self, factor: float) -> Self:
        """Return the surface with all its lengths multiplied, its distance from the origin, too."""
        return replace(self, polygon=factor * self.polygon)


def bounds(pieces: Iterable[Piece], places: Floats) -> tuple[Floats, Floats]:
    """Return the lowest and the highest corner of pieces and places, metres.

    Args:
        pieces: in the world frame.
        places: (n, 3) world, or (n, 2) for the corners as seen from above; n at least 1.
    """
    axes = places.shape[1]
    everything = np.vstack([places, *(piece.vertices[:, :axes] for piece in pieces)])
    return everything.min(axis=0), everything.max(axis=0)


def block(name: str, outline: Floats, yaw: float, bottom: float, top: float) -> Piece:
    """Return an upright box over a rectangle (4, 2) turned by `yaw`."""
    center = np.array([*outline.mean(axis=0), (bottom + top) / 2])
    length, width = (
        np.linalg.norm(outline[1] - outline[0]),
        np.linalg.norm(outline[2] - outline[1]),
    )
    size = np.array([length / 2, width / 2, (top - bottom) / 2])
    vertices = np.vstack([np.column_stack([outline, np.full(4, z)]) for z in (bottom, top)])
    return Piece("box", name, vertices, center, size, about_z(yaw))


def about_z(yaw: float) -> Floats:
    """Return the quaternion (w, x, y, z) of a turn about z."""
    return np.array([math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)])


def level(part: str, outline: Floats, height: float) -> Top:
    """Return a level top over an outline (n, 2)."""
    return Top(part, np.column_stack([outline, np.full(len(outline), height)]))


def simple_pieces(  # noqa: PLR0911 - one return for each kind
    element: ElementTable, name: str, seed: int
) -> tuple[list[Piece], list[Top]]:
    """Return what an element is made of: all kinds but stairs, meshes and those with many parts.

    Args:
        element: the element.
        name: its name: rubble draws its heights from it and the seed.
        seed: the episode's seed.
    """
    match element:
        case Box():
            length, width, height = element.size
            outline = rectangle(element.position, element.yaw, (-length / 2, length / 2), width)
            bottom = element.base
            return [block("box", outline, element.yaw, bottom, bottom + height)], []
        case Platform():
            length, width, height = element.size
            outline = rectangle(element.position, element.yaw, (-length / 2, length / 2), width)
            return [block("block", outline, element.yaw, 0.0, height)], [
                level("top", outline, height)
            ]
        case Sill():
            outline = rectangle(element.position, element.yaw, (0.0, element.depth), element.width)
            return [block("block", outline, element.yaw, 0.0, element.rise)], [
                level("top", outline, element.rise)
            ]
        case Cylinder():
            return [_cylinder(element)], []
        case Wall():
            begin, end = np.array(element.from_), np.array(element.to)
            yaw = math.atan2(*(end - begin)[::-1])
            outline = rectangle(
                begin, yaw, (0.0, float(np.linalg.norm(end - begin))), element.thickness
            )
            return [block("wall", outline, yaw, 0.0, element.height)], []
        case Ramp():
            return _ramp(element)
        case Patch():
            length, width = element.size
            outline = rectangle(element.position, element.yaw, (-length / 2, length / 2), width)
            return [block("plate", outline, element.yaw, *PATCH)], [level("top", outline, PATCH[1])]
        case Rubble():
            return _rubble(element, name, seed), []
    raise TypeError(f"no geometry for {type(element).__name__}")


def _cylinder(element: Cylinder) -> Piece:
    angles = np.arange(ROUND) * 2 * np.pi / ROUND
    radius = element.radius / math.cos(math.pi / ROUND)
    circle = np.array(element.position) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    vertices = np.vstack(
        [np.column_stack([circle, np.full(ROUND, z)]) for z in (0.0, element.height)]
    )
    center = np.array([*element.position, element.height / 2])
    size = np.array([element.radius, element.height / 2, 0.0])
    return Piece("cylinder", "cylinder", vertices, center, size, about_z(0.0))


def _ramp(element: Ramp) -> tuple[list[Piece], list[Top]]:
    """Return a slab, which a sole stands on well, and below its top the wedge that fills it."""
    outline = rectangle(element.position, element.yaw, (0.0, element.length), element.width)
    top = Top("slope", np.column_stack([outline, [0.0, element.rise, element.rise, 0.0]]))
    thickness = min(0.01, element.rise / 2)
    pitch = -math.atan2(element.rise, element.length)
    half = np.array(
        [math.hypot(element.rise, element.length) / 2, element.width / 2, thickness / 2]
    )
    center = top.polygon.mean(axis=0) - top.normal * thickness / 2
    # World from slab: first the pitch about y, then the yaw about z.
    cz, sz = math.cos(element.yaw / 2), math.sin(element.yaw / 2)
    cy, sy = math.cos(pitch / 2), math.sin(pitch / 2)
    quaternion = np.array([cz * cy, -sz * sy, cz * sy, sz * cy])
    corners = np.vstack([top.polygon, top.polygon - top.normal * thickness])
    slab = Piece("box", "slab", corners, center, half, quaternion)
    under = top.polygon.copy()
    under[1:3, 2] -= thickness / 2
    under[[0, 3], :2] += (outline[[1, 2]] - outline[[0, 3]]) * thickness / 2 / element.rise
    feet = np.column_stack([under[1:3, :2], [0.0, 0.0]])
    wedge = Piece("hull", "wedge", np.vstack([under, feet]), center, half, quaternion)
    return [slab, wedge], [top]


def _rubble(element: Rubble, name: str, seed: int) -> list[Piece]:
    """Return blocks of random heights side by side, one of them as high as the amplitude."""
    columns, rows = (min(12, max(2, round(extent / 0.03))) for extent in element.size)
    generator = stream(seed, f"course.{name}")
    heights = element.amplitude * generator.uniform(0.15, 1.0, (columns, rows))
    heights.flat[int(generator.integers(heights.size))] = element.amplitude
    length, width = element.size[0] / columns, element.size[1] / rows
    corner = (
        np.array(element.position)
        - (heading(element.yaw) * element.size[0] + left_of(element.yaw) * element.size[1]) / 2
    )
    pieces = []
    for column in range(columns):
        for row in range(rows):
            middle = corner + left_of(element.yaw) * (row + 0.5) * width
            outline = rectangle(
                middle, element.yaw, (column * length, (column + 1) * length), width
            )
            pieces.append(
                block(
                    f"stone {column} {row}", outline, element.yaw, 0.0, float(heights[column, row])
                )
            )
    return pieces
