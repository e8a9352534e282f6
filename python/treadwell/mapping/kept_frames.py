"""What became of the frames of a map of one's own, and what is kept of them to be looked at."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import FloorView, Planes, RangeMap
from treadwell.errors import InputError
from treadwell.map_making.made import writing
from treadwell.map_making.mapper import placed_cubes, placed_map
from treadwell.map_making.recording import MapRecording
from treadwell.map_memory import MapMemory, RememberedMap
from treadwell.recording.mesh_file import SurfaceMesh
from treadwell.sources.frame import Floats

_MOST: Final = 500
"""Frames whose points are kept, evenly out of all: 4000 points each, 24 MB."""


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What became of one frame.

    Attributes:
        used: whether the map took it in.
        reason: why it was not used, or why nothing came of it; None where all is well.
        planes: the surfaces that were found in a picture, heights above the lowest ground in it;
            None of a cloud, and of a world model that has no use for surfaces.
    """

    used: bool
    reason: str | None
    planes: Planes | None


class KeptFrames:
    """Keeps what the map last said of each cell, where the sensor was, and some points of frames.

    Attributes:
        taken: frames that there were, used or not.
        poses: (4, 4) map from sensor, of each that was used.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.taken = 0
        self.poses: list[Floats] = []
        self._memory = MapMemory()
        self._frames: list[tuple[float, Floats, NDArray[np.float32]]] = []
        self._every = 1

    def insert(
        self, time: float, pose: Floats, points: NDArray[np.float32], view: FloorView
    ) -> None:
        """Take in a frame that was used.

        Args:
            time: s.
            pose: (4, 4) map from sensor.
            points: (n, 3) m, some of those that it saw, in the sensor's frame.
            view: the map after it.
        """
        self._memory.update(view.origin, view.cell, view.kind, view.height, view.sightings)
        if len(self.poses) % self._every == 0:
            self._frames.append((time, pose, points))
        self.poses.append(pose)
        if len(self._frames) > _MOST:
            # Those that are left are as far apart in the data as those to come.
            self._frames, self._every = self._frames[::2], 2 * self._every

    def map(self, offset: Floats) -> RememberedMap:
        """Return what was last known of each cell, in the world whose z is up."""
        return placed_map(self._memory.map(), offset)

    def draw(self, path: Path, title: str, offset: Floats) -> None:
        """Draw the map from above, with the way of the sensor, as a PNG file.

        Raises:
            InputError: the path ends otherwise than a PNG file.
            RecordingError: the file cannot be written.
        """
        _check_ending("save_picture", path, ".png")
        # Late: matplotlib takes its time.
        from treadwell.map_making.picture import draw_map

        way = np.array([pose[:2, 3] for pose in self.poses]) + offset[:2]
        with writing(path):
            draw_map(path, title, self.map(offset), way)

    def record(self, path: Path, name: str, core: RangeMap, offset: Floats) -> None:
        """Write the frames and the map as a recording of rerun.

        Args:
            path: of the file.
            name: what was mapped.
            core: the map, for its cubes or its surface.
            offset: (3,) m, its origin in the world.

        Raises:
            InputError: the path ends otherwise than a recording.
            RecordingError: the file cannot be written.
        """
        _check_ending("save_recording", path, ".rrd")
        found, surface = self.map(offset), core.surface()
        with writing(path):
            recording = MapRecording(path, name, found.cell)
            for time, pose, points in self._frames:
                recording.frame(time, pose, points)
            if surface is not None:
                corners = (surface[0] + offset).astype(np.float32)
                recording.surface(SurfaceMesh(corners, surface[1]), offset)
            recording.finish(found, offset, placed_cubes(core, offset))


def _check_ending(asked: str, path: Path, ending: str) -> None:
    """Refuse a file whose name says that something else is in it."""
    if path.suffix.lower() != ending:
        raise InputError(f"Map.{asked}: found {path}; must end with {ending}")
