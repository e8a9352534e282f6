"""A camera that needs no graphics card: one ray a pixel, colour, light and one shadow."""

from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.senses.projection import VISIBLE_GROUPS

Floats = NDArray[np.float64]
_FAR: Final = 30.0
"""Metres."""
_SKY: Final = np.array([(0.93, 0.95, 0.97), (0.66, 0.75, 0.85)])
"""Colour at the horizon and overhead."""
_CHEQUER: Final = np.array([(0.80, 0.82, 0.81), (0.72, 0.75, 0.755)])
_SQUARE: Final = 0.25
"""Metres: side of the ground's squares."""
_GOAL: Final = np.array([0.55, 0.85, 0.25])
_DEFAULT: Final = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's colour of a geom that has none of its own: then its material's counts."""
_LAMP: Final = np.array([-0.7, -0.5, 3.2])
"""Metres from what is looked at to the lamp."""
_AMBIENT, _SHADE = 0.52, 0.17
"""Light that comes from everywhere, and the share of the lamp's that reaches into a shadow."""
_SUBPIXELS: Final = ((-0.33, -0.25), (0.33, 0.25))
"""Where further rays of a pixel at an edge go, pixels."""


@dataclass(frozen=True, slots=True)
class Disc:
    """A mark on the floor: the goal. Metres."""

    x: float
    y: float
    radius: float


@dataclass(frozen=True, slots=True, eq=False)
class Eye:
    """Where a camera stands and what it looks at, (3,) m each."""

    position: Floats
    target: Floats

    def rotation(self) -> Floats:
        """Return (3, 3) world from the optical frame."""
        ahead = self.target - self.position
        ahead = ahead / np.linalg.norm(ahead)
        right = np.cross(ahead, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(ahead, right), ahead], axis=1)


class RayCamera:
    """Draws pictures of a model's states."""

    def __init__(
        self, model: mujoco.MjModel, size: tuple[int, int], goal: Disc | None = None
    ) -> None:
        """Prepare rays and colours.

        Args:
            model: the compiled world.
            size: width and height, pixels.
            goal: a disc that is marked on what lies flat; None for none.
        """
        self._model, self._goal = model, goal
        self.width, self.height = size
        self._focal = 1.1 * self.width
        self._colours = _colours(model)
        self._ground = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE

    def picture(self, data: mujoco.MjData, eye: Eye) -> NDArray[np.uint8]:
        """Return the picture, (height, width, 3).

        Args:
            data: with the poses up to date.
            eye: where the camera is.
        """
        column, row = np.meshgrid(np.arange(self.width), np.arange(self.height))
        colour, geom = self._shot(data, eye, column.ravel(), row.ravel())
        picture = colour.reshape(self.height, self.width, 3)
        edge = _edges(geom.reshape(self.height, self.width))
        down, across = np.nonzero(edge)
        if down.size:
            parts = [self._shot(data, eye, across + dx, down + dy)[0] for dx, dy in _SUBPIXELS]
            picture[edge] = np.mean([picture[edge], *parts], axis=0)
        return np.asarray(np.clip(255.0 * picture + 0.5, 0.0, 255.0), np.uint8)

    def _shot(
        self, data: mujoco.MjData, eye: Eye, column: NDArray[np.generic], row: NDArray[np.generic]
    ) -> tuple[Floats, NDArray[np.int32]]:
        """Return colour (n, 3) and geom (n,) of what is seen at places in the picture."""
        x = (np.asarray(column, np.float64) - (self.width - 1) / 2) / self._focal
        y = (np.asarray(row, np.float64) - (self.height - 1) / 2) / self._focal
        directions = np.column_stack([x, y, np.ones_like(x)]) @ eye.rotation().T
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        geom, distance, normal = self._rays(data, eye.position, directions)
        points = eye.position + distance[:, None] * directions
        colour = self._surface(points, normal, geom)
        lamp = eye.target + _LAMP
        colour *= self._light(data, points, normal, geom, lamp)[:, None]
        # What is far fades into the sky, so that the ground has no hard end.
        up = np.clip(2.0 * directions[:, 2:], 0.0, 1.0)
        sky = _SKY[0] + up * (_SKY[1] - _SKY[0])
        haze = np.where(geom < 0, 1.0, np.clip((distance - 5.0) / 12.0, 0.0, 1.0))[:, None]
        return colour * (1.0 - haze) + sky * haze, geom

    def _rays(
        self, data: mujoco.MjData, origin: Floats, directions: Floats
    ) -> tuple[NDArray[np.int32], Floats, Floats]:
        """Return geom (n,), -1 for none, distance (n,) and normal (n, 3) of what rays meet."""
        count = len(directions)
        geom, distance = np.empty(count, np.int32), np.empty(count)
        normal = np.zeros((count, 3))
        mujoco.mj_multiRay(
            self._model, data, origin, np.ascontiguousarray(directions).reshape(-1),
            VISIBLE_GROUPS, True, -1, geom, distance, normal.reshape(-1), count, _FAR,
        )  # fmt: skip
        distance[geom < 0] = _FAR
        return geom, distance, normal

    def _surface(self, points: Floats, normal: Floats, geom: NDArray[np.int32]) -> Floats:
        colour = self._colours[geom]  # -1 takes the last, which is nobody's
        ground = np.append(self._ground, values=False)[geom]
        squares = np.floor(points[ground, :2] / _SQUARE).astype(np.intp).sum(axis=1) % 2
        colour[ground] = _CHEQUER[squares]
        if self._goal is not None:
            away = np.hypot(points[:, 0] - self._goal.x, points[:, 1] - self._goal.y)
            marked = (away < self._goal.radius) & (normal[:, 2] > 0.9) & (geom >= 0)
            marked &= self._fixed()[geom]
            share = np.where(away[marked] > 0.88 * self._goal.radius, 0.9, 0.45)[:, None]
            colour[marked] = (1.0 - share) * colour[marked] + share * _GOAL
        return colour

    def _fixed(self) -> NDArray[np.bool_]:
        """Return which geoms (ngeom + 1,) belong to the world, not to what moves."""
        return np.append(self._model.body_dofnum[self._roots()] == 0, values=False)

    def _roots(self) -> NDArray[np.int32]:
        roots: NDArray[np.int32] = self._model.body_rootid[self._model.geom_bodyid]
        return roots

    def _light(
        self,
        data: mujoco.MjData,
        points: Floats,
        normal: Floats,
        geom: NDArray[np.int32],
        lamp: Floats,
    ) -> Floats:
        """Return how bright each point (n,) is."""
        towards = lamp - points
        distance = np.linalg.norm(towards, axis=1)
        facing = np.clip((normal * towards).sum(axis=1) / distance, 0.0, 1.0)
        # All rays of one call begin at one place: from the lamp to the points, not the other way.
        bare = np.flatnonzero((facing > 0.0) & (geom >= 0))
        met, reach, _ = self._rays(data, lamp, -towards[bare] / distance[bare, None])
        shadow = bare[(met >= 0) & (reach < distance[bare] - 2e-3)]
        lit = facing
        lit[shadow] *= _SHADE
        bright: Floats = np.where(geom < 0, 1.0, _AMBIENT + (1.08 - _AMBIENT) * lit)
        return bright


def _colours(model: mujoco.MjModel) -> Floats:
    """Return the geoms' colours (ngeom + 1, 3); the last one is for nothing."""
    colours = np.array(model.geom_rgba, np.float64)
    plain = np.isclose(colours, _DEFAULT).all(axis=1) & (model.geom_matid >= 0)
    colours[plain] = model.mat_rgba[model.geom_matid[plain]]
    return np.vstack([colours[:, :3], np.zeros(3)])


def _edges(geom: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Return which pixels have another geom beside them."""
    edge = np.zeros(geom.shape, np.bool_)
    across, down = geom[:, 1:] != geom[:, :-1], geom[1:] != geom[:-1]
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge
