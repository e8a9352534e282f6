"""The points that a run saw, where the robot believed them to be: out of `recording.rrd`.

The recording has of each camera frame some two thousand pixels, evenly out of all, in the map
frame, and the camera's pose.
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.recording.file import NAME

_POINTS, _CAMERA = "/world/points", "/world/camera"


@dataclass(frozen=True, slots=True, eq=False)
class SeenPoints:
    """What one camera frame saw.

    Attributes:
        time_ns: nanoseconds since the start.
        points: (n, 3) m, map frame.
        map_from_camera: (4, 4) as the robot believed it.
    """

    time_ns: int
    points: NDArray[np.float64]
    map_from_camera: NDArray[np.float64]


def seen_points(folder: Path) -> Iterator[SeenPoints]:
    """Yield what a run's camera frames saw, in order.

    Raises:
        InputError: the recording is missing or broken.
    """
    points, cameras = _read(folder / NAME, (_POINTS, _CAMERA))
    for time_ns in sorted(points.keys() & cameras.keys()):
        yield SeenPoints(time_ns, points[time_ns], cameras[time_ns])


def camera_poses(folder: Path) -> dict[int, NDArray[np.float64]]:
    """Return where the camera of a run was, as the robot believed it, by the frame's arrival in ns.

    Returns:
        map_from_camera, (4, 4) each.

    Raises:
        InputError: the recording is missing or broken.
    """
    return _read(folder / NAME, (_CAMERA,))[1]


def _read(
    path: Path, wanted: Sequence[str]
) -> tuple[dict[int, NDArray[np.float64]], dict[int, NDArray[np.float64]]]:
    if not path.is_file():
        raise InputError(f"{path}: there is no recording; the run was made without one")
    from rerun.chunk import RrdReader
    from rerun.error_utils import RerunWarning

    points: dict[int, NDArray[np.float64]] = {}
    cameras: dict[int, NDArray[np.float64]] = {}
    try:
        with warnings.catch_warnings():
            # Of no table of contents: all of it is read anyway.
            warnings.simplefilter("ignore", RerunWarning)
            stream = RrdReader(str(path)).stream()
        for chunk in stream.to_chunks():
            entity = str(chunk.entity_path)
            if entity not in wanted or chunk.is_static:
                continue
            table = chunk.to_record_batch()
            times = table.column("time").cast("int64").to_pylist()
            if entity == _POINTS:
                points |= zip(times, _lists(table, "Points3D:positions", 3), strict=True)
            else:
                places = _lists(table, "Transform3D:translation", 3)
                turns = _lists(table, "Transform3D:mat3x3", 9)
                for time_ns, place, turn in zip(times, places, turns, strict=True):
                    if len(place) and len(turn):
                        cameras[time_ns] = _pose(place[0], turn[0])
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: breaks off or is no recording: {_one_line(error)}") from None
    return points, cameras


def _lists(table: Any, name: str, width: int) -> list[NDArray[np.float64]]:  # noqa: ANN401
    """Return a column's rows, (n, width) each; its lists are laid out one behind the other."""
    column = table.column(name)
    ends = column.offsets.to_numpy()
    flat = column.values.flatten().to_numpy(zero_copy_only=False).reshape(-1, width)
    return [np.array(flat[begin:end], np.float64) for begin, end in pairwise(ends)]


def _pose(place: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    pose = np.eye(4)
    pose[:3, 3] = place
    pose[:3, :3] = turn.reshape(3, 3).T  # rerun keeps matrices column by column
    return pose


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:300]
