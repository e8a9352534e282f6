"""The laser log of the Intel lab as plan-view maps: lines, and how probable held-out scans are.

    python benches/intel_log.py --data FOLDER
    python benches/intel_log.py --seeds 3 --results indoor

`FOLDER` is `TREADWELL_DATA` unless given. The log has corrected poses and no raw odometry: odometry
is their increments with noise (5 % of the way, 2 degrees + 5 % of the turn), a seed each. Every
tenth scan is held out: a map is made of the others at the corrected poses, and at those of the
noisy odometry, and told is the mean logarithm of the density of the held-out ranges, 1/m. Lines
are of all valid points, with a standard deviation of 3 cm; the scans stay at the log's poses, or
are laid onto the lines (`plan_view.alignment`).
"""

import argparse
import json
import os
from itertools import pairwise
from pathlib import Path
from time import process_time

import numpy as np
from into_results import add_options, write
from numpy.typing import NDArray

from treadwell._core import OccupancyMap, find_lines
from treadwell.poses import pose_matrix
from treadwell.sources.laser_log import open_laser_log

LOG = Path("laser2d") / "intel-lab.log.gz"
CELL, HELD_OUT, WORD = 0.05, 10, 94
SURE = {"cell": CELL, "least": 0.001, "most": 0.999}
"""Nothing is unlearned in a log of one day: cells may be surer than by default."""
Floats = NDArray[np.float64]


def scans(data: Path, most: int) -> list[tuple[Floats, Floats]]:
    """Poses (4, 4) and points (n, 3) m in the laser's frame, NaN for nothing seen."""
    frames = open_laser_log(data / LOG)
    found = [
        (frame.world_from_sensor, np.asarray(frame.points, np.float64))
        for frame in frames
        if frame.points is not None
    ]
    return found[:most]


def placed(pose: Floats, points: Floats) -> Floats:
    """Points (n, 2) m in the map."""
    return np.ascontiguousarray((points @ pose[:3, :3].T + pose[:3, 3])[:, :2])


def noisy(poses: list[Floats], seed: int) -> list[Floats]:
    """Poses by odometry: the increments of the true ones, with noise."""
    numbers = np.random.default_rng(seed)
    made = [poses[0]]
    for before, after in pairwise(poses):
        step = np.linalg.inv(before) @ after
        x, y = step[:2, 3]
        turn = np.arctan2(step[1, 0], step[0, 0])
        way = np.hypot(x, y)
        x, y = (value + 0.05 * way * numbers.standard_normal() for value in (x, y))
        turn += (np.deg2rad(2.0) * (way > 0) + 0.05 * abs(turn)) * numbers.standard_normal()
        made.append(made[-1] @ pose_matrix(x, y, 0.0, turn))
    return made


def held_out(seen: list[tuple[Floats, Floats]], poses: list[Floats]) -> float:
    """Mean logarithm of the density of each held-out beam."""
    core = OccupancyMap(json.dumps(SURE))
    for number, (pose, (_, points)) in enumerate(zip(poses, seen, strict=True)):
        if number % HELD_OUT:
            core.insert(placed(pose, points), (pose[0, 3], pose[1, 3]))
    total, beams = 0.0, 0
    for pose, (_, points) in list(zip(poses, seen, strict=True))[::HELD_OUT]:
        points = points[np.isfinite(points).all(axis=1)]
        one, count = core.log_likelihood(placed(pose, points), (pose[0, 3], pose[1, 3]))
        total, beams = total + one, beams + count
    return total / max(beams, 1)


def lines(points: Floats, **settings: float) -> tuple[int, float, float]:
    """How many there are, the share of the points that they hold, and seconds of the processor."""
    started = process_time()
    found = find_lines(points, json.dumps(settings))
    return len(found["normal"]), found["held"], process_time() - started


def laid_onto_lines(
    seen: list[tuple[Floats, Floats]], settings: dict[str, float]
) -> tuple[int, float, float, float]:
    """As `lines`, with the scans laid onto them: by how much they are moved, m, on average, too."""
    started = process_time()
    scans = [placed(pose, points) for pose, points in seen]
    scans = [scan[np.isfinite(scan).all(axis=1)] for scan in scans]
    of = np.repeat(np.arange(len(scans)), [len(scan) for scan in scans])
    eyes = np.array([pose[:2, 3] for pose, _ in seen])
    found = find_lines(
        np.ascontiguousarray(np.concatenate(scans)),
        json.dumps(settings),
        scan=of.tolist(),
        eyes=eyes,
        alignment=json.dumps({"rounds": 5}),
    )
    moved = float(np.hypot(*(found["poses"][:, :2] - eyes).T).mean())
    return len(found["normal"]), found["held"], moved, process_time() - started


def main() -> None:
    """Measure, print, and write."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--data", type=Path, default=os.environ.get("TREADWELL_DATA"))
    parser.add_argument("--seeds", type=int, default=10, help="of the odometry's noise")
    parser.add_argument("--scans", type=int, default=1_000_000, help="no more of the log")
    add_options(parser)
    options = parser.parse_args()
    if options.data is None:
        parser.error("say where the data are: --data FOLDER or TREADWELL_DATA")
    seen = scans(options.data, options.scans)
    poses = [pose for pose, _ in seen]
    points = np.concatenate([placed(pose, scan) for pose, scan in seen])
    points = np.ascontiguousarray(points[np.isfinite(points).all(axis=1)])
    rows = []
    for what, wanted, settings in (
        ("lines that hold 90 % of the points within 2 sigma", "94", {"held": 0.9}),
        (f"share of the points that {WORD} lines hold", "90 %", {"held": 1.0, "most_lines": WORD}),
    ):
        count, held, seconds = lines(points, **settings)
        measured = f"{count} lines, {held:.1%} of {len(points)} points, {seconds:.0f} s"
        rows.append({"what": what, "measured": measured, "wanted": wanted})
    fine = {"held": 1.0, "most_lines": WORD, "cell": 0.5, "rounds": 12}
    count, held, moved, seconds = laid_onto_lines(seen, fine)
    measured = f"{count} lines, {held:.1%}; poses moved by {1e3 * moved:.0f} mm, {seconds:.0f} s"
    what = f"share of the points that {WORD} lines hold, the scans laid onto them"
    rows.append({"what": what, "measured": measured, "wanted": "90 %"})
    best = held_out(seen, poses)
    others = [held_out(seen, noisy(poses, seed)) for seed in range(options.seeds)]
    measured = f"{best:.2f} at the corrected poses"
    if others:
        measured += f"; {np.mean(others):.2f} ({min(others):.2f} to {max(others):.2f}) by odometry"
    what = "log-likelihood a beam of every tenth scan, held out"
    rows.append({"what": what, "measured": measured, "wanted": "above the map by odometry"})
    for row in rows:
        print(json.dumps(row))
    title = "The laser log of the Intel lab"
    command = "TREADWELL_DATA=FOLDER python benches/intel_log.py"
    write(options, title, list(range(options.seeds)) or None, rows, command)


if __name__ == "__main__":
    main()
