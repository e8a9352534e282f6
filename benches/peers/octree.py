"""OctoMap's octree beside the core's: the same points, files and rays, in one run.

python benches/peers/octree.py [--frames PATH|N] [--cells M...]   needs: pip install pyoctomap

OctoMap's times hold what its Python package spends on the points, which is about as much again.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from time import process_time

import numpy as np
import pyoctomap

sys.path.append(str(Path(__file__).resolve().parents[1]))
from into_results import add_options, write

from treadwell._core import Octree
from treadwell.timing.frames import Frames, read_frames
from treadwell.timing.room import room

RANGE = 5.0
RAYS = 50_000


def _spent(call: Callable[[], object]) -> float:
    started = process_time()
    call()
    return 1e3 * (process_time() - started)


def _row(name: str, times: list[float], note: str = "") -> None:
    sys.stdout.write(
        f"  {name:24} p50 {np.median(times):8.3f}  worst {max(times):8.3f} ms  {note}\n"
    )
    sys.stdout.flush()


def insertion(frames: Frames, cell: float) -> tuple[Octree, pyoctomap.OcTree, dict[str, str]]:
    """Print what a frame takes; return both trees, and the row of docs/results.

    Args:
        frames: what is seen.
        cell: side of a voxel, m.
    """
    ours, theirs = Octree(cell), {mode: pyoctomap.OcTree(cell) for mode in (False, True)}
    times: dict[str, list[float]] = {
        "core": [],
        "core, without Python": [],
        "False": [],
        "True": [],
    }
    for index in range(len(frames.depth)):
        points, eye = frames.points(index), frames.position[index]
        at = (float(eye[0]), float(eye[1]), float(eye[2]))
        times["core"].append(
            _spent(lambda points=points, at=at: ours.insert(points, at, max_range=RANGE))
        )
        times["core, without Python"].append(1e3 * ours.seconds)
        for mode, tree in theirs.items():
            times[str(mode)].append(
                _spent(
                    lambda tree=tree, points=points, eye=eye, mode=mode: tree.insertPointCloud(
                        points, eye, max_range=RANGE, discretize=mode
                    )
                )
            )
    _row("OctoMap exact", times.pop("False"))
    discretized = times.pop("True")
    _row("OctoMap discretized", discretized)
    for name, spent in times.items():
        _row(name, spent, f"{np.median(np.divide(discretized, spent)):.1f} times faster")
    sys.stdout.write(
        f"  nodes {ours.nodes}, OctoMap exact {theirs[False].size()}, bytes {ours.size_bytes}, "
        f"OctoMap {theirs[False].memoryUsage()}\n"
    )
    core, peer = np.median(times["core"]), np.median(discretized)
    faster = np.median(np.divide(discretized, times["core"]))
    measured = f"{faster:.1f} times faster, {core:.2f} against {peer:.1f} ms"
    return ours, theirs[False], {"what": f"voxels of {100 * cell:.0f} cm", "measured": measured}


def casting(frames: Frames, ours: Octree, theirs: pyoctomap.OcTree) -> None:
    """Print what many rays take, and in how many both trees say the same.

    Args:
        frames: whose places the rays start at.
        ours: the core's tree.
        theirs: OctoMap's.
    """
    rng = np.random.default_rng(1)
    start = frames.position[rng.integers(len(frames.position), size=RAYS)]
    along = rng.normal(size=(RAYS, 3))
    started = process_time()
    ends, distance = ours.cast_rays(np.ascontiguousarray(start), along, RANGE)
    spent = 1e3 * (process_time() - started)
    end = np.zeros(3)
    same = 0
    started = process_time()
    for index in range(RAYS):
        hit = theirs.castRay(start[index], along[index], end, True, RANGE)
        same += bool(hit) == bool(np.isfinite(distance[index])) and (
            not hit or bool(np.allclose(end, ends[index], atol=1e-3))
        )
    sys.stdout.write(f"  {RAYS} rays: core {spent:.1f} ms, OctoMap with Python ")
    sys.stdout.write(f"{1e3 * (process_time() - started):.0f} ms; the same {same / RAYS:.2%}\n")


def main() -> None:
    """Compare on the frames of a file, or on those of the bench."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", default="40")
    parser.add_argument("--cells", type=float, nargs="+", default=[0.04, 0.02])
    add_options(parser)
    given = parser.parse_args()
    rows = []
    large = "320x240"
    frames = (
        room(large, int(given.frames))
        if given.frames.isdecimal()
        else read_frames(Path(given.frames))
    )
    for cell in given.cells:
        sys.stdout.write(f"{frames.name} {frames.shape}, {1e3 * cell:.0f} mm\n")
        ours, theirs, row = insertion(frames, cell)
        casting(frames, ours, theirs)
        rows.append(row)
    title = "Inserting frames of 320x240, against OctoMap discretized"
    write(given, title, None, rows)


if __name__ == "__main__":
    main()
