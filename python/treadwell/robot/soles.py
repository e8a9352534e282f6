"""What of a foot touches level ground: the plane that it rests on, and a rectangle in it."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.robot.surfaces import SEEN_GROUPS, Cloud, cloud_of, outline_area, solid_geoms

Floats = NDArray[np.float64]

SOLE_DEPTH_M = 0.003
"""What of a foot is this near to the ground belongs to the sole."""
LOW_SHARE = 0.25
"""The lowest part of a foot's height, under which its load is taken to be."""
MOST_TILT = 0.5
"""By how much a sole may be tilted against its level place, as a slope."""
STEEPEST_RAD = 1.1
"""By how much the side of a box may be tilted that may be a sole."""
LARGER = 1.25
"""A tilted plane is taken where it touches so many times as much as the level one."""
LEVEL_RAD = 1e-3
"""A link whose axes are this near to the sole's is not turned."""
FULL = 0.8
"""Share of its rectangle that a sole fills, else the rectangle is made narrower."""
LEAST_M = 0.01
"""A sole that is shorter or narrower is a point or a line."""
UPRIGHT = 0.99
"""A cylinder whose axis has so much of up stands on its face."""
_ROUND = (
    int(mujoco.mjtGeom.mjGEOM_SPHERE),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE),
    int(mujoco.mjtGeom.mjGEOM_CYLINDER),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID),
)
"""Shapes that touch a plane in points and lines."""


@dataclass(frozen=True, slots=True)
class Sole:
    """The rectangle that a foot stands on.

    Attributes:
        position: its centre, m: in the link's frame, turned by `orientation` where there is one.
        length: extent forward, m.
        width: extent across, m.
        orientation: (w, x, y, z) from its frame to the link's; None where the link's serves.
        filled: share of the rectangle around it that it fills.
        plate: how thick a plate is that its shapes stand for, m, where those touch the ground in
            points and lines alone all around the rectangle; 0 where a face of them does.
    """

    position: tuple[float, float, float]
    length: float
    width: float
    orientation: tuple[float, float, float, float] | None = None
    filled: float = 1.0
    plate: float = 0.0

    @property
    def in_link(self) -> Floats:
        """Its centre in the link's own frame, (3,) m."""
        place = np.array(self.position)
        if self.orientation is None:
            return place
        turned = np.empty(3)
        mujoco.mju_rotVecQuat(turned, place, np.array(self.orientation))
        return turned

    @property
    def bears(self) -> bool:
        """Whether it is more than a point or a line."""
        return min(self.length, self.width) >= LEAST_M


def find_sole(model: mujoco.MjModel, data: mujoco.MjData, link: int, forward: Floats) -> Sole:
    """Find the sole of a link, and of what is fixed to it.

    Args:
        model: the compiled model.
        data: a posture in which the foot is about level, its kinematics up to date.
        link: number of the foot's body.
        forward: (3,) where the robot looks to, level.
    """
    fixed = model.body_weldid == model.body_weldid[link]
    geoms = np.flatnonzero(fixed[model.geom_bodyid])
    standing = _standing_geoms(model, geoms)
    cloud = cloud_of(model, data, standing)
    if not len(cloud.centres):
        return Sole((0.0, 0.0, 0.0), 0.0, 0.0)
    rotation = data.xmat[link].reshape(3, 3)
    axes = _level_axes(cloud, _faces(model, data, geoms), forward)
    if _angle(rotation, axes) < LEVEL_RAD:
        axes = rotation
    least, most, fill = _extent(cloud, axes)
    middle, size = 0.5 * (least + most), most - least
    place = axes.T @ (axes @ np.array([*middle[:2], least[2]]) - data.xpos[link])
    orientation = None
    if axes is not rotation:
        quat = np.empty(4)
        mujoco.mju_mat2Quat(quat, (rotation.T @ axes).reshape(-1))
        w, x, y, z = (float(value) for value in quat)
        orientation = (w, x, y, z)
    full = fill >= FULL
    plate = _plate(model, data, standing, axes[:, 2]) if full else 0.0
    width = float(size[1]) * (1.0 if full else fill)
    position = (float(place[0]), float(place[1]), float(place[2]))
    return Sole(position, float(size[0]), width, orientation, fill, plate)


def _plate(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: NDArray[np.intp], up: Floats
) -> float:
    """Return how high the shapes are on which a foot stands, m; 0 where one has a face below."""
    clouds = [cloud_of(model, data, [geom]) for geom in geoms]
    lowest = [float((cloud.lowest(up) @ up).min(initial=np.inf)) for cloud in clouds]
    ground, highest = min(lowest), 0.0
    for geom, cloud, low in zip(geoms, clouds, lowest, strict=True):
        if low > ground + SOLE_DEPTH_M:
            continue
        upright = abs(float(data.geom_xmat[geom].reshape(3, 3)[:, 2] @ up)) > UPRIGHT
        kind = int(model.geom_type[geom])
        if kind not in _ROUND or (kind == mujoco.mjtGeom.mjGEOM_CYLINDER and upright):
            return 0.0
        highest = max(highest, float((cloud.centres @ up + cloud.radii).max()) - ground)
    return highest


def _standing_geoms(model: mujoco.MjModel, geoms: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return which shapes of a foot touch the ground: where none does, those that are not seen."""
    for chosen in (solid_geoms(model), model.geom_group >= SEEN_GROUPS):
        if chosen[geoms].any():
            return geoms[chosen[geoms]]
    return geoms


def _level_axes(cloud: Cloud, faces: list[Floats], forward: Floats) -> Floats:
    """Return the axes (3, 3), columns ahead, left and up, of the plane that a foot rests on."""
    level = _axes(forward, np.array([0.0, 0.0, 1.0]))
    tilted = [_axes(forward, normal) for normal in (_resting_normal(cloud), *faces)]
    areas = [_touching_area(cloud, axes) for axes in tilted]
    best = int(np.argmax(areas))
    return tilted[best] if areas[best] > LARGER * _touching_area(cloud, level) else level


def _faces(model: mujoco.MjModel, data: mujoco.MjData, geoms: NDArray[np.intp]) -> list[Floats]:
    """Return the normals of the sides of a foot's boxes that may be its sole, pointing up."""
    found = []
    for geom in geoms:
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX:
            for axis in data.geom_xmat[geom].reshape(3, 3).T:
                if abs(axis[2]) > np.cos(STEEPEST_RAD):
                    found.append(axis * np.sign(axis[2]))
    return found


def _axes(forward: Floats, up: Floats) -> Floats:
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    return np.column_stack([np.cross(left, up), left, up])


def _resting_normal(cloud: Cloud) -> Floats:
    """Return the normal of the plane on which a foot rests that is loaded over its low part.

    Of all planes below the foot it is the highest one under the load: a convex search by slopes.
    """
    points = cloud.lowest(np.array([0.0, 0.0, 1.0]))
    heights = points[:, 2] - points[:, 2].min()
    low = points[heights <= max(SOLE_DEPTH_M, LOW_SHARE * float(heights.max()))]
    load = 0.5 * (low[:, :2].min(axis=0) + low[:, :2].max(axis=0))
    offsets = points[:, :2] - load

    def depth(slopes: Floats) -> float:
        return -float((points[:, 2] - offsets @ slopes).min())

    best, step = np.zeros(2), 0.5 * MOST_TILT
    turns = [np.array([np.cos(a), np.sin(a)]) for a in np.linspace(0.0, 2 * np.pi, 16, False)]
    least = depth(best)
    while step > 1e-5:
        trials = [best + step * turn for turn in turns]
        depths = [depth(trial) for trial in trials]
        chosen = int(np.argmin(depths))
        if depths[chosen] < least - 1e-9:
            best, least = trials[chosen], depths[chosen]
        else:
            step *= 0.5
    normal = np.array([-best[0], -best[1], 1.0])
    upright: Floats = normal / np.linalg.norm(normal)
    return upright


def _touching(cloud: Cloud, axes: Floats) -> Floats:
    """Return (n, 3) m, in the plane's axes, what touches it."""
    points: Floats = cloud.lowest(axes[:, 2]) @ axes
    near: Floats = points[points[:, 2] <= points[:, 2].min() + SOLE_DEPTH_M]
    return near


def _touching_area(cloud: Cloud, axes: Floats) -> float:
    return outline_area(_touching(cloud, axes)[:, :2])


def _extent(cloud: Cloud, axes: Floats) -> tuple[Floats, Floats, float]:
    """Return the least and largest coordinates of the sole, and how much of that it fills."""
    points = _touching(cloud, axes)
    least, most = points.min(axis=0), points.max(axis=0)
    around = float((most[0] - least[0]) * (most[1] - least[1]))
    return least, most, outline_area(points[:, :2]) / around if around > 0.0 else 0.0


def _angle(one: Floats, other: Floats) -> float:
    """Return the angle between two sets of axes, rad."""
    return float(np.arccos(np.clip(0.5 * (np.trace(one.T @ other) - 1.0), -1.0, 1.0)))
