"""Which form a stranger's recording has, and the one door to all of them."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, Protocol

from treadwell.errors import InputError
from treadwell.files import opened
from treadwell.recording.cut_off import RESULT
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.trajectory import ESTIMATE
from treadwell.sources import camera_file, depth_folder
from treadwell.sources.bag import open_bag
from treadwell.sources.clouds import OneCloud, has_clouds, is_cloud, open_cloud_folder
from treadwell.sources.depth_folder import open_depth_folder, open_tum
from treadwell.sources.frame import RangeFrame
from treadwell.sources.height_image import open_height_image
from treadwell.sources.landmark_log import has_landmarks
from treadwell.sources.laser_log import is_laser_log, open_laser_log
from treadwell.sources.run import open_run

POSE_WITHIN_S: Final = 0.02
"""How far off in time a frame's pose may be, where nobody says otherwise."""
_WITHOUT_CAMERA_FILE: Final = ("run", "cloud", "cloud folder", "height image", "laser log")
FORMS: Final = (
    "a run's folder with its recording",
    "a folder with camera.toml, depth/ and poses.tum",
    "a folder of the TUM RGB-D benchmark with a camera.toml",
    "a folder of .pcd or .ply clouds with poses.tum",
    "one cloud (.pcd or .ply, also .gz)",
    "a height image (.png with a .toml of its name)",
    "a laser log (CARMEN's FLASER or ROBOTLASER1, g2o's VERTEX2 or VERTEX_SE2 with ROBOTLASER1)",
    "a folder with Odometry.dat, Measurement.dat and Barcodes.dat (ranges and bearings)",
    "an .mcap, or a bag of ROS 1 (.bag) or 2 (a folder with metadata.yaml, or .db3)",
)
"""What a source may be, for messages."""


class Source(Protocol):
    """A recording, opened: iterating reads it from its beginning.

    Attributes:
        kind: "run", "depth folder", "tum", "cloud folder", "cloud", "height image", "laser log",
            "mcap", "ros1 bag" or "ros2 bag".
        path: what was opened.
        unused: reason -> count of the frames that cannot be used; fills as they are read, and is
            emptied when iterating begins anew.
        notes: what was found on the way that its user should know, a sentence each.
    """

    kind: str
    path: Path
    unused: Counter[str]
    notes: list[str]

    @property
    def frames(self) -> int:
        """How many frames there are to come, for progress; 0: not known."""
        ...

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the frames that can be used, in the order in which they lie there.

        Raises:
            InputError: what was not looked at before is broken: the points of one cloud, a file
                that breaks off before its first frame.
        """
        ...


def open_source(
    path: Path,
    *,
    camera: Path | None = None,
    topics: Sequence[str] = (),
    pose_within: float = POSE_WITHIN_S,
) -> Source:
    """Open range data that was recorded elsewhere, or in a run.

    Args:
        path: a file or folder, see `FORMS`.
        camera: a `camera.toml` that takes the place of the source's own.
        topics: of a bag, those to read; none: the only one that has range data.
        pose_within: s, how far off in time a frame's pose may be.

    Raises:
        InputError: it is none of these, or broken; one clear message.
    """
    if not 0.0 <= pose_within < math.inf:
        raise InputError(f"how far off a pose may be: found {pose_within}; must be 0 s or more")
    source = _opened(path, camera, topics, pose_within)
    if camera is not None and source.kind in _WITHOUT_CAMERA_FILE:
        raise InputError(f"--camera: found {camera}; a {source.kind} has no use for it")
    return source


def _opened(path: Path, camera: Path | None, topics: Sequence[str], pose_within: float) -> Source:
    is_run = path.name == OBSERVATIONS
    bag = None if is_run else open_bag(path, camera, topics, pose_within)
    if bag is not None:
        return bag
    if topics:
        raise InputError(f"--topic: found {topics[0]}; {path} is no bag: it has no topics")
    return _folder(path, camera, pose_within) if path.is_dir() else _file(path)


def _folder(path: Path, camera: Path | None, pose_within: float) -> Source:
    def has(name: str) -> bool:
        return (path / name).exists()

    if has(OBSERVATIONS):
        return open_run(path)
    if has(RESULT) and has(ESTIMATE):
        raise InputError(f"{path / OBSERVATIONS}: missing; the run was made without a recording")
    if has(depth_folder.TUM_DEPTH) and has(depth_folder.TUM_POSES):
        return open_tum(path, camera, pose_within)
    if has(depth_folder.DEPTH) or (has(camera_file.NAME) and has(depth_folder.POSES)):
        return open_depth_folder(path, camera, pose_within)
    if has_landmarks(path):
        raise InputError(f"{path}: has no frames, but ranges and bearings to landmarks")
    if has_clouds(path):
        return open_cloud_folder(path, pose_within)
    raise InputError(_none_of_these(path))


def _file(path: Path) -> Source:
    opened(path).close()
    if is_cloud(path):
        return OneCloud(path)
    if path.suffix.lower() == ".png":
        return open_height_image(path)
    if path.name == OBSERVATIONS:
        return open_run(path.parent)
    if is_laser_log(path):
        return open_laser_log(path)
    raise InputError(_none_of_these(path))


def _none_of_these(path: Path) -> str:
    return f"{path}: is none of what a map is made of: {'; '.join(FORMS)}"
