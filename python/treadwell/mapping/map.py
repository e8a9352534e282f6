"""A map of range pictures and clouds of one's own, whose poses are known."""

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from treadwell._core import FloorView, RangeMap, Staircase
from treadwell.errors import CoreError, InputError
from treadwell.guard import Guard, blamed
from treadwell.map_making.headroom import headroom_of
from treadwell.map_making.leaning import Leaning
from treadwell.map_making.made import title_of
from treadwell.map_making.mapper import NOT_TAKEN, NOTHING_SEEN, placed_cubes
from treadwell.map_making.placing import Placing, ground_below, placing, sensed
from treadwell.map_making.request import MapTable
from treadwell.map_making.sizing import pooled, sizing
from treadwell.mapping.camera import Camera
from treadwell.mapping.checks import (
    checked_tables,
    cloud_points,
    depth_picture,
    own_part,
    pose_matrix,
    raw_tables,
)
from treadwell.mapping.kept_frames import KeptFrames, Seen
from treadwell.scenario.model import Navigation
from treadwell.scenario.overrides import Overrides
from treadwell.sources.frame import Floats, RangeFrame

NO_SURFACE: Final = "no level surface was found"
_CALL_LIMIT_S: Final = Navigation().call_limit


class Map:
    """Keeps a world model of what a range sensor saw from known poses: no episode, no MuJoCo.

    The map's frame is the world's, z up. What the data asks for and nobody sets (the size of the
    window, how far is looked) follows from the first frame; `assumed` says what.

    >>> world = mapping.Map("fog", camera, robot="qrio", overrides={"fog.cell": 0.02})
    >>> for depth, world_from_camera in frames:
    ...     seen = world.insert(depth, world_from_camera)
    >>> view = world.view()

    Attributes:
        camera: of the pictures; None: only clouds are taken.
        robot: whose height and stairs count; None without.
        assumed: key -> value, of what follows from the first frame.
    """

    def __init__(
        self,
        world_model: str | type | object = "fog",
        camera: Camera | None = None,
        *,
        robot: str | Path | None = None,
        segmenter: str | type | object = "scan_line",
        overrides: Overrides = (),
    ) -> None:
        """Choose the parts; the map is made by the first frame.

        Args:
            world_model: a name of `treadwell list components`, `package.module:Class`, or a class
                or an object with the methods of `treadwell.protocols.WorldModel`.
            camera: of the pictures.
            robot: a robot's name or folder; with it, stairs are looked for in the pictures.
            segmenter: what finds surfaces in the pictures: a name of the list,
                `package.module:Class`, or a class or an object with the method of
                `treadwell.protocols.Segmenter`. It sees pictures of square pixels whose optical
                axis is in the middle, as its `Scan` says: those of another camera are laid so.
            overrides: settings of `[navigation]`, as in `{"fog.cell": 0.02}`.

        Raises:
            InputError: one of them cannot be used; it is named.
        """
        self.camera = camera
        self.robot = None if robot is None else str(robot)
        self.assumed: dict[str, Any] = {}
        raw = raw_tables(overrides)
        self._guards: dict[str, Guard] = {}
        self._name = self._chosen("world_model", world_model, raw)
        self._segmenter = self._chosen("segmenter", segmenter, raw)
        own = self._guards.get("world_model")
        names = {"segmenter": self._segmenter, "world_model": self._name}
        parts = {slot: name for slot, name in names.items() if slot not in self._guards}
        self._parameters = checked_tables({**raw, **parts})
        if own is None:
            # Settings that cannot be are refused here, not by the first frame.
            _, headroom = headroom_of(self._name, self._parameters, self.robot)
            RangeMap(self._name, settings=json.dumps(self._parameters), headroom=headroom)
        self._data = MapTable()
        self._kept = KeptFrames()
        self._leaning = Leaning()
        self._core: RangeMap | None = None
        self._place: Placing | None = None
        self._camera_set = False

    def __repr__(self) -> str:
        return f"<Map {self._name}, {self._kept.taken} frames>"

    def insert(
        self, depth: ArrayLike, world_from_camera: ArrayLike, *, time: float | None = None
    ) -> Seen:
        """Take in a depth picture of the camera.

        Args:
            depth: (h, w) m along the optical axis, of any float type and stride; NaN or 0 where
                nothing was seen.
            world_from_camera: (4, 4) pose; of the camera's frame z is the optical axis, forward,
                x right, y down.
            time: s, when it was taken, for the recording; None: as many as there were frames.

        Raises:
            InputError: no picture of the camera, or no pose.
            CoreError: a part of the user's failed; the map is as it was.
        """
        if self.camera is None:
            raise InputError("Map.insert: the map was made without a camera: Map(..., camera)")
        picture = depth_picture(depth, self.camera)
        pose = pose_matrix(world_from_camera, "world_from_camera")
        when = self._kept.taken if time is None else time
        return self._insert(RangeFrame(when, pose, self.camera, picture, None, "picture"))

    def insert_points(
        self, points: ArrayLike, world_from_sensor: ArrayLike, *, time: float | None = None
    ) -> Seen:
        """Take in a cloud, all of it seen from the sensor's origin.

        Args:
            points: (n, 3) m in the sensor's frame, of any float type; rows with NaN are left out.
            world_from_sensor: (4, 4) pose.
            time: s, when it was taken, for the recording; None: as many as there were frames.

        Raises:
            InputError: no cloud or no pose; or the world model finds its floors in pictures.
            CoreError: a part of the user's failed; the map is as it was.
        """
        cloud = cloud_points(points)
        pose = pose_matrix(world_from_sensor, "world_from_sensor")
        when = self._kept.taken if time is None else time
        return self._insert(RangeFrame(when, pose, None, None, cloud, "cloud"))

    def view(self) -> FloorView:
        """Return the map: `origin`, `cell`, `kind`, `height`, `sightings`; a copy.

        Its method `clearance()` gives the distance to what blocks, and
        `passable(z, rise, radius)` where a robot may be.

        Raises:
            InputError: no frame was taken in yet.
        """
        core, place = self._made("view")
        x, y, z = place.offset.tolist()
        return core.view().moved((x, y, z))

    def staircase(self) -> Staircase | None:
        """Return the stairs in the map's own frame; None where they are not looked for."""
        return None if self._core is None else self._core.staircase()

    def voxels(self) -> NDArray[np.float32]:
        """Return middle and side of each occupied cube, (n, 4) m, of a model that keeps such."""
        core, place = self._made("voxels")
        return placed_cubes(core, place.offset)

    def save_picture(self, path: str | Path, name: str = "map") -> Path:
        """Draw the map from above, with the way of the sensor, as `treadwell map` does.

        It shows all that was seen, also what a window around the sensor left behind.

        Args:
            path: of the PNG file.
            name: what was mapped.

        Raises:
            InputError: no frame was used yet, or the file's name ends otherwise.
            RecordingError: the file cannot be written.
        """
        core, place = self._made("save_picture", used=True)
        frames = (len(self._kept.poses), self._kept.taken)
        title = title_of(name, self._name, frames, core.view().cell)
        self._kept.draw(Path(path), title, place.offset)
        return Path(path)

    def _repr_png_(self) -> bytes | None:
        if not self._kept.poses:
            return None
        with TemporaryDirectory() as folder:
            return self.save_picture(Path(folder) / "map.png").read_bytes()

    def save_recording(self, path: str | Path, name: str = "map") -> Path:
        """Write what the frames saw, the sensor and the map, to be opened with `rerun`.

        Of more than 500 frames it has evenly so many, each with some of its points.

        Args:
            path: of the file, `.rrd`.
            name: what was mapped.

        Raises:
            InputError: no frame was used yet, or the file's name ends otherwise.
            RecordingError: the file cannot be written.
        """
        core, place = self._made("save_recording", used=True)
        self._kept.record(Path(path), name, core, place.offset)
        return Path(path)

    @property
    def notes(self) -> tuple[str, ...]:
        """What may be wrong with the data, a sentence each: a floor in the pictures that leans."""
        return self._leaning.of_poses(self._data)

    @property
    def core(self) -> RangeMap:
        """The core's map, for the other parts of the library.

        Raises:
            InputError: no frame was taken in yet.
        """
        return self._made("core")[0]

    @property
    def offset(self) -> Floats:
        """(3,) m: the origin of the core's map in the world; 0 unless the data lie far away.

        Raises:
            InputError: no frame was taken in yet.
        """
        return self._made("offset")[1].offset

    def _chosen(self, slot: str, given: str | type | object, raw: dict[str, Any]) -> str:
        """Return a part's name; one of the user's is kept behind a guard."""
        own, name = own_part(slot, given, raw)
        if own is not None:
            self._guards[slot] = Guard(slot, name, own, _CALL_LIMIT_S)
        return name

    def _made(self, asked: str, *, used: bool = False) -> tuple[RangeMap, Placing]:
        if self._core is None or self._place is None:
            raise InputError(f"Map.{asked}: no frame was taken in yet")
        if used and not self._kept.poses:
            raise InputError(f"Map.{asked}: none of {self._kept.taken} frames was used")
        return self._core, self._place

    def _insert(self, frame: RangeFrame) -> Seen:
        core = self._core or self._begin(frame)
        assert self._place is not None
        self._kept.taken += 1
        some = sensed(frame)
        if not len(some):
            return Seen(used=False, reason=NOTHING_SEEN, planes=None)
        pose = self._place.pose(frame.world_from_sensor)
        ground = ground_below(some, pose)
        try:
            if frame.depth is None:
                assert frame.points is not None
                used, planes = core.insert_points(frame.points, pose, ground), None
            else:
                used, planes = core.insert_depth(frame.depth, pose, ground), core.planes()
        except CoreError as error:
            raise blamed(error, self._guards) from None
        if not used:
            return Seen(used=False, reason=NOT_TAKEN, planes=planes)
        self._kept.insert(frame.time, pose, some, core.view())
        self._leaning.insert(frame, pose)
        floors = planes is None or np.isfinite(planes.floor_height).any()
        idle = core.needs_surfaces and not floors
        return Seen(used=True, reason=NO_SURFACE if idle else None, planes=planes)

    def _begin(self, first: RangeFrame) -> RangeMap:
        """Make the core's map for data like the first frame."""
        own = self._guards.get("world_model")
        rough = placing(self._data.up, first.world_from_sensor, 1.0)
        sizes = sizing(self._name, self._parameters, (first, rough), self._data.ground)
        parameters = sizes.parameters
        if self.robot is not None:
            from treadwell.robot.load import load_robot

            of_robot = load_robot(self.robot).file.navigation.get("stairs", {})
            parameters["stairs"] = {**of_robot, **parameters.get("stairs", {})}
        _, headroom = headroom_of(self._name, parameters, self.robot)
        core = RangeMap(self._name, settings=json.dumps(parameters), headroom=headroom, model=own)
        if core.needs_surfaces and first.layout == "cloud" and own is None:
            raise InputError(
                f"world_model: found {self._name!r}, which finds its floors in pictures; of "
                "clouds a map is made by 'elevation' and its like"
            )
        camera = self.camera
        if camera is not None:
            core.set_camera(
                (camera.width, camera.height),
                (camera.fx, camera.fy),
                (camera.cx, camera.cy),
                segmenter=self._segmenter,
                pool=pooled(camera, self._data.columns),
                baseline=self._data.baseline,
                stairs=self.robot is not None,
                own=self._guards.get("segmenter"),
            )
        self.assumed = sizes.assumed
        self._place = placing(self._data.up, first.world_from_sensor, sizes.cell or 1.0)
        self._core = core
        return core
