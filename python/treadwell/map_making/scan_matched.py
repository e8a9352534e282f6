"""Scans of a laser placed by what they see: their poses are taken as odometry."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from treadwell._core import ScanSlam
from treadwell.errors import InputError
from treadwell.map_making.made import FrameProgress
from treadwell.map_making.request import SLAM_TABLES, MapRequest
from treadwell.map_result import MappedMatching
from treadwell.poses import pose_matrix
from treadwell.sources.frame import Floats, RangeFrame
from treadwell.sources.source import Source

SCAN: Final = "scan"


class MatchedScans:
    """A source of scans whose poses are corrected: read once to find them, and again to map.

    Attributes:
        kind: the source's.
        path: the source's.
        unused: the source's: reason -> count.
        notes: the source's, and what became of the scans.
        matching: local maps, loops, and scans that fit nowhere.
    """

    def __init__(
        self, source: Source, request: MapRequest, progress: FrameProgress | None = None
    ) -> None:
        """Find where the scans were taken.

        Args:
            source: its frames' poses count as odometry: the steps from one to the next.
            request: has the settings of `[plan_view]`.
            progress: is told how it gets on.

        Raises:
            InputError: the source has other frames than scans, or a setting cannot be used.
        """
        if request.data.up != "z":
            raise InputError(
                f"--set map.up: found {request.data.up}; must be z with --localizer "
                f"{request.localizer}, which moves scans in the plane of x and y"
            )
        self._source = source
        self.kind, self.path = source.kind, source.path
        self.notes, self.unused = source.notes, source.unused
        tables = {name: request.plan_view[name] for name in SLAM_TABLES}
        core = ScanSlam(json.dumps(tables))
        self._odometry: list[Floats] = []
        for number, frame in enumerate(source):
            if frame.layout != SCAN or frame.points is None:
                raise InputError(
                    f"--localizer: found {request.localizer}, which places the scans of a laser "
                    f"that sweeps a plane; {source.path} ({source.kind}) has others: without it, "
                    "or with truth, poses are taken as they are"
                )
            pose = planar(frame.world_from_sensor)
            self._odometry.append(pose)
            points = np.ascontiguousarray(frame.points[:, :2], np.float64)
            core.insert(points, (float(pose[0]), float(pose[1]), float(pose[2])))
            if progress is not None:
                progress.update(number + 1, max(source.frames, number + 1), number + 1)
        core.finish()
        self._poses = core.poses()
        maps, loops, unmatched = core.counts()
        moved = np.hypot(*(self._poses - np.array(self._odometry).reshape(-1, 3))[:, :2].T)
        self.matching = MappedMatching(
            local_maps=maps,
            loops_closed=loops,
            unmatched=unmatched,
            moved=float(moved.mean()) if len(moved) else 0.0,
        )

    @property
    def frames(self) -> int:
        """How many frames there are to come."""
        return self._source.frames

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the scans where they were taken; height and tilt stay the source's."""
        for frame, odometry, pose in zip(self._source, self._odometry, self._poses, strict=False):
            by = _matrix(pose) @ np.linalg.inv(_matrix(odometry))
            yield replace(frame, world_from_sensor=by @ frame.world_from_sensor)


def planar(pose: Floats) -> Floats:
    """Return x, y, m, and yaw, rad, of a pose (4, 4)."""
    return np.array([pose[0, 3], pose[1, 3], np.arctan2(pose[1, 0], pose[0, 0])])


def _matrix(pose: Floats) -> Floats:
    x, y, yaw = (float(part) for part in pose)
    return pose_matrix(x, y, 0.0, yaw)


def no_scans(localizer: str, source: Path) -> InputError:
    """Return what is said of ranges and bearings, which are no scans."""
    return InputError(
        f"--localizer: found {localizer}, which places the scans of a laser that sweeps a plane; "
        f"{source} has ranges and bearings, of which landmarks are made"
    )
