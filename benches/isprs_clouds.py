"""Airborne laser clouds with the true ground: `isprs_ground_filter` of `TREADWELL_DATA`.

Sithole and Vosselman, ISPRS Journal 59 (2004); points as PCD in UTM zone 32U.
"""

import gzip
import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pypcd4 import PointCloud


def read(path: Path) -> NDArray[np.float64]:
    """Return the points of a packed PCD file, (n, 3) m."""
    with gzip.open(path) as file:
        cloud = PointCloud.from_fileobj(io.BytesIO(file.read()))
    return cloud.numpy(("x", "y", "z")).astype(np.float64)


def samples(data: Path) -> list[str]:
    """Return the names of the samples that are there, as in `samp11`."""
    folder = data / "isprs_ground_filter"
    ending = "-utm-ground.pcd.gz"
    return sorted(path.name.removesuffix(ending) for path in folder.glob(f"*{ending}"))


def sample(data: Path, name: str) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return a sample's points, (n, 3) m, and which of them are ground, (n,)."""
    folder = data / "isprs_ground_filter"
    points = read(folder / f"{name}-utm.pcd.gz")
    ground = read(folder / f"{name}-utm-ground.pcd.gz")
    found, counts = np.unique(ground, axis=0, return_counts=True)
    left = dict(zip(map(tuple, found), counts, strict=True))
    truth = np.zeros(len(points), bool)
    for index, point in enumerate(map(tuple, points)):
        if left.get(point, 0) > 0:
            truth[index] = True
            left[point] -= 1
    return points, truth


def errors(truth: NDArray[np.bool_], found: NDArray[np.bool_]) -> dict[str, float]:
    """Return type I (ground missed), type II (objects taken for ground) and total error, %."""
    return {
        "type I": 100.0 * float((truth & ~found).sum() / truth.sum()),
        "type II": 100.0 * float((~truth & found).sum() / (~truth).sum()),
        "total": 100.0 * float((truth != found).mean()),
    }
