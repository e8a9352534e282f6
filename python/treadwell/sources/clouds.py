"""One cloud of a file, or a folder of clouds in the sensor's frame with their poses."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from treadwell.errors import InputError
from treadwell.sources.cloud_table import LARGEST_FILE, Cloud
from treadwell.sources.folders import Timed, files_in, stem, timed_files
from treadwell.sources.frame import Floats, RangeFrame, UnusableError, translation
from treadwell.sources.packed import unpacked
from treadwell.sources.pcd import read_pcd
from treadwell.sources.ply import read_ply
from treadwell.sources.pose_file import Poses, pose_of, read_poses

SUFFIXES: Final = (".pcd", ".ply", ".pcd.gz", ".ply.gz")
POSES: Final = "poses.tum"
MOST_NOTES: Final = 10
"""Of broken files, with their names."""
FARTHEST_SENSOR_M: Final = 10_000.0
"""From the middle of its points: so far off, 32 bits keep a millimetre."""


def read_cloud(path: Path) -> Cloud:
    """Read a cloud; whether PCD or PLY is told by the file's name.

    Raises:
        InputError: it is missing or broken, or has no or too many points.
    """
    name = stem(path, (".gz",)) or path.name
    with unpacked(path, LARGEST_FILE) as content:
        return read_ply(content) if name.lower().endswith(".ply") else read_pcd(content)


def is_cloud(path: Path) -> bool:
    """Whether a file is named like a cloud."""
    return stem(path, SUFFIXES) is not None


def has_clouds(folder: Path) -> bool:
    """Whether a folder holds files that are named like clouds."""
    return any(is_cloud(path) for path in files_in(folder))


def around_its_middle(cloud: Cloud, time: float, notes: list[str]) -> RangeFrame | None:
    """Return a cloud that stands in the world as written; None: it has no point.

    Where its sensor was it may say itself. Else its points are relative to their middle, rounded to
    metres: coordinates of millions of metres keep what 64 bits have of them.

    Args:
        cloud: points in the world.
        time: s.
        notes: what its user should know.
    """
    seen = np.isfinite(cloud.points[:, 0])
    if not seen.any():
        return None
    middle = np.round(np.median(cloud.points[seen], axis=0)) + 0.0
    pose, known = translation(middle), False
    if cloud.viewpoint is not None:
        sensor = pose_of(np.array(cloud.viewpoint))
        away = float(np.linalg.norm(sensor[:3, 3] - middle))
        if away <= FARTHEST_SENSOR_M:
            pose, known = sensor, True
        else:
            notes.append(f"VIEWPOINT lies {away:.4g} m from the points and is passed over")
    points = _seen_from(pose, cloud.points).astype(np.float32)
    return RangeFrame(time, pose, None, None, points, "cloud", cloud.colour, known)


def _seen_from(pose: Floats, points: Floats) -> Floats:
    away: Floats = points - pose[:3, 3]
    turn = pose[:3, :3]
    return away if np.array_equal(turn, np.eye(3)) else away @ turn


@dataclass(slots=True, eq=False)
class OneCloud:
    """A file with one cloud.

    Attributes:
        path: the file.
        kind: "cloud".
        frames: one.
        unused: reason -> count.
        notes: what its user should know.
    """

    path: Path
    kind: str = "cloud"
    frames: int = 1
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the cloud.

        Raises:
            InputError: it is broken, or has no or too many points.
        """
        cloud = read_cloud(self.path)
        self.notes[:] = cloud.notes
        frame = around_its_middle(cloud, 0.0, self.notes)
        if frame is None:
            raise InputError(f"{self.path}: holds not one point whose coordinates are finite")
        if not frame.origin_known:
            self.notes.append("the file does not say where the sensor was")
        yield frame


@dataclass(slots=True, eq=False)
class CloudFolder:
    """Clouds in the sensor's frame, each with the pose that is nearest in time.

    Attributes:
        path: the folder.
        clouds: times and files.
        poses: world from sensor.
        pose_within: s, how far off in time a pose may be.
        unnamed: files whose name is no time.
        kind: "cloud folder".
        unused: reason -> count, of the frames so far.
        notes: what its user should know.
    """

    path: Path
    clouds: list[Timed]
    poses: Poses
    pose_within: float
    unnamed: int = 0
    kind: str = "cloud folder"
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    @property
    def frames(self) -> int:
        """How many clouds there are."""
        return len(self.clouds)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the clouds that have all that is needed."""
        self.unused.clear()
        self.notes.clear()
        if self.unnamed:
            self.unused["name is no time"] = self.unnamed
        for time, path in self.clouds:
            try:
                pose = self.poses.nearest(time, self.pose_within)
                yield self._frame(time, path, pose)
            except UnusableError as reason:
                self.unused[str(reason)] += 1

    def _frame(self, time: float, path: Path, pose: Floats) -> RangeFrame:
        try:
            cloud = read_cloud(path)
        except InputError as error:
            if len(self.notes) < MOST_NOTES:
                self.notes.append(str(error))
            raise UnusableError("cloud that cannot be read") from None
        points = cloud.points.astype(np.float32)
        # Nothing is seen in the sensor itself: some drivers write that for no answer.
        points[~points.any(axis=1)] = np.nan
        if np.isnan(points[:, 0]).all():
            raise UnusableError("no point")
        return RangeFrame(time, pose, None, None, points, "cloud", cloud.colour)


def open_cloud_folder(folder: Path, pose_within: float) -> CloudFolder:
    """Open a folder of clouds with `poses.tum`.

    Raises:
        InputError: there are no poses, or no cloud whose name is its time.
    """
    poses = read_poses(folder / POSES)
    unnamed: Counter[str] = Counter()
    clouds = timed_files(folder, SUFFIXES, unnamed)
    if not clouds:
        raise InputError(f"{folder}: holds not one cloud whose name is its time, like 12.5.pcd")
    return CloudFolder(folder, clouds, poses, pose_within, unnamed.total())
