"""Depth images of a folder with their poses: in our form, and in that of the TUM benchmark."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.sources import camera_file
from treadwell.sources.camera_file import CameraFile, read_camera
from treadwell.sources.depth_image import SUFFIXES, DepthUnit, read_colour, read_depth
from treadwell.sources.folders import Timed, listed_files, timed_files
from treadwell.sources.frame import Floats, RangeFrame, UnusableError
from treadwell.sources.pose_file import Poses, nearest, read_poses

DEPTH, POSES, COLOUR = "depth", "poses.tum", "color"
TUM_DEPTH, TUM_POSES, TUM_COLOUR = "depth.txt", "groundtruth.txt", "rgb.txt"
_PICTURES: Final = (".png", ".jpg", ".jpeg")


@dataclass(slots=True, eq=False)
class DepthFolder:
    """Depth images, each with the pose that is nearest in time.

    Attributes:
        kind: "depth folder" or "tum".
        path: the folder.
        images: times and files.
        poses: world from camera.
        camera: what sees, and how many units of an integer are a metre.
        camera_path: the file that says so.
        pose_within: s, how far off in time a pose may be.
        colours: times and files of the colour images.
        unused: reason -> count, of the frames so far.
        notes: what was found on the way that its user should know.
    """

    kind: str
    path: Path
    images: list[Timed]
    poses: Poses
    camera: CameraFile
    camera_path: Path
    pose_within: float
    colours: list[Timed] = field(default_factory=list)
    unnamed: int = 0
    unused: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    @property
    def frames(self) -> int:
        """How many images there are."""
        return len(self.images)

    def __iter__(self) -> Iterator[RangeFrame]:
        """Yield the images that have all that is needed.

        Raises:
            InputError: they are of integers, and nothing says what a unit is.
        """
        self.unused.clear()
        self.notes.clear()
        if self.unnamed:
            self.unused["name is no time"] = self.unnamed
        unit = DepthUnit(self.notes)
        times = np.array([time for time, _ in self.colours])
        for time, file in self.images:
            try:
                pose = self.poses.nearest(time, self.pose_within)
                depth = unit.metres(read_depth(file, self.camera, self.camera_path))
            except UnusableError as reason:
                self.unused[str(reason)] += 1
                continue
            colour = self._colour(times, time)
            yield RangeFrame(time, pose, self.camera.camera(), depth, None, "picture", colour)

    def _colour(self, times: Floats, time: float) -> NDArray[np.uint8] | None:
        """Return the colour image of a time; where it cannot be used that is noted once."""
        if not len(times):
            return None
        try:
            number = nearest(times, time, self.pose_within, "colour image")
            return read_colour(self.colours[number][1], (self.camera.height, self.camera.width))
        except UnusableError as reason:
            note = f"some frames are without colour: {reason}"
            if note not in self.notes:
                self.notes.append(note)
            return None


def open_depth_folder(folder: Path, camera: Path | None, pose_within: float) -> DepthFolder:
    """Open a folder with `camera.toml`, `depth/`, `poses.tum` and perhaps `color/`.

    Raises:
        InputError: one of them is missing or wrong.
    """
    camera_path = camera or folder / camera_file.NAME
    told = read_camera(camera_path)
    poses = read_poses(folder / POSES)
    unnamed: Counter[str] = Counter()
    images = timed_files(folder / DEPTH, SUFFIXES, unnamed)
    if not images:
        raise InputError(
            f"{folder / DEPTH}: holds no depth image: wanted are .png of 16 bits, or .npy, "
            "each named by its time in seconds, like 12.5.png"
        )
    colours = timed_files(folder / COLOUR, _PICTURES) if (folder / COLOUR).is_dir() else []
    return DepthFolder(
        "depth folder",
        folder,
        images,
        poses,
        told,
        camera_path,
        pose_within,
        colours,
        unnamed.total(),
    )


def open_tum(folder: Path, camera: Path | None, pose_within: float) -> DepthFolder:
    """Open a folder of the TUM benchmark with a `camera.toml`.

    Raises:
        InputError: a file is missing or wrong.
    """
    camera_path = camera or folder / camera_file.NAME
    told = read_camera(camera_path)
    images = listed_files(folder / TUM_DEPTH)
    if not images:
        raise InputError(f"{folder / TUM_DEPTH}: names not one depth image")
    colours = listed_files(folder / TUM_COLOUR) if (folder / TUM_COLOUR).exists() else []
    poses = read_poses(folder / TUM_POSES)
    return DepthFolder("tum", folder, images, poses, told, camera_path, pose_within, colours)
