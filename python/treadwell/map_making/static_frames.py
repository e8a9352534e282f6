"""A source's frames without what moved: read twice, since what goes later is a ghost, too."""

import json
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from treadwell._core import MovingFilter
from treadwell.map_making.placing import Placing, ground_below, placing, sensed
from treadwell.map_making.request import MapRequest
from treadwell.sources.frame import RangeFrame
from treadwell.sources.source import Source


class StaticSource:
    """Frames of another source, in which what moved was not seen.

    Pictures and scans are looked through; of clouds it is not known what lies between their points,
    and they stay as they are.

    Attributes:
        kind, path, unused, notes: those of the other source; the last say how much moved.
    """

    def __init__(self, source: Source, request: MapRequest) -> None:
        """Take the frames of a source."""
        self._source, self._request = source, request
        self.kind, self.path = source.kind, source.path
        self.unused, self.notes = source.unused, source.notes

    @property
    def frames(self) -> int:
        """How many frames there are."""
        return self._source.frames

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the frames, each without what moved."""
        are_static, moved = self._are_static()
        kept = iter(are_static)
        for frame in self._source:
            yield frame if frame.layout == "cloud" else without(frame, next(kept))
        if are_static:
            self.notes.append(f"{moved:.1%} of the points moved, or went, and are left out")

    def _are_static(self) -> tuple[list[NDArray[np.bool_]], float]:
        data = self._request.data
        found = MovingFilter(json.dumps(self._request.parameters.get("moving", {})))
        place: Placing | None = None
        seen = []
        for frame in self._source:
            place = place or placing(data.up, frame.world_from_sensor, 1.0)
            insert(found, frame, place, data.columns)
            if frame.layout != "cloud":
                seen.append(valid(frame))
        are_static = found.are_static()
        points = sum(int(some.sum()) for some in seen)
        pairs = zip(seen, are_static, strict=True)
        moved = sum(int((some & ~kept).sum()) for some, kept in pairs)
        return are_static, moved / max(points, 1)


def insert(found: MovingFilter, frame: RangeFrame, place: Placing, columns: int) -> None:
    """Give a filter a frame; clouds are passed over.

    Args:
        found: the filter.
        frame: later than the last.
        place: how the map lies.
        columns: pictures that are wider are looked at in blocks.
    """
    pose = place.pose(frame.world_from_sensor)
    if frame.depth is not None and frame.camera is not None:
        camera = frame.camera
        found.insert_picture(
            frame.time,
            np.ascontiguousarray(frame.depth, np.float32),
            pose,
            focal=(camera.fx, camera.fy),
            centre=(camera.cx, camera.cy),
            ground=ground_below(sensed(frame), pose),
            pool=max(1, -(-camera.width // columns)),
        )
    elif frame.layout == "scan" and frame.points is not None:
        points = frame.points.astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
        found.insert_scan(frame.time, np.ascontiguousarray(points[:, :2]), (pose[0, 3], pose[1, 3]))


def valid(frame: RangeFrame) -> NDArray[np.bool_]:
    """Return where a frame saw something: (h, w) of a picture, (1, n) of a scan."""
    if frame.depth is not None:
        seen: NDArray[np.bool_] = np.isfinite(frame.depth) & (frame.depth > 0)
        return seen
    points = frame.points if frame.points is not None else np.zeros((0, 3), np.float32)
    return np.asarray(np.isfinite(points).all(axis=1), np.bool_)[None]


def without(frame: RangeFrame, kept: NDArray[np.bool_]) -> RangeFrame:
    """Return a frame in which nothing was seen where it is not kept, (h, w) or (1, n)."""
    if frame.depth is not None:
        return replace(frame, depth=np.where(kept, frame.depth, np.float32(np.nan)))
    if frame.points is None:
        return frame
    return replace(frame, points=np.where(kept[0][:, None], frame.points, np.float32(np.nan)))
