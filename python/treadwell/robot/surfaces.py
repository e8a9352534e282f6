"""Points of a model's shapes: enough of them to find what lies lowest and what touches a plane."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SEEN_GROUPS = 3
"""Geoms of the groups below this are what a camera sees."""
RIM_POINTS = 48
"""Points of a round rim."""
_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)
_RIM = np.array(
    [[np.cos(a), np.sin(a)] for a in np.linspace(0.0, 2.0 * np.pi, RIM_POINTS, endpoint=False)]
)


@dataclass(frozen=True, slots=True)
class Cloud:
    """Balls whose hull is the hull of some shapes.

    Attributes:
        centres: (n, 3) m.
        radii: (n,) m; 0 for a corner.
    """

    centres: Floats
    radii: Floats

    def lowest(self, up: Floats) -> Floats:
        """Return (n, 3) m: of each ball the point that is lowest along `up`."""
        points: Floats = self.centres - self.radii[:, None] * up
        return points

    @staticmethod
    def joined(clouds: Sequence["Cloud"]) -> "Cloud":
        """Return several clouds as one."""
        if not clouds:
            return Cloud(np.zeros((0, 3)), np.zeros(0))
        return Cloud(
            np.concatenate([cloud.centres for cloud in clouds]),
            np.concatenate([cloud.radii for cloud in clouds]),
        )


def cloud_of(model: mujoco.MjModel, data: mujoco.MjData, geoms: Iterable[int]) -> Cloud:
    """Return what stands for some geoms, in the world's frame.

    Args:
        model: the compiled model.
        data: with its kinematics up to date.
        geoms: their numbers; planes and height fields count as nothing.
    """
    clouds = []
    for geom in geoms:
        points, radius = _own_points(model, geom)
        rotation = data.geom_xmat[geom].reshape(3, 3)
        centres = data.geom_xpos[geom] + points @ rotation.T
        clouds.append(Cloud(centres, np.full(len(centres), radius)))
    return Cloud.joined(clouds)


def solid_geoms(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Return (ngeom,) which geoms of the robot touch others; all of them where none does."""
    paired = np.zeros(model.ngeom, bool)
    for pair in range(model.npair):
        paired[[int(model.pair_geom1[pair]), int(model.pair_geom2[pair])]] = True
    own = model.geom_bodyid > 0
    solid: NDArray[np.bool_] = own & (
        (model.geom_contype != 0) | (model.geom_conaffinity != 0) | paired
    )
    return solid if solid.any() else own


def _own_points(model: mujoco.MjModel, geom: int) -> tuple[Floats, float]:
    """Return the centres of a geom's balls in its frame, and their radius."""
    kind, size = mujoco.mjtGeom(int(model.geom_type[geom])), model.geom_size[geom]
    points, radius = np.zeros((0, 3)), 0.0
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        points, radius = np.zeros((1, 3)), float(size[0])
    elif kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        points = np.array([[0.0, 0.0, -size[1]], [0.0, 0.0, size[1]]])
        radius = float(size[0])
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        points = _CORNERS * size
    elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        rims = [np.column_stack([size[0] * _RIM, np.full(RIM_POINTS, z)]) for z in (-1.0, 1.0)]
        points = np.concatenate(rims) * (1.0, 1.0, size[1])
    elif kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, RIM_POINTS // 2 + 1)
        rings = [
            np.column_stack([np.cos(angle) * _RIM, np.full(RIM_POINTS, np.sin(angle))])
            for angle in angles
        ]
        points = np.concatenate(rings) * size
    elif kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        points = np.asarray(model.mesh_vert[first : first + count], np.float64)
    return points, radius


def outline_area(points: Floats) -> float:
    """Return the area of the convex outline of points of a plane, m².

    Args:
        points: (n, 2) m.
    """
    order = points[np.lexsort((points[:, 1], points[:, 0]))]
    if len(order) < 3:
        return 0.0
    halves = []
    for ordered in (order, order[::-1]):
        chain: list[Floats] = []
        for point in ordered:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0.0:
                chain.pop()
            chain.append(point)
        halves += chain[:-1]
    outline = np.array(halves)
    x, y = outline[:, 0], outline[:, 1]
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
