"""Feeds frames to a world model of the core."""

import json
from collections import Counter
from dataclasses import replace
from time import perf_counter
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import RangeMap
from treadwell.errors import InputError
from treadwell.map_making.headroom import headroom_of
from treadwell.map_making.placing import Placing, ground_below, placing, sensed
from treadwell.map_making.plan_topology import Topology
from treadwell.map_making.plan_view import (
    HELD,
    LINES,
    OCCUPANCY,
    SCAN_MODELS,
    TOPOLOGY,
    PlanView,
    placed_lines,
    plan_view,
)
from treadwell.map_making.request import MESH, PICTURES, POINTS, MapRequest
from treadwell.map_making.sizing import Sizing, pooled, sizing
from treadwell.map_making.standing_out import StandingOut
from treadwell.map_making.texture import TexturePictures
from treadwell.map_memory import MapMemory, RememberedMap
from treadwell.map_result import MappedLines
from treadwell.recording.mesh_file import SurfaceMesh
from treadwell.sources.frame import Floats, RangeFrame, moved

NOTHING_SEEN: Final = "nothing was seen"
NOT_TAKEN: Final = "the world model did not take it"


class Mapper:
    """Keeps a map of a source's frames; made for the first of them."""

    def __init__(self, request: MapRequest, first: RangeFrame) -> None:
        """Choose model and settings by what the data is like.

        Args:
            request: what the user asks for.
            first: the source's first frame.

        Raises:
            InputError: a setting cannot be used, or the model has no use for such data.
        """
        self._request = request
        self.world_model = self._named(first)
        rough = placing(request.data.up, first.world_from_sensor, 1.0)
        self.sizes: Sizing = sizing(
            self.world_model, request.parameters, (first, rough), request.data.ground
        )
        self.place: Placing = placing(
            request.data.up, first.world_from_sensor, self.sizes.cell or 1.0
        )
        self.robot, headroom = headroom_of(self.world_model, self.sizes.parameters, request.robot)
        self.unused: Counter[str] = Counter()
        self.seconds: list[float] = []
        self._memory = MapMemory()
        tables = {**self.sizes.parameters, **request.plan_view}
        if self.world_model == LINES and "held" not in request.plan_view[LINES]:
            self.sizes.assumed["plan_view.lines.held"] = HELD
        self._plan: PlanView | None = (
            plan_view(self.world_model, self.sizes.cell, tables) if first.layout == "scan" else None
        )
        self._standing_out = (
            StandingOut(request.ground_filter) if self.sizes.filters_ground else None
        )
        self._core = RangeMap(
            POINTS if self._plan else self.world_model,
            settings=json.dumps(self.sizes.parameters),
            headroom=headroom,
        )
        self._camera: tuple[int, int] | None = None
        self._pictures = TexturePictures(request.data.pictures if self.world_model == MESH else 0)
        if self._core.needs_surfaces and first.layout == "cloud":
            raise InputError(
                f"--world-model: found {self.world_model}, which finds its floors in pictures; "
                f"of clouds a map is made by {POINTS} and its like"
            )

    @property
    def is_plan(self) -> bool:
        """Whether the map is one of a plane, of scans."""
        return self._plan is not None

    @property
    def sees_pictures(self) -> bool:
        """Whether the frames are depth images."""
        return self._camera is not None

    def insert(self, frame: RangeFrame) -> Floats | None:
        """Take in a frame; return its sensor's pose (4, 4) in the map, None if it was not used."""
        pose = self.place.pose(frame.world_from_sensor)
        some = sensed(frame)
        if not len(some):
            self.unused[NOTHING_SEEN] += 1
            return None
        started = perf_counter()
        if not self._take(frame, pose, ground_below(some, pose)):
            self.unused[NOT_TAKEN] += 1
            return None
        if self._plan is None:
            view = self._core.view()
            self._memory.update(view.origin, view.cell, view.kind, view.height, view.sightings)
        self.seconds.append(perf_counter() - started)
        self._pictures.insert(frame, pose)
        return pose

    def map(self) -> RememberedMap:
        """Return the map in the frame of the world whose z is up: the offset is in its origin."""
        found = self._memory.map() if self._plan is None else self._plan.map()
        if self._standing_out is not None:
            found = self._standing_out.over(found)
        return placed_map(found, self.place.offset, self.sizes.cell)

    def probability(self) -> NDArray[np.float32] | None:
        """Return how probably each cell of a plane is occupied, (rows, cols); NaN where unknown."""
        return None if self._plan is None else self._plan.probability()

    def lines(self) -> MappedLines | None:
        """Return the lines, in the frame of the world, where the model has them."""
        return None if self._plan is None else placed_lines(self._plan.lines(), self.place.offset)

    def topology(self) -> Topology | None:
        """Return places and ways, in the frame of the world, where the model has them."""
        if self._plan is None or self.world_model != TOPOLOGY:
            return None
        return Topology.of(
            self._plan.map(), self._request.plan_view[TOPOLOGY], self.place.offset[:2]
        )

    def voxels(self) -> NDArray[np.float32]:
        """Return middle and side of each occupied cube, (n, 4) m."""
        return placed_cubes(self._core, self.place.offset)

    def surface(self) -> SurfaceMesh | None:
        """Return the surface as triangles where the model keeps it, with what it looks like."""
        found = self._core.surface()
        if found is None:
            return None
        mesh = self._pictures.shown(SurfaceMesh(*found), self.sizes.parameters)
        placed = (mesh.corners + self.place.offset).astype(np.float32)
        return replace(mesh, corners=placed)

    def _take(self, frame: RangeFrame, pose: Floats, ground: float) -> bool:
        if frame.depth is not None and frame.camera is not None:
            self._see_through(frame)
            depth = np.ascontiguousarray(frame.depth, np.float32)
            return self._core.insert_depth(depth, pose, ground)
        points = frame.points if frame.points is not None else np.zeros((0, 3), np.float32)
        if self._plan is not None:
            return self._plan.insert(points @ pose[:3, :3].T + pose[:3, 3], pose[:3, 3])
        if self._standing_out is not None:
            seen = np.isfinite(points).all(axis=1)
            ground_ones = self._standing_out.ground(moved(pose, points[seen].astype(np.float64)))
            points = points[seen][ground_ones]
        eye = pose.copy()
        if self.sizes.altitude:
            above = np.array([0.0, 0.0, self.sizes.altitude])
            eye[:3, 3] += above
            points = points - (above @ pose[:3, :3]).astype(np.float32)
        return self._core.insert_points(np.ascontiguousarray(points, np.float32), eye, ground)

    def _see_through(self, frame: RangeFrame) -> None:
        """Give the core the camera of the pictures, once."""
        camera = frame.camera
        if camera is None or self._camera is not None:
            return
        self._camera = (camera.width, camera.height)
        data = self._request.data
        pool = pooled(camera, data.columns)
        self._core.set_camera(
            self._camera,
            (camera.fx, camera.fy),
            (camera.cx, camera.cy),
            segmenter=self._request.segmenter,
            pool=pool,
            baseline=data.baseline,
        )

    def _named(self, first: RangeFrame) -> str:
        named = self._request.world_model
        if first.layout == "scan":
            if named not in (None, *SCAN_MODELS):
                raise InputError(
                    f"--world-model: found {named}; of scans of a laser that sweeps a plane a map "
                    f"is made by one of {', '.join(SCAN_MODELS)}"
                )
            return named or OCCUPANCY
        if named in (LINES, TOPOLOGY):
            raise InputError(
                f"--world-model: found {named}, which is made of scans of a laser; of pictures "
                f"and clouds a map is made by {POINTS} and its like"
            )
        if named is None:
            return PICTURES if first.layout == "picture" else POINTS
        if ":" in named:
            raise InputError(
                f"--world-model: found {named}; a map is made by the models that are built in"
            )
        return named


def placed_map(found: RememberedMap, offset: Floats, cell: float = 0.0) -> RememberedMap:
    """Return a map of the core's in the world whose z is up.

    Args:
        found: the map.
        offset: (3,) m, its origin there.
        cell: m, of its cells where it has none.
    """
    x, y, z = offset.tolist()
    return RememberedMap(
        (found.origin[0] + x, found.origin[1] + y),
        found.cell or cell,
        found.kind,
        (found.height + np.float32(z)).astype(np.float32),
        found.sightings,
    )


def placed_cubes(core: RangeMap, offset: Floats) -> NDArray[np.float32]:
    """Return middle and side of each occupied cube of a map, (n, 4) m, in that world."""
    middles, sides = core.occupied()
    there = middles.reshape(-1, 3) + offset
    return np.column_stack([there, sides]).astype(np.float32)
