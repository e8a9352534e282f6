"""What the core produced, in the recording: points, map, path, poses, state and times."""

import math

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from treadwell.judging.result import STAGES
from treadwell.map_memory import FLOOR
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import (
    CLIMB,
    ESTIMATE,
    OBSTACLE,
    ODOMETRY,
    PATH,
    STATE_COLOURS,
    TRUTH,
    UNSEEN,
    height_colours,
    plane_colours,
)
from treadwell.recording.stair_shapes import StairShapes
from treadwell.trace import Trace

_TRACK_SPACING = 0.03
"""Metres between the points of a drawn trajectory."""
_LEAST_COLUMN = 0.02
"""Metres: least height of an obstacle's column."""
_PATH_ABOVE = 0.012
"""Metres by which the path is drawn above the floor."""
_AHEAD = 0.15
"""Metres before the robot that the view of the feet looks at."""
_POINT_STRIDE = 3
"""Of so many points one is recorded."""
_MAP_STRIDE = 2
"""Of so many camera frames one has its map recorded."""


class Products:
    """Writes the products of each camera frame into a recording."""

    def __init__(
        self, rows: FrameLog, *, low: float, high: float, sole: tuple[float, float]
    ) -> None:
        """Log the style of everything once.

        Args:
            rows: of the recording.
            low: m, floor height with the darkest colour.
            high: m, floor height with the brightest.
            sole: m, length and width of a sole.
        """
        self._rows, self._range = rows, (low, high)
        self._stair_shapes = StairShapes(rows, sole)
        self._tracks: dict[str, list[NDArray[np.float64]]] = {}
        self._state, self._frames = "", 0
        self._states: list[str] = []
        names = ["estimate", "odometry", "heading"]
        lines = rr.SeriesLines(colors=[ESTIMATE, ODOMETRY, TRUTH], names=names)
        rows.stream.log("error", lines, static=True)
        rows.stream.log("timing", rr.SeriesLines(names=list(STAGES)), static=True)

    def log(self, trace: Trace) -> None:
        """Write everything of a camera frame; the time is set."""
        self._log_camera(trace)
        if self._frames % _MAP_STRIDE == 0:
            self._log_map(trace)
        self._frames += 1
        self._stair_shapes.log(trace)
        self._log_poses(trace)
        self._log_state(trace)
        self._log_plots(trace)

    def _log_camera(self, trace: Trace) -> None:
        if trace.depth is not None:
            depth = np.nan_to_num(1e3 * trace.depth, nan=0.0)
            image = np.clip(depth, 0.0, 65535.0).astype(np.uint16)
            self._log_depth("camera/depth", image, "turbo", (200, 3000))
        if trace.points is not None and trace.labels is not None:
            points, labels = trace.points[::_POINT_STRIDE], trace.labels[::_POINT_STRIDE]
            seen = np.isfinite(points[:, 0])
            self._rows.log(
                "world/points",
                rr.Points3D,
                positions=points[seen],
                colors=plane_colours(labels[seen], trace.ground),
                radii=[0.006],
            )
        if trace.map_from_camera is not None:
            pose = trace.map_from_camera
            self._rows.log(
                "world/camera",
                rr.Transform3D,
                translation=pose[None, :3, 3],
                mat3x3=pose[None, :3, :3],
            )

    def _log_depth(
        self,
        entity: str,
        image: NDArray[np.uint16],
        colormap: str,
        depth_range: tuple[float, float],
    ) -> None:
        """Add a picture (h, w) in millimetres; the range of its colours is given in them, too."""
        self._rows.log(
            entity,
            rr.DepthImage,
            buffer=[image.tobytes()],
            format=[
                rr.components.ImageFormat(
                    width=image.shape[1], height=image.shape[0], channel_datatype="U16"
                )
            ],
            meter=[1000.0],
            colormap=[colormap],
            depth_range=[depth_range],
        )

    def _log_map(self, trace: Trace) -> None:
        log, cell = self._rows.log, trace.view_cell
        x0, y0 = trace.view_origin
        floor, obstacle = trace.view_kind == 1, trace.view_kind == 2
        row, col = np.nonzero(floor)
        height = trace.view_height[floor]
        shades = height_colours(height, *self._range)
        centres = np.column_stack([x0 + (col + 0.5) * cell, y0 + (row + 0.5) * cell, height])
        log(
            "world/floor",
            rr.Boxes3D,
            centers=centres,
            half_sizes=[(0.46 * cell, 0.46 * cell, 0.001)],
            colors=shades,
            fill_mode=[rr.components.FillMode.Solid],
        )
        row, col = np.nonzero(obstacle)
        base = float(trace.map_from_robot[2, 3])
        half = np.maximum(trace.view_height[obstacle] - base, _LEAST_COLUMN) / 2
        sizes = np.column_stack([np.full((len(half), 2), 0.46 * cell), half])
        log(
            "world/obstacles",
            rr.Boxes3D,
            centers=np.column_stack(
                [x0 + (col + 0.5) * cell, y0 + (row + 0.5) * cell, base + half]
            ),
            half_sizes=sizes,
            colors=[(*OBSTACLE, 170)],
            fill_mode=[rr.components.FillMode.Solid],
        )
        picture = np.full((*trace.view_kind.shape, 3), UNSEEN, dtype=np.uint8)
        picture[floor] = shades
        picture[obstacle] = OBSTACLE
        log(
            "map/floor",
            rr.Image,
            buffer=[picture[::-1].tobytes()],
            format=[
                rr.components.ImageFormat(
                    width=picture.shape[1],
                    height=picture.shape[0],
                    color_model="RGB",
                    channel_datatype="U8",
                )
            ],
        )
        self._log_route(trace)
        if trace.clearance is not None:
            field = np.nan_to_num(1e3 * trace.clearance, nan=0.0, posinf=2000.0)
            image = np.clip(field, 0.0, 2000.0).astype(np.uint16)[::-1]
            self._log_depth("map/clearance", image, "viridis", (0, 800))

    def _log_route(self, trace: Trace) -> None:
        """Draw path and robot, in the world and over the picture of the map."""
        log = self._rows.log
        parts = legs(trace) if len(trace.path) > 1 else []
        raised = [
            np.column_stack([trace.path, floor_heights(trace) + _PATH_ABOVE])[leg]
            for leg, _ in parts
        ]
        colours = [colour for _, colour in parts]
        log("world/path", rr.LineStrips3D, strips=raised, colors=colours, radii=[0.006])
        flat = [self._pixels(trace, trace.path[leg]) for leg, _ in parts]
        log("map/floor/path", rr.LineStrips2D, strips=flat, colors=colours, radii=[0.4])
        here, heading = trace.map_from_robot[:2, 3], trace.map_from_robot[:2, 0]
        arrow = self._pixels(trace, np.array([here, here + 0.25 * heading]))
        log(
            "map/floor/robot",
            rr.Arrows2D,
            origins=arrow[:1],
            vectors=arrow[1:] - arrow[:1],
            colors=[ESTIMATE],
            radii=[0.8],
        )

    @staticmethod
    def _pixels(trace: Trace, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where points (n, 2) of the map frame are in the picture of the map."""
        at = (points - np.asarray(trace.view_origin)) / trace.view_cell
        pixels: NDArray[np.float64] = np.column_stack(
            [at[:, 0], trace.view_kind.shape[0] - at[:, 1]]
        )
        return pixels

    def _log_poses(self, trace: Trace) -> None:
        log = self._rows.log
        poses = {
            "truth": (trace.truth_from_robot, TRUTH),
            "estimate": (trace.map_from_robot, ESTIMATE),
            "odometry": (trace.odometry_from_robot, ODOMETRY),
        }
        for name, (pose, colour) in poses.items():
            track = self._tracks.setdefault(name, [])
            here = pose[:3, 3] + (0.0, 0.0, 0.02)
            if track and math.dist(here, track[-1]) < _TRACK_SPACING:
                continue
            track.append(here)
            if len(track) > 1:
                line = [np.array(track)]
                entity = f"world/trajectory/{name}"
                log(entity, rr.LineStrips3D, strips=line, colors=[colour], radii=[0.005])
        believed = trace.map_from_robot
        log(
            "world/believed",
            rr.Arrows3D,
            origins=[believed[:3, 3] + (0.0, 0.0, 0.02)],
            vectors=[0.2 * believed[:3, 0]],
            colors=[ESTIMATE],
            radii=[0.01],
        )
        ahead = believed[:3, 3] + _AHEAD * believed[:3, 0]
        log("world/ahead", rr.Points3D, positions=[ahead], radii=[0.001], colors=[ESTIMATE])

    def _log_state(self, trace: Trace) -> None:
        if trace.state == self._state:
            return
        self._state = trace.state
        if trace.state not in self._states:
            self._states.append(trace.state)
            number = np.arange(len(self._states)) % len(STATE_COLOURS)
            chosen = np.array(STATE_COLOURS, dtype=np.uint32)[number]
            style = rr.StateConfiguration(values=self._states, labels=self._states, colors=chosen)
            self._rows.stream.log("behaviour", style, static=True)
        self._rows.log("behaviour", rr.StateChange, state=[trace.state])

    def _log_plots(self, trace: Trace) -> None:
        truth, believed = trace.truth_from_robot, trace.map_from_robot
        turn = truth[:3, :3].T @ believed[:3, :3]
        errors = [
            math.dist(believed[:3, 3], truth[:3, 3]),
            math.dist(trace.odometry_from_robot[:3, 3], truth[:3, 3]),
            abs(float(np.arctan2(turn[1, 0], turn[0, 0]))),
        ]
        self._rows.log("error", rr.Scalars, scalars=errors)
        if trace.timing:
            times = [1e3 * trace.timing.get(stage, float("nan")) for stage in STAGES]
            self._rows.log("timing", rr.Scalars, scalars=times)


def legs(trace: Trace) -> list[tuple[slice, tuple[int, int, int]]]:
    """Return the path's legs in their order: which points, and the colour of walk or climb."""
    parts, at = [], 0
    for first, last in trace.climbs:
        parts += [(slice(at, first + 1), PATH), (slice(first, last + 1), CLIMB)]
        at = last
    parts.append((slice(at, len(trace.path)), PATH))
    return [(leg, colour) for leg, colour in parts if leg.stop - leg.start > 1]


def floor_heights(trace: Trace) -> NDArray[np.float64]:
    """Return the floor's height under each point of the path, m; where unknown, that before it."""
    at = np.floor((trace.path - trace.view_origin) / trace.view_cell).astype(np.intp)
    rows, cols = trace.view_kind.shape
    height, heights = float(trace.map_from_robot[2, 3]), []
    for col, row in at:
        if 0 <= row < rows and 0 <= col < cols and trace.view_kind[row, col] == FLOOR:
            height = float(trace.view_height[row, col])
        heights.append(height)
    return np.array(heights)
