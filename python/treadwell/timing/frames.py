"""Depth images with the camera's poses, and the files in which other mappers read them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.files import read_content

MAGIC: Final = b"DFR1"
_HEADER: Final = 32
_LARGEST: Final = 4_000_000_000
"""Bytes: an hour of small frames, or a thousand of 640x480 pixels."""
"""Bytes."""


@dataclass(frozen=True)
class Frames:
    """Depth images of one camera."""

    name: str
    focal: tuple[float, float]
    """Pixels, along columns and rows."""
    centre: tuple[float, float]
    """Where the axis meets the image, pixels."""
    depth: NDArray[np.float32]
    """(n, h, w) m along the axis; 0 where nothing was seen."""
    rotation: NDArray[np.float64]
    """(n, 3, 3): from the camera's frame (x right, y down) to the world's."""
    position: NDArray[np.float64]
    """(n, 3) m."""

    @property
    def shape(self) -> str:
        """Width and height as one writes them."""
        return f"{self.depth.shape[2]}x{self.depth.shape[1]}"

    def directions(self) -> NDArray[np.float64]:
        """Return (h, w, 3): each pixel's point at a depth of 1, in the camera's frame."""
        _, height, width = self.depth.shape
        across, down = np.meshgrid(
            (np.arange(width) - self.centre[0]) / self.focal[0],
            (np.arange(height) - self.centre[1]) / self.focal[1],
        )
        return np.stack([across, down, np.ones_like(across)], axis=-1)

    def points(self, index: int) -> NDArray[np.float64]:
        """Return (pixels seen, 3) m: a frame's points in the world.

        Args:
            index: of the frame.
        """
        picture = self.picture(index)
        return np.ascontiguousarray(picture[np.isfinite(picture[..., 0])])

    def picture(self, index: int) -> NDArray[np.float64]:
        """Return (h, w, 3) m: each pixel's point in the world, NaN where nothing was seen.

        Args:
            index: of the frame.
        """
        depth = self.depth[index].astype(np.float64)
        local = self.directions() * np.where(depth > 0.0, depth, np.nan)[..., None]
        return np.ascontiguousarray(local @ self.rotation[index].T + self.position[index])

    def camera(self, index: int) -> NDArray[np.float64]:
        """Return (4, 4): from the camera's frame to the world's.

        Args:
            index: of the frame.
        """
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = self.rotation[index], self.position[index]
        return pose


def read_frames(path: Path) -> Frames:
    """Read a file of depth frames.

    "DFR1"; width, height, frames as int32; fx, fy, cx, cy as float32; then for each frame the
    rotation (9), the position (3) and the depths as float32; all little-endian.

    Args:
        path: of the file.

    Raises:
        InputError: it cannot be read, or is no such file.
    """
    data = read_content(path, _LARGEST)
    if data[:4] != MAGIC or len(data) < _HEADER:
        raise InputError(f"{path}: depth frames begin with {MAGIC.decode()}")
    width, height, count = (int(n) for n in np.frombuffer(data, "<i4", 3, 4))
    values = 12 + width * height
    if min(width, height, count) < 1 or len(data) != _HEADER + 4 * count * values:
        raise InputError(
            f"{path}: {count} frames of {width}x{height} pixels do not fill its {len(data)} bytes"
        )
    fx, fy, cx, cy = (float(value) for value in np.frombuffer(data, "<f4", 4, 16))
    rows = np.frombuffer(data, "<f4", count * values, _HEADER).reshape(count, values)
    if not np.isfinite(rows).all() or min(fx, fy) <= 0.0:
        raise InputError(f"{path}: all numbers must be finite, focal lengths > 0")
    return Frames(
        name=path.stem,
        focal=(fx, fy),
        centre=(cx, cy),
        depth=np.ascontiguousarray(rows[:, 12:].reshape(count, height, width)),
        rotation=rows[:, :9].reshape(count, 3, 3).astype(np.float64),
        position=rows[:, 9:12].astype(np.float64),
    )


def write_frames(frames: Frames, path: Path) -> None:
    """Write a file that `read_frames` and other mappers' benches read.

    Args:
        frames: what to write.
        path: of the file.
    """
    count, height, width = frames.depth.shape
    rows = np.concatenate(
        [frames.rotation.reshape(count, 9), frames.position, frames.depth.reshape(count, -1)],
        axis=1,
    )
    with path.open("wb") as file:
        file.write(MAGIC)
        file.write(np.array([width, height, count], "<i4").tobytes())
        file.write(np.array([*frames.focal, *frames.centre], "<f4").tobytes())
        file.write(rows.astype("<f4").tobytes())
