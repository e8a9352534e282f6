"""Depth images that others took, with what is truly there: folders of `TREADWELL_DATA`.

| folder | image | truth |
| --- | --- | --- |
| `mosd_labelled_kinect` | five of a Kinect, 640 x 480, things on a table | the table |
| `synpeb_plane_gt` | a simulated scan, 100 x 100, 14 x 12 degrees | each pixel's plane |
| `cape_kinect_depth` | a Kinect's, 640 x 480, a room | none |

Nothing of them is kept here: `python benches/real_data.py` says what was found in them.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from pypcd4 import PointCloud

from treadwell.senses.depth import Cast, Pinhole
from treadwell.senses.stereo import StereoConfig, StereoModel

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

ROBOT_EYE = Pinhole(88, 72, 101.2)
"""The robot's camera."""
BASELINE = 0.06
"""Metres between its eyes."""


@dataclass(frozen=True)
class RealFrame:
    """A depth image and what it shows.

    Attributes:
        depth: (h, w) metres along the optical axis, NaN for not seen.
        truth: (h, w) plane of each pixel, from 1 on; 0 for none, below 0 where nobody knows.
        pinhole: the camera.
        baseline: metres between its eyes, or what makes its errors those of disparities.
    """

    depth: Floats
    truth: Ids
    pinhole: Pinhole
    baseline: float


TABLES = ("learn0", "learn1", "learn2", "learn3", "test1")
"""The labelled Kinect clouds."""


def labelled_table(data: Path, name: str = "test1") -> RealFrame:
    """Return a labelled Kinect cloud: 1 is the table, 0 what stands on it."""
    cloud = PointCloud.from_path(data / "mosd_labelled_kinect" / f"{name}.pcd")
    depth = cloud.numpy(("z",)).reshape(480, 640).astype(np.float64)
    label = cloud.numpy(("label",)).reshape(480, 640).astype(np.int64)
    truth = np.where(label == 0, -1, (label < 10).astype(np.int64))
    return RealFrame(depth, truth, Pinhole(640, 480, 525.0), BASELINE)


def room(data: Path) -> RealFrame:
    """Return the room: the calibration's focal length, with the axis put into the middle."""
    path = data / "cape_kinect_depth"
    millimetres = np.asarray(Image.open(path / "depth_0.png"), np.float64)
    depth = np.where(millimetres > 0.0, 1e-3 * millimetres, np.nan)
    truth = np.full(depth.shape, -1)
    return RealFrame(depth, truth, Pinhole(640, 480, 576.2), BASELINE)


FIRST_PLANE = 10
SCAN_SIZE = 100
# Its pixels are as large as the scan's in the mean; it sees all of the scan, and has empty corners.
SCAN_EYE = (112, 106, 445.0)


def simulated_scan(data: Path) -> RealFrame:
    """Return the simulated scan as a pinhole camera of the same pixels would have taken it.

    Its directions are a lattice of azimuths and elevations. A pixel takes 1 / depth, which is
    affine over a plane, from the four directions around it; from the nearest one at jumps.
    """
    cloud = PointCloud.from_path(data / "synpeb_plane_gt" / "test_100.pcd")
    points = cloud.numpy(("x", "y", "z")).astype(np.float64)
    planes = cloud.numpy(("intensity",)).reshape(SCAN_SIZE, SCAN_SIZE).astype(np.int64)
    azimuth = np.arctan2(points[:, 1], points[:, 0]).reshape(SCAN_SIZE, SCAN_SIZE)[0]
    distance = np.linalg.norm(points, axis=1)
    elevation = np.arcsin(points[:, 2] / distance).reshape(SCAN_SIZE, SCAN_SIZE)[:, 0]
    middle_azimuth, middle_elevation = azimuth[[0, -1]].mean(), elevation[[0, -1]].mean()
    scan_from_camera = _looking_along(middle_azimuth, middle_elevation)
    pinhole = Pinhole(*SCAN_EYE)
    rays = pinhole.directions() @ scan_from_camera.T
    ray_azimuth = np.arctan2(rays[:, 1], rays[:, 0])
    ray_elevation = np.arcsin(rays[:, 2] / np.linalg.norm(rays, axis=1))
    last = SCAN_SIZE - 1
    column = (ray_azimuth - azimuth[0]) / (azimuth[-1] - azimuth[0]) * last
    row = (ray_elevation - elevation[0]) / (elevation[-1] - elevation[0]) * last
    nearness = (1.0 / (points @ scan_from_camera[:, 2])).reshape(SCAN_SIZE, SCAN_SIZE)
    inside = (column >= 0) & (column <= last) & (row >= 0) & (row <= last)
    value, nearest = _between(nearness, row, column)
    ids = planes.reshape(-1)[nearest]
    ids = np.where(ids >= FIRST_PLANE, ids, 0)
    shape = (pinhole.height, pinhole.width)
    return RealFrame(
        np.where(inside, 1.0 / value, np.nan).reshape(shape),
        np.where(inside, ids, -1).reshape(shape),
        pinhole,
        SCAN_BASELINE,
    )


# The scanner measures distances: eyes so far apart turn its errors into some hundredths of a pixel.
SCAN_BASELINE = 0.25
JUMP = 0.01


def _looking_along(azimuth: float, elevation: float) -> Floats:
    """Return the scan from a camera that looks there: x to the right, y down, z ahead."""
    ahead = np.array(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    right = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
    return np.column_stack([right, np.cross(ahead, right), ahead])


def _between(image: Floats, row: Floats, column: Floats) -> tuple[Floats, Ids]:
    """Return the bilinear values at places of an image, and the indices of the nearest pixels."""
    height, width = image.shape
    row, column = np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)
    top = np.clip(np.floor(row).astype(np.int64), 0, height - 2)
    left = np.clip(np.floor(column).astype(np.int64), 0, width - 2)
    down, along = row - top, column - left
    corners = np.stack([image[top + i, left + j] for i in (0, 1) for j in (0, 1)])
    weights = np.stack(
        [(1 - down) * (1 - along), (1 - down) * along, down * (1 - along), down * along]
    )
    nearest = np.rint(row).astype(np.int64) * width + np.rint(column).astype(np.int64)
    smooth = np.ptp(corners, axis=0) < JUMP * corners.mean(axis=0)
    return np.where(smooth, (weights * corners).sum(axis=0), image.reshape(-1)[nearest]), nearest


def through_stereo(frame: RealFrame, seed: int, pinhole: Pinhole = ROBOT_EYE) -> RealFrame:
    """Return what the robot's stereo camera would measure in the frame's place.

    Args:
        frame: what is there.
        seed: of the noise.
        pinhole: the robot's camera; the frame's own field of view where its focal length says so.
    """
    source = frame.pinhole
    rays = pinhole.directions()
    column = rays[:, 0] * source.focal + (source.width - 1) / 2
    row = rays[:, 1] * source.focal + (source.height - 1) / 2
    at_column, at_row = np.rint(column).astype(np.int64), np.rint(row).astype(np.int64)
    inside = (
        (at_column >= 0) & (at_column < source.width) & (at_row >= 0) & (at_row < source.height)
    )
    at = np.where(inside, at_row * source.width + at_column, 0)
    shape = (pinhole.height, pinhole.width)
    depth = np.where(inside, frame.depth.reshape(-1)[at], np.nan).reshape(shape)
    truth = np.where(inside, frame.truth.reshape(-1)[at], -1).reshape(shape)
    geom = np.where(np.isfinite(depth), 0, -1).astype(np.int32)
    model = StereoModel(
        StereoConfig(frame.baseline),
        pinhole,
        np.ones(1),
        np.random.default_rng([seed, 0]),
        np.random.default_rng([seed, 1]),
    )
    seen = model.see(Cast(depth, geom, np.zeros(3), np.eye(3)))
    return replace(frame, depth=seen.astype(np.float64), truth=truth, pinhole=pinhole)
