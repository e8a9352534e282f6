"""The map in the recording: floor and obstacles in the world, pictures of both, and the path."""

from typing import Final

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import CLIMB, ESTIMATE, PATH, UNSEEN, height_colours
from treadwell.recording.layout import OBSTACLE as OBSTACLE_COLOUR
from treadwell.recording.tiles import Tiles
from treadwell.trace import Trace

Floats = NDArray[np.float64]

_LEAST_COLUMN: Final = 0.02
"""Metres: least height of an obstacle's column."""
_BASE_STEP: Final = 0.01
"""Metres in which columns begin higher where the robot does: each step draws all of them anew."""
_PATH_ABOVE: Final = 0.012
"""Metres by which the path is drawn above the floor."""
_SOLID: Final = (rr.components.FillMode.Solid,)
_SHADES: Final = 256
"""Colours from the lowest floor to the highest."""
_SHARE: Final = 0.46
"""Of a cell's side that half a box takes."""


class MapShapes:
    """Writes what has changed of map and path; what has not stays to be seen."""

    def __init__(self, rows: FrameLog, low: float, high: float) -> None:
        """Say what is always the same.

        Args:
            rows: of the recording.
            low: m, floor height with the darkest colour.
            high: m, floor height with the brightest.
        """
        self._rows, self._range = rows, (np.float32(low), np.float32(high))
        heights = np.linspace(low, high, _SHADES, dtype=np.float32)
        others = np.array([UNSEEN, OBSTACLE_COLOUR], np.uint8)
        self._colours = np.concatenate([height_colours(heights, low, high), others])
        self._tiles = Tiles()
        self._base = 0.0
        self._shown: dict[str, bytes] = {}
        rows.style(
            "map/clearance",
            rr.DepthImage,
            meter=[1000.0],
            colormap=["viridis"],
            depth_range=[(0, 800)],
        )
        rows.style("map/floor/robot", rr.Arrows2D, colors=[ESTIMATE], radii=[0.8])
        rows.style("map/floor/path", rr.LineStrips2D, radii=[0.4])
        rows.style("world/path", rr.LineStrips3D, radii=[0.006])

    def log(self, trace: Trace) -> None:
        """Write the map of a camera frame; the time is set."""
        window = trace.view_origin, trace.view_cell, trace.view_kind, trace.view_height
        changed = self._tiles.update(*window)
        if changed:
            self._log_floor(trace.view_cell)
            self._log_picture(trace)
        self._log_obstacles(trace, changed=changed)
        self._log_route(trace)
        if trace.clearance is not None and self._is_new("clearance", trace.clearance.tobytes()):
            field = np.nan_to_num(1e3 * trace.clearance, nan=0.0, posinf=2000.0)
            image = np.clip(field, 0.0, 2000.0).astype(np.uint16)[::-1]
            self._rows.log(
                "map/clearance", rr.DepthImage, buffer=[image.tobytes()], format=[_format(image)]
            )

    def _is_new(self, what: str, content: bytes) -> bool:
        """Say whether something is not what it was the last time."""
        if self._shown.get(what) == content:
            return False
        self._shown[what] = content
        return True

    def _log_floor(self, cell: float) -> None:
        cells = self._tiles.changed(FLOOR)
        centres = np.column_stack([cells.x, cells.y, cells.height])
        shades = self._colours[self._shades(cells.height)]
        for tile, (places, colours) in cells.split(centres, shades):
            entity = f"world/floor/{tile}"
            if not self._rows.is_styled(entity):
                half = (_SHARE * cell, _SHARE * cell, 0.001)
                self._rows.style(entity, rr.Boxes3D, half_sizes=[half], fill_mode=_SOLID)
            self._rows.log(entity, rr.Boxes3D, centers=places, colors=colours)

    def _log_obstacles(self, trace: Trace, *, changed: bool) -> None:
        base = _BASE_STEP * round(float(trace.map_from_robot[2, 3]) / _BASE_STEP)
        raised, self._base = base != self._base, base
        if not changed and not raised:
            return
        cells = self._tiles.changed(OBSTACLE, every=raised)
        half = np.maximum(cells.height - base, _LEAST_COLUMN) / 2
        centres = np.column_stack([cells.x, cells.y, base + half])
        sizes = np.column_stack([np.full((len(half), 2), _SHARE * trace.view_cell), half])
        for tile, (places, halves) in cells.split(centres, sizes):
            entity = f"world/obstacles/{tile}"
            if not self._rows.is_styled(entity):
                colour = (*OBSTACLE_COLOUR, 170)
                self._rows.style(entity, rr.Boxes3D, colors=[colour], fill_mode=_SOLID)
            self._rows.log(entity, rr.Boxes3D, centers=places, half_sizes=halves)

    def _log_picture(self, trace: Trace) -> None:
        shades = self._shades(np.nan_to_num(trace.view_height))
        shades[trace.view_kind == UNKNOWN] = _SHADES
        shades[trace.view_kind == OBSTACLE] = _SHADES + 1
        picture = self._colours.take(shades, axis=0)
        self._rows.log(
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

    def _shades(self, height: NDArray[np.float32]) -> NDArray[np.int16]:
        """Return which of the colours heights have, m."""
        low, high = self._range
        share = (height.clip(low, high) - low) / (high - low)
        return (share * (_SHADES - 1) + 0.5).astype(np.int16)

    def _log_route(self, trace: Trace) -> None:
        """Draw path and robot, in the world and over the picture of the map."""
        log = self._rows.log
        parts = legs(trace) if len(trace.path) > 1 else []
        raised = np.column_stack([trace.path, floor_heights(trace) + _PATH_ABOVE])
        colours = [colour for _, colour in parts]
        if self._is_new("path", raised.tobytes() + repr(parts).encode()):
            log(
                "world/path",
                rr.LineStrips3D,
                strips=[raised[leg] for leg, _ in parts],
                colors=colours,
            )
        pixels = self._pixels(trace, trace.path)
        if self._is_new("path's picture", pixels.tobytes() + repr(parts).encode()):
            log(
                "map/floor/path",
                rr.LineStrips2D,
                strips=[pixels[leg] for leg, _ in parts],
                colors=colours,
            )
        here, heading = trace.map_from_robot[:2, 3], trace.map_from_robot[:2, 0]
        arrow = self._pixels(trace, np.array([here, here + 0.25 * heading]))
        log("map/floor/robot", rr.Arrows2D, origins=arrow[:1], vectors=arrow[1:] - arrow[:1])

    @staticmethod
    def _pixels(trace: Trace, points: Floats) -> Floats:
        """Return where points (n, 2) of the map frame are in the picture of the map."""
        at = (points - np.asarray(trace.view_origin)) / trace.view_cell
        pixels: Floats = np.column_stack([at[:, 0], trace.view_kind.shape[0] - at[:, 1]])
        return pixels


def legs(trace: Trace) -> list[tuple[slice, tuple[int, int, int]]]:
    """Return the path's legs in their order: which points, and the colour of walk or climb."""
    parts, at = [], 0
    for first, last in trace.climbs:
        parts += [(slice(at, first + 1), PATH), (slice(first, last + 1), CLIMB)]
        at = last
    parts.append((slice(at, len(trace.path)), PATH))
    return [(leg, colour) for leg, colour in parts if leg.stop - leg.start > 1]


def floor_heights(trace: Trace) -> Floats:
    """Return the floor's height under each point of the path, m; where unknown, that before it."""
    at = np.floor((trace.path - trace.view_origin) / trace.view_cell).astype(np.intp)
    inside = np.asarray(((at >= 0) & (at < trace.view_kind.shape[::-1])).all(axis=1))
    col, row = np.where(inside[:, None], at, 0).T
    known = inside & (trace.view_kind[row, col] == FLOOR)
    heights = np.append(trace.map_from_robot[2, 3], trace.view_height[row, col])
    last: NDArray[np.intp] = np.maximum.accumulate(
        np.append(0, np.where(known, np.arange(len(at)) + 1, 0))
    )
    found: Floats = heights[last[1:]]
    return found


def _format(image: NDArray[np.uint16]) -> rr.components.ImageFormat:
    height, width = image.shape
    return rr.components.ImageFormat(width=width, height=height, channel_datatype="U16")
