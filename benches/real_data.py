"""What the segmenters find in depth images that others took.

`python benches/real_data.py [--data FOLDER]`

One line of JSON a row; `FOLDER` is `TREADWELL_DATA` unless given. No image is kept here.
"""

import argparse
import json
import math
import os
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from itertools import islice
from pathlib import Path

import numpy as np
from into_results import add_options, write
from numpy.typing import NDArray
from real_data_cells import results_table
from real_frames import TABLES, RealFrame, labelled_table, room, simulated_scan, through_stereo

from treadwell._core import Planes, Segmenter
from treadwell.components import COMPONENTS
from treadwell.measuring.regions import RegionCounts, compare_regions
from treadwell.senses.depth import Pinhole

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Settings = dict[str, dict[str, float]]

SEGMENTERS = tuple(COMPONENTS["segmenter"])
STEREO_SEEDS = range(6)
LEAST_PIXELS = 100

# Errors of a Kinect that its neighbours share (it is bent by millimetres) count as noise here, too.
KINECT: Settings = {"ground": {"noise_floor": 0.25}}
# A scanner's pixels err on their own: scan lines may be thin. Its noise is 60 times as large on
# steep surfaces as on others.
SCANNER: Settings = {
    "ground": {"noise_floor": 0.02, "noise_ceiling": 16.0},
    "scan_line_adaptive": {"strip": 2, "alike": 9.0, "uneven": 0.1},
    "scan_line_1994": {"strip": 4, "split": 0.05, "accept": 0.1},
    "ransac": {"accept": 0.1},
    "hough": {"accept": 0.1},
}
ROBOT: Settings = {}

LENGTHWISE = np.array(
    [[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]]
)
"""A camera 1 m above the robot that looks ahead: for frames without a floor."""


def segment(name: str, frame: RealFrame, settings: Settings, robot_from_camera: Floats) -> Planes:
    """Return what a segmenter that has seen nothing before finds in a frame."""
    pinhole = frame.pinhole
    segmenter = Segmenter(
        name,
        width=pinhole.width,
        height=pinhole.height,
        focal=pinhole.focal,
        baseline=frame.baseline,
        settings=json.dumps(settings),
    )
    return segmenter.segment(frame.depth.astype(np.float32), robot_from_camera)


def points_of(frame: RealFrame) -> Floats:
    """Return (h * w, 3) metres, camera's frame, NaN for not seen."""
    return frame.pinhole.directions() * frame.depth.reshape(-1, 1)


def ransac_plane(
    points: Floats, threshold: float = 0.01, rounds: int = 300
) -> tuple[Floats, float]:
    """Return normal (towards the camera) and distance of the plane that explains most points."""
    random = np.random.default_rng(0)
    best, normal, distance = 0, np.zeros(3), 0.0
    some = points[:: max(1, len(points) // 5000)]
    for _ in range(rounds):
        a, b, c = some[random.choice(len(some), 3, replace=False)]
        n = np.cross(b - a, c - a)
        if np.linalg.norm(n) == 0.0:
            continue
        n /= np.linalg.norm(n)
        count = int((np.abs((some - a) @ n) < threshold).sum())
        if count > best:
            best, normal = count, -n * np.sign(n @ a)
            distance = -float(normal @ a)
    close = points[np.abs(points @ normal + distance) < threshold]
    middle = close.mean(axis=0)
    scatter = (close - middle).T @ (close - middle)
    fitted = np.linalg.eigh(scatter)[1][:, 0]
    fitted *= -np.sign(fitted @ middle)
    return fitted, -float(fitted @ middle)


def pose_above(normal: Floats, height: float, turn: Floats, rise: float) -> Floats:
    """Return where the camera over a plane is believed to be: turned (rad) and raised (m)."""
    ahead = np.array([0.0, 0.0, 1.0]) - normal[2] * normal
    ahead /= np.linalg.norm(ahead)
    pose = np.eye(4)
    pose[:3, :3] = _rotation(turn) @ np.stack([ahead, np.cross(normal, ahead), normal])
    pose[2, 3] = height + rise
    return pose


def _rotation(turn: Floats) -> Floats:
    angle = float(np.linalg.norm(turn))
    x, y, z = turn / angle
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * skew @ skew


# 5 degrees and 10 mm: the search's gate is 7 degrees and 20 mm.
WRONG_TURN = np.radians([-3.0, 4.0, 0.0])
WRONG_RISE = -0.01


def table_pose(frame: RealFrame) -> Floats:
    """Return the pose that the robot is told: of the plane that RANSAC finds, and wrong."""
    points = points_of(frame)
    normal, height = ransac_plane(points[np.isfinite(points[:, 2])])
    return pose_above(normal, height, WRONG_TURN, WRONG_RISE)


def intersection_over_union(truth: Mask, found: Mask, counted: Mask) -> float:
    """Return the share that both have of what either has."""
    return float((truth & found & counted).sum() / ((truth | found) & counted).sum())


def away_from_borders(frame: RealFrame, pixels: int) -> Mask:
    """Return the pixels that have no pixel of another label within so many rows and columns."""
    away = np.ones(frame.truth.shape, np.bool_)
    for rows in range(-pixels, pixels + 1):
        for columns in range(-pixels, pixels + 1):
            other = np.roll(frame.truth, (rows, columns), (0, 1))
            away &= (other < 0) | (frame.truth < 0) | (other == frame.truth)
    return away


def support_plane(
    name: str, frame: RealFrame, settings: Settings, pose: Floats
) -> tuple[float, float]:
    """Return the support plane's IoU over what is seen, and over what is 2 px from other labels."""
    planes = segment(name, frame, settings, pose)
    labels = planes.labels.reshape(frame.truth.shape)
    found = (
        labels == planes.ground + 1
        if planes.ground is not None
        else np.zeros_like(labels, np.bool_)
    )
    seen = np.isfinite(frame.depth) & (frame.truth >= 0)
    table = frame.truth == 1
    inner = seen & away_from_borders(frame, 2)
    return (
        intersection_over_union(table, found, seen),
        intersection_over_union(table, found, inner),
    )


def ransac_alone(frame: RealFrame) -> float:
    """Return the support plane's IoU by one plane within 10 mm, the yardstick of the data."""
    points = points_of(frame)
    normal, height = ransac_plane(points[np.isfinite(points[:, 2])])
    with np.errstate(invalid="ignore"):
        found = np.abs(points @ normal + height).reshape(frame.truth.shape) < 0.01
    seen = np.isfinite(frame.depth) & (frame.truth >= 0)
    return intersection_over_union(frame.truth == 1, found, seen)


def regions(name: str, frame: RealFrame, settings: Settings) -> RegionCounts:
    """Return how well the planes of a frame are told apart."""
    planes = segment(name, frame, settings, LENGTHWISE)
    truth = np.where(np.isfinite(frame.depth), frame.truth, -1)
    found = planes.labels.reshape(truth.shape).astype(np.int64)
    return compare_regions(truth, found, least_true=LEAST_PIXELS, least_found=LEAST_PIXELS)


def turned(frame: RealFrame) -> Iterator[RealFrame]:
    """Yield the frame turned by quarters, and each mirrored: eight cases of one scan."""
    for quarters in range(4):
        for mirror in (1, -1):
            depth = np.rot90(frame.depth, quarters)[:, ::mirror].copy()
            truth = np.rot90(frame.truth, quarters)[:, ::mirror].copy()
            height, width = depth.shape
            pinhole = Pinhole(width, height, frame.pinhole.focal)
            yield replace(frame, depth=depth, truth=truth, pinhole=pinhole)


def scan_in_stereo(frame: RealFrame, seed: int) -> RealFrame:
    """Return the scan as a stereo camera with 88 x 72 pixels and the scan's view would see it.

    Its eyes are as far apart as lets it see the nearest plane at 23 px; the robot's see 24 at most.
    """
    focal = frame.pinhole.focal * 88 / frame.pinhole.width
    baseline = 23.0 * float(np.nanmin(frame.depth)) / focal
    return through_stereo(replace(frame, baseline=baseline), seed, Pinhole(88, 72, focal))


def table_rows(data: Path) -> Iterator[dict[str, object]]:
    """Yield the support plane's rows."""
    full = labelled_table(data)
    pose = table_pose(full)
    yield {
        "data": "table",
        "pixels": "640x480",
        "segmenter": "one plane by RANSAC",
        "iou": ransac_alone(full),
    }
    stereo = [through_stereo(full, seed) for seed in STEREO_SEEDS]
    for name in SEGMENTERS:
        for pixels, frames, settings in (
            ("640x480", [full], KINECT),
            ("88x72 stereo", stereo, ROBOT),
        ):
            both = np.array([support_plane(name, frame, settings, pose) for frame in frames])
            mean, least = both.mean(axis=0), both.min(axis=0)
            yield {
                "data": "table",
                "pixels": pixels,
                "segmenter": name,
                "iou": mean[0],
                "least": least[0],
                "iou_inner": mean[1],
                "least_inner": least[1],
            }


WRONG_POSES = 20
LARGEST_TURN = math.radians(5.0)
LARGEST_RISE = 0.01
FOUND = 0.5
"""IoU with the table from which on a ground is the table."""


def wrong_pose(normal: Floats, height: float, seed: int) -> Floats:
    """Return a pose above a plane that is off by up to 5 degrees about any axis, and by 10 mm."""
    draw = np.random.default_rng([seed, 5])
    axis = draw.normal(size=3)
    turn = axis / np.linalg.norm(axis) * draw.uniform(0.0, LARGEST_TURN)
    return pose_above(normal, height, turn, draw.uniform(-LARGEST_RISE, LARGEST_RISE))


def clutter_rows(data: Path) -> Iterator[dict[str, object]]:
    """Yield how often the table under clutter is named the ground, from one picture."""
    for name in TABLES:
        full = labelled_table(data, name)
        points = points_of(full)
        normal, height = ransac_plane(points[np.isfinite(points[:, 2])])
        for pixels, settings in (("640x480", KINECT), ("88x72 stereo", ROBOT)):
            found = []
            for seed in range(WRONG_POSES):
                frame = full if pixels == "640x480" else through_stereo(full, seed)
                pose = wrong_pose(normal, height, seed)
                iou, _ = support_plane("scan_line", frame, settings, pose)
                found += [iou] if iou > FOUND else []
            yield {
                "data": "clutter",
                "pixels": pixels,
                "segmenter": f"scan_line on {name}",
                "found": len(found),
                "of": WRONG_POSES,
                "iou": float(np.mean(found)) if found else math.nan,
                "least": min(found, default=math.nan),
            }


def scan_rows(data: Path) -> Iterator[dict[str, object]]:
    """Yield the rows of the simulated scan."""
    scan = simulated_scan(data)
    stereo = [scan_in_stereo(scan, seed) for seed in STEREO_SEEDS]
    for name in SEGMENTERS:
        for pixels, frames, settings in (
            ("100x100", [scan], SCANNER),
            ("100x100, eight ways", list(turned(scan)), SCANNER),
            ("88x72 stereo", stereo, ROBOT),
        ):
            counts = sum((regions(name, frame, settings) for frame in frames), RegionCounts())
            yield {"data": "scan", "pixels": pixels, "segmenter": name, **asdict(counts)}


def room_rows(data: Path) -> Iterator[dict[str, object]]:
    """Yield what is found in the room, where nobody knows the planes."""
    full = room(data)
    for name in SEGMENTERS:
        for pixels, frame, settings in (
            ("640x480", full, KINECT),
            ("88x72 stereo", through_stereo(full, 0), ROBOT),
        ):
            start = time.perf_counter()
            planes = segment(name, frame, settings, LENGTHWISE)
            taken = time.perf_counter() - start
            yield {
                "data": "room",
                "pixels": pixels,
                "segmenter": name,
                **fit_of(frame, planes),
                "ms": 1e3 * taken,
            }


def fit_of(frame: RealFrame, planes: Planes) -> dict[str, float]:
    """Return how many planes there are, their share of the seen pixels, and how well they fit."""
    labels = planes.labels.reshape(-1)
    points = planes.points_in_robot.astype(np.float64)
    camera = planes.robot_from_camera[:3, 3]
    misses = []
    for index, (_, _, normal, distance, _) in enumerate(planes.regions):
        there = points[labels == index + 1]
        # Along the ray: disparity is inverse depth.
        ratio = ((there - camera) @ normal) / (distance - camera @ np.asarray(normal))
        depth = frame.depth.reshape(-1)[labels == index + 1]
        disparity = frame.pinhole.focal * frame.baseline / depth
        misses.append(disparity * (1.0 - ratio))
    residual = np.concatenate(misses) if misses else np.array([np.nan])
    seen = np.isfinite(frame.depth).sum()
    return {
        "planes": len(planes.regions),
        "share": float((labels > 0).sum() / seen),
        "residual_px": float(np.sqrt(np.nanmean(residual**2))),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=os.environ.get("TREADWELL_DATA"))
    parser.add_argument("--rows", type=int, help="of each table, at most; nothing is written then")
    add_options(parser, table=False)
    options = parser.parse_args()
    data = options.data
    if data is None:
        parser.error("say where the data are: --data FOLDER or TREADWELL_DATA")
    for rows in (table_rows, clutter_rows, scan_rows, room_rows):
        found = []
        for row in islice(rows(Path(data)), options.rows):
            shown = {k: round(v, 3) if isinstance(v, float) else v for k, v in row.items()}
            print(json.dumps(shown), flush=True)
            found.append(row)
        if options.rows is not None:
            continue
        title, table = results_table(found)
        write(options, title, None, table, "TREADWELL_DATA=FOLDER python benches/real_data.py")


if __name__ == "__main__":
    main()
