"""The laser log of the Intel lab by noisy odometry, corrected by its scans (`scan_match`).

    python benches/intel_slam.py --data FOLDER
    python benches/intel_slam.py --seeds 3 --results indoor --picture map.png

`FOLDER` is `TREADWELL_DATA` unless given. Odometry is as in intel_log.py: the increments of the
log's corrected poses with noise, a seed each; poses and edges of the log are for scoring alone.
Told are the mean error over the pairs under `#LOOP EDGES`, before and after; the mean logarithm of
the density of every tenth scan's ranges in a map of the others, 1/m; and what the pairs are worth:
those that look the same way (25 degrees) are laid onto each other, scan onto scan, without map or
graph (points onto lines), and told is how far that is from what the log says of the pair, and from
where the scans were put.
"""

import argparse
import gzip
import os
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import Final

import numpy as np
from intel_log import LOG, Floats, held_out, noisy, placed, scans
from into_results import add_options, write
from numpy.typing import NDArray

from treadwell._core import OccupancyMap, ScanSlam
from treadwell.poses import pose_matrix

ALIKE: Final = np.deg2rad(25.0)
NEAR: Final = 0.25
"""Points that are further off than this, m, are not laid onto each other."""
LINE: Final = 0.4
"""Neighbours of a point between which there is a line, m."""
FAR: Final = 0.03
"""Points so far off, m, count a quarter."""
LEAST_POINTS, LEAST_HELD = 80, 8.0
"""Points of a pair on each other, and how well the worst direction is held, in points."""


def pairs(data: Path) -> list[tuple[int, int, Floats]]:
    """The pairs that close the log's loops: numbers of both scans, and (3,) x, y, m, yaw, rad."""
    found, here = [], False
    with gzip.open(data / LOG, "rt") as lines:
        for line in lines:
            here |= line.startswith("#LOOP EDGES")
            words = line.split()
            if here and words and words[0] == "EDGE2":
                way = np.array([float(word) for word in words[3:6]])
                found.append((int(words[1]), int(words[2]), way))
    return found


def planar(pose: Floats) -> Floats:
    """x, y and yaw of a pose (4, 4)."""
    return np.array([pose[0, 3], pose[1, 3], np.arctan2(pose[1, 0], pose[0, 0])])


def off(one: Floats, other: Floats) -> tuple[float, float]:
    """How far two planar poses are from each other, m and degrees."""
    turn = np.angle(np.exp(1j * (one[2] - other[2])))
    return float(np.hypot(*(one - other)[:2])), float(np.rad2deg(abs(turn)))


def errors(poses: list[Floats], closing: list[tuple[int, int, Floats]]) -> Floats:
    """Mean error over the pairs, (2,) m and degrees."""
    each = [off(planar(np.linalg.inv(poses[a]) @ poses[b]), said) for a, b, said in closing]
    return np.mean(each, axis=0)


def corrected(
    seen: list[tuple[Floats, Floats]], odometry: list[Floats]
) -> tuple[list[Floats], list[int], float]:
    """Poses by the scans; local maps, loops and scans that fit nowhere; seconds of a core."""
    started = process_time()
    slam = ScanSlam()
    for pose, (_, points) in zip(odometry, seen, strict=True):
        x, y, yaw = planar(pose).tolist()
        slam.insert(np.ascontiguousarray(points[:, :2]), (x, y, yaw))
    slam.finish()
    poses = [pose_matrix(x, y, 0.0, yaw) for x, y, yaw in slam.poses().tolist()]
    return poses, list(slam.counts()), process_time() - started


def laid_onto(one: Floats, other: Floats, start: Floats) -> Floats | None:
    """Where a scan lies on another one, points (n, 2) m onto lines between points, from a start."""
    lines: NDArray[np.float64] = np.zeros_like(one)
    along = one[2:] - one[:-2]
    lengths = np.hypot(*along.T)
    has_line = np.r_[False, lengths < LINE, False]
    lines[1:-1] = np.stack([-along[:, 1], along[:, 0]], axis=1) / lengths[:, None]
    way = start.copy()
    for _ in range(40):
        turn = pose_matrix(0.0, 0.0, 0.0, way[2])[:2, :2]
        turned = other @ turn.T
        at = turned + way[:2]
        apart = np.hypot(*(at[:, None] - one[None]).transpose(2, 0, 1))
        nearest = apart.argmin(axis=1)
        good = (apart.min(axis=1) < NEAR) & has_line[nearest]
        normal = lines[nearest][good]
        by = (normal * np.stack([-turned[good, 1], turned[good, 0]], axis=1)).sum(axis=1)
        change = np.column_stack([normal, by])
        residual = ((at[good] - one[nearest][good]) * normal).sum(axis=1)
        weight = 1.0 / (1.0 + (residual / FAR) ** 2) ** 2
        held = (change * weight[:, None]).T @ change
        step = np.linalg.solve(held + 1e-6 * np.eye(3), -(change * weight[:, None]).T @ residual)
        way = way + step
        if np.abs(step).max() < 1e-6:
            break
    enough = good.sum() >= LEAST_POINTS and np.linalg.eigvalsh(held)[0] >= LEAST_HELD
    return way if enough else None


def worth(
    seen: list[tuple[Floats, Floats]],
    poses: list[Floats],
    closing: list[tuple[int, int, Floats]],
) -> tuple[int, Floats, Floats]:
    """Pairs that could be laid onto each other; how far the log is off, and the poses are."""
    points = [scan[np.isfinite(scan).all(axis=1), :2] for _, scan in seen]
    log, ours = [], []
    for a, b, said in closing:
        if abs(said[2]) > ALIKE:
            continue
        way = laid_onto(points[a], points[b], said)
        if way is not None:
            log.append(off(way, said))
            ours.append(off(way, planar(np.linalg.inv(poses[a]) @ poses[b])))
    return len(log), np.mean(log or [(np.nan,) * 2], axis=0), np.mean(ours or log, axis=0)


def draw(path: Path, seen: list[tuple[Floats, Floats]], poses: list[list[Floats]]) -> None:
    """The maps of all scans at several lists of poses, side by side."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, all_axes = pyplot.subplots(1, len(poses), figsize=(11 * len(poses), 10))
    for axes, each, title in zip(
        all_axes, poses, ("noisy odometry", "scan_match", "the log's poses"), strict=True
    ):
        core = OccupancyMap('{"cell": 0.03, "least": 0.001, "most": 0.999}')
        for pose, (_, points) in zip(each, seen, strict=True):
            core.insert(placed(pose, points), (pose[0, 3], pose[1, 3]))
        (x, y), cell, probability, _ = core.cells()
        rows, cols = probability.shape
        extent = (x, x + cols * cell, y, y + rows * cell)
        shade = np.where(np.isnan(probability), 0.2, probability)
        axes.imshow(shade, origin="lower", extent=extent, cmap="gray_r", vmin=0, vmax=1)
        way = np.array([pose[:2, 3] for pose in each])
        axes.plot(way[:, 0], way[:, 1], color="#ff5fa2", linewidth=0.4)
        low, high = way.min(axis=0) - 6.0, way.max(axis=0) + 6.0
        axes.set(title=title, xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def spread(values: list[float]) -> str:
    """Mean, least and most."""
    return f"{np.mean(values):.3f} ({min(values):.3f} to {max(values):.3f})"


def main() -> None:
    """Measure, print, and write."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--data", type=Path, default=os.environ.get("TREADWELL_DATA"))
    parser.add_argument("--seeds", type=int, default=10, help="of the odometry's noise")
    parser.add_argument("--scans", type=int, default=1_000_000, help="no more of the log")
    parser.add_argument("--picture", type=Path, help="draw the maps of the first seed there")
    add_options(parser)
    options = parser.parse_args()
    if options.data is None:
        parser.error("say where the data are: --data FOLDER or TREADWELL_DATA")
    seen = scans(options.data, options.scans)
    truth = [pose for pose, _ in seen]
    closing = [pair for pair in pairs(options.data) if max(pair[:2]) < len(seen)]
    each: list[Seed] = []
    first: list[Floats] = truth
    for seed in range(options.seeds):
        odometry = noisy(truth, seed)
        poses, (maps, closed, unmatched), took = corrected(seen, odometry)
        if not seed:
            first = poses
            if options.picture:
                draw(options.picture, seen, [odometry, poses, truth])
        both = [errors(way, closing) for way in (odometry, poses)] if closing else []
        fits = held_out(seen, odometry), held_out(seen, poses)
        each.append(Seed(both, fits, closed, took))
        print(
            f"seed {seed}: {maps} local maps, {closed} loops, {unmatched} unmatched, "
            f"{took:.1f} s; {fits[1]:.2f}, odometry {fits[0]:.2f}"
        )
    rows = table(each, len(closing))
    if closing:
        count, log, ours = worth(seen, first, closing)
        measured = f"{log[0]:.3f} m, {log[1]:.2f} degrees; where the scans were put (seed 0): "
        measured += f"{ours[0]:.3f} m, {ours[1]:.2f} degrees"
        what = f"what the log says of {count} of the pairs, against both scans laid onto each other"
        rows.insert(2, {"what": what, "measured": measured})
    measured = f"{held_out(seen, truth):.3f}"
    what = "the same in the map at the log's poses"
    rows.insert(-1, {"what": what, "measured": measured})
    for row in rows:
        print(row)
    title = "The Intel lab by noisy odometry, corrected by its scans (scan_match)"
    command = "TREADWELL_DATA=FOLDER python benches/intel_slam.py"
    write(options, title, list(range(options.seeds)) or None, rows, command)


@dataclass(frozen=True)
class Seed:
    """What came of a seed: by odometry and after that, and what it took."""

    errors: list[Floats]
    fits: tuple[float, float]
    loops: int
    seconds: float


def table(each: list[Seed], closing: int) -> list[dict[str, str]]:
    """The rows of all seeds."""
    rows = []
    if closing:
        for unit, axis, wanted in (("m", 0, "0.03"), ("degrees", 1, "0.5")):
            had, have = ([float(seed.errors[way][axis]) for seed in each] for way in (0, 1))
            bold = "**" * (float(np.mean(have)) > float(wanted))
            measured = f"{bold}{spread(have)}{bold}; by odometry {np.mean(had):.1f}"
            what = f"mean error over the {closing} pairs under #LOOP EDGES, {unit}"
            rows.append({"what": what, "measured": measured, "wanted": wanted})
    had, have = ([seed.fits[way] for seed in each] for way in (0, 1))
    measured = f"{spread(have)}; by odometry {spread(had)}"
    above = sum(seed.fits[1] > seed.fits[0] for seed in each)
    wanted = f"above the map by odometry ({above} of {len(each)})"
    what = "log-likelihood a beam of every tenth scan, held out of the map"
    rows.append({"what": what, "measured": measured, "wanted": wanted})
    measured = f"{np.mean([seed.loops for seed in each]):.0f}; "
    measured += f"{np.mean([seed.seconds for seed in each]):.0f} s of a core"
    rows.append({"what": "loops closed a seed, and time", "measured": measured})
    return rows


if __name__ == "__main__":
    main()
