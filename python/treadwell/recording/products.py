"""What the core produced, in the recording: camera, points, poses, state and times."""

import math

import numpy as np
import rerun as rr

from treadwell.judging.result import STAGES
from treadwell.recording.depth_picture import UNIT_M, depth_png
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import (
    ESTIMATE,
    ODOMETRY,
    STATE_COLOURS,
    TRUTH,
    plane_colours,
)
from treadwell.recording.map_shapes import MapShapes
from treadwell.recording.stair_shapes import StairShapes
from treadwell.recording.step_shapes import StepShapes
from treadwell.recording.tracks import Tracks
from treadwell.trace import Trace

_AHEAD = 0.15
"""Metres before the robot that the view of the feet looks at."""
_DEPTH_RANGE_M = (0.2, 3.0)
"""Metres that have the first and the last colour of a depth image."""
_MOST_POINTS = 2200
"""So many pixels of a frame become points, about: a third of the small camera's 88x72."""
_POINT_STRIDES = (3, 7, 11, 13, 17, 23, 31, 37, 47)
"""Of so many pixels one is taken. Of a number that divides a picture's width columns would come."""


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
        self._rows = rows
        self._map = MapShapes(rows, low, high)
        self._stair_shapes = StairShapes(rows, sole)
        self._step_shapes = StepShapes(rows, low=low, high=high, sole=sole)
        self._tracks = Tracks(rows)
        self._state = ""
        self._states: list[str] = []
        names = ["estimate", "odometry", "heading"]
        rows.style("error", rr.SeriesLines, colors=[ESTIMATE, ODOMETRY, TRUTH], names=names)
        rows.style("timing", rr.SeriesLines, names=list(STAGES))
        rows.style("world/points", rr.Points3D, radii=[0.006])
        rows.style("world/believed", rr.Arrows3D, colors=[ESTIMATE], radii=[0.01])
        rows.style("world/ahead", rr.Points3D, colors=[ESTIMATE], radii=[0.001])
        rows.style(
            "camera/depth",
            rr.EncodedDepthImage,
            media_type=["image/png"],
            meter=[1.0 / UNIT_M],
            colormap=["turbo"],
            depth_range=[tuple(metres / UNIT_M for metres in _DEPTH_RANGE_M)],
        )

    def log(self, trace: Trace) -> None:
        """Write everything of a camera frame; the time is set."""
        self._log_camera(trace)
        if trace.map_due:
            self._map.log(trace)
        self._stair_shapes.log(trace)
        self._step_shapes.log(trace.stepping)
        self._tracks.log(trace)
        self._log_believed(trace)
        self._log_state(trace)
        self._log_plots(trace)

    def _log_camera(self, trace: Trace) -> None:
        if trace.depth is not None:
            self._rows.log("camera/depth", rr.EncodedDepthImage, blob=[depth_png(trace.depth)])
        if trace.points_in_robot is not None and trace.labels is not None:
            stride = point_stride(len(trace.labels))
            points, labels = trace.points(stride), trace.labels[::stride]
            assert points is not None
            seen = np.isfinite(points[:, 0])
            colours = plane_colours(labels[seen], trace.ground)
            self._rows.log("world/points", rr.Points3D, positions=points[seen], colors=colours)
        if trace.map_from_camera is not None:
            pose = trace.map_from_camera
            self._rows.log(
                "world/camera",
                rr.Transform3D,
                translation=pose[None, :3, 3],
                mat3x3=pose[None, :3, :3],
            )

    def _log_believed(self, trace: Trace) -> None:
        believed = trace.map_from_robot
        here, forward = believed[:3, 3], believed[:3, 0]
        origin = here + np.array([0.0, 0.0, 0.02])
        self._rows.log("world/believed", rr.Arrows3D, origins=[origin], vectors=[0.2 * forward])
        self._rows.log("world/ahead", rr.Points3D, positions=[here + _AHEAD * forward])

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


def point_stride(pixels: int) -> int:
    """Return of how many pixels of a frame one becomes a point."""
    wanted = pixels / _MOST_POINTS
    return next((stride for stride in _POINT_STRIDES if stride >= wanted), _POINT_STRIDES[-1])
