"""Rooms that draw themselves as a robot sees them, and what each pixel truly shows."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.outlines import signed_distance
from treadwell.experiments.drawn import write_scenario
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import Robot, load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.senses.depth import Cast
from treadwell.senses.sensors import Sensors
from treadwell.sources.frame import PinholeCamera

Floats = NDArray[np.float64]
_KIND_OF: Final = {
    "wall": 2,
    "lintel": 2,
    "door": 5,
    "desk": 3,
    "shelf": 3,
    "cable": 4,
    "person": 4,
    "threshold": 1,
    "bevel": 0,
    "ramp": 0,
    "flight": 1,
    "floor": 1,
}
"""What the parts of a house are, by the word before the number in their names."""
_CLEAR_M: Final = 0.25
"""Between the robot's middle and what stands."""
_HIGH_M: Final = 0.1
"""What reaches higher stands in the way."""
_FRAME_NS: Final = 160_000_000
_SAME_PLANE_M: Final = 2e-3
_OF_NONE: Final = -1


@dataclass(frozen=True, slots=True, eq=False)
class RoomLook:
    """One look into a room.

    Attributes:
        depth: (h, w) float32 m along the optical axis, with the camera's errors; NaN where it saw
            nothing.
        world_from_camera: (4, 4) of the optical frame; the floor is z = 0.
        surface: (h, w) number of the plane that each pixel truly shows, from 1 on; 0 of what is
            round, and where nobody asked.
        kind: (h, w) index into `room_labels.NAMES`, -1 without a depth.
    """

    depth: NDArray[np.float32]
    world_from_camera: Floats
    surface: NDArray[np.int64]
    kind: NDArray[np.int64]


class DrawnRooms:
    """A house with furniture and doors, and a robot that stands in it somewhere.

    Attributes:
        camera: whose pictures they are.
    """

    def __init__(self, seed: int, robot: str) -> None:
        """Draw a house.

        Args:
            seed: of house and errors.
            robot: whose camera looks.

        Raises:
            InputError: no house can be drawn.
        """
        house = {"kind": "house", "name": "house", "rooms": 2 + seed % 3, "closed": 0.15}
        table: dict[str, Any] = {
            "schema": 1,
            "name": "rooms",
            "seed": seed,
            "start": {"position": [0.0, 0.0]},
            "goal": {"position": [4.0, 0.0]},
            "course": [house],
        }
        with TemporaryDirectory() as folder:
            path = write_scenario(Path(folder) / "rooms.toml", table)
            scenario = load_scenario(path, robot=robot)
        self._robot: Robot = load_robot(scenario.robot)
        self._course: Course = build_course(scenario, self._robot)
        streams = RandomStreams(seed)
        self._sensors = Sensors(
            self._course.model, self._robot, scenario.sensors, streams, self._course.texture
        )
        self._numbers = np.random.default_rng([seed, 37])
        pinhole = self._sensors.camera.pinhole
        middle = [(size - 1) / 2 for size in (pinhole.width, pinhole.height)]
        sides = (pinhole.focal, pinhole.focal)
        self.camera = PinholeCamera(pinhole.width, pinhole.height, *sides, *middle)
        self._kinds = self._kinds_of_geoms()

    def looks(self, count: int, *, surfaces: bool = False) -> Iterator[RoomLook]:
        """Yield what is seen from places drawn in the rooms, each in a direction of its own.

        Args:
            count: how many.
            surfaces: whether to say which plane each pixel shows, which takes time.
        """
        model = self._course.model
        data = mujoco.MjData(model)
        root = int(model.jnt_qposadr[model.body(self._robot.root).jntadr[0]])
        for number in range(count):
            x, y = self._free_place()
            yaw = float(self._numbers.uniform(-np.pi, np.pi))
            data.qpos[:] = self._course.qpos
            data.qpos[root : root + 3] = x, y, self._robot.stand_qpos[2]
            data.qpos[root + 3 : root + 7] = [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]
            mujoco.mj_forward(model, data)
            observed = self._sensors.observe(data, number * _FRAME_NS)
            cast = self._sensors.camera.cast(data)
            frame = observed.depth
            if frame is None:
                continue
            surface = (
                self._surfaces(cast, data) if surfaces else np.zeros(cast.geom.shape, np.int64)
            )
            yield self._look(frame.depth.copy(), cast, surface)

    def _look(self, depth: NDArray[np.float32], cast: Cast, surface: NDArray[np.int64]) -> RoomLook:
        own = self._kinds[cast.geom] == _OF_NONE
        depth[own] = np.nan
        unseen = ~np.isfinite(depth)
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = cast.rotation, cast.position
        return RoomLook(depth, pose, surface, np.where(unseen, _OF_NONE, self._kinds[cast.geom]))

    def _surfaces(self, cast: Cast, data: mujoco.MjData) -> NDArray[np.int64]:
        """Return the plane of each pixel, (h, w): faces of boxes and hulls in one plane."""
        pinhole = self._sensors.camera.pinhole
        rays = pinhole.directions() @ cast.rotation.T
        points = (cast.position + rays * cast.depth.reshape(-1, 1)).reshape(*cast.depth.shape, 3)
        down = np.cross(points[1:, :-1] - points[:-1, :-1], points[:-1, 1:] - points[:-1, :-1])
        same = (cast.geom[1:, :-1] == cast.geom[:-1, :-1]) & (
            cast.geom[:-1, 1:] == cast.geom[:-1, :-1]
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            down /= np.linalg.norm(down, axis=-1, keepdims=True)
        normals = np.full(points.shape, np.nan)
        normals[:-1, :-1][same] = down[same]
        numbers = np.zeros(cast.geom.shape, dtype=np.int64)
        model = self._course.model
        planes: list[tuple[Floats, float]] = []
        for geom in np.unique(cast.geom):
            if geom < 0 or model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CYLINDER:
                continue
            here = cast.geom == geom
            for normal in _faces(model, data, int(geom), normals[here]):
                offsets = points[here] @ normal
                for offset in _levels(offsets, normals[here], normal):
                    number = _number(planes, normal, offset)
                    on_it = np.zeros(here.shape, dtype=bool)
                    on_it[here] = np.abs(offsets - offset) < _SAME_PLANE_M
                    numbers[on_it & (numbers == 0)] = number
        return numbers

    def _kinds_of_geoms(self) -> NDArray[np.int64]:
        """Return for each geom what it is; -1 of the robot, and behind all of what is nothing."""
        kinds = np.full(self._course.model.ngeom + 1, _OF_NONE, dtype=np.int64)
        kinds[self._course.model.geom("ground").id] = 0
        for element in self._course.elements:
            word = element.name.removeprefix("house.").split(" ")[0]
            kind = 2 if element.kind == "door" and element.hinge is None else _KIND_OF[word]
            kinds[list(element.geom_ids)] = kind
        return kinds

    def _free_place(self) -> tuple[float, float]:
        outlines = [
            piece.outline
            for element in self._course.elements
            for piece in element.pieces
            if piece.vertices[:, 2].max() > _HIGH_M
        ]
        while True:
            place = self._numbers.uniform([-0.7, -1.5], [4.9, 1.5])
            if all(signed_distance(one, place[None])[0] > _CLEAR_M for one in outlines):
                return float(place[0]), float(place[1])


def _faces(model: mujoco.MjModel, data: mujoco.MjData, geom: int, seen: Floats) -> list[Floats]:
    """Return the unit normals of a geom's planes that are seen."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
        return [np.array([0.0, 0.0, 1.0])]
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX:
        return [axis.copy() for axis in data.geom_xmat[geom].reshape(3, 3).T]
    known = seen[np.isfinite(seen).all(axis=1)]
    return list(np.unique(known.round(3), axis=0))


def _levels(offsets: Floats, seen: Floats, normal: Floats) -> list[float]:
    """Return how far along its normal the planes of one direction lie that are seen."""
    along = np.abs(seen @ normal) > 0.999
    found = np.sort(offsets[along & np.isfinite(offsets)])
    if not len(found):
        return []
    ends = np.flatnonzero(np.diff(found) > _SAME_PLANE_M)
    return [float(np.median(part)) for part in np.split(found, ends + 1)]


def _number(planes: list[tuple[Floats, float]], normal: Floats, offset: float) -> int:
    """Return the number of a plane, a new one where there is none like it."""
    for number, (other, there) in enumerate(planes, start=1):
        sign = float(np.sign(other @ normal))
        if abs(other @ normal) > 0.9999 and abs(sign * offset - there) < _SAME_PLANE_M:
            return number
    planes.append((normal, offset))
    return len(planes)
