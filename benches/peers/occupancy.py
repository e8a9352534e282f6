"""OctoMap's occupancy update beside the core's, on the same frames, in one run.

python benches/peers/occupancy.py [--frames PATH|N]   needs: pip install pyoctomap
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from time import process_time

import numpy as np
import pyoctomap
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).resolve().parents[1]))
from into_results import add_options, write

from treadwell.timing.benches import CLEARING, grids
from treadwell.timing.frames import Frames
from treadwell.timing.room import workloads

CELL = 0.04
RANGE = 4.0
ROUNDS = 3

Insert = Callable[[int], object]
"""Takes in the frame of a number."""


def octomap(frames: Frames, clouds: Sequence[NDArray[np.float64]], *, discretize: bool) -> Insert:
    """Return how a new tree takes in the points of a frame."""
    tree = pyoctomap.OcTree(CELL)

    def insert(index: int) -> object:
        eye = frames.position[index]
        return tree.insertPointCloud(clouds[index], eye, max_range=RANGE, discretize=discretize)

    return insert


def core(
    frames: Frames,
    clouds: Sequence[NDArray[np.float64]],
    pictures: Sequence[NDArray[np.float64]],
    mode: str,
) -> Insert:
    """Return how a new grid of the core takes in the same points, pixel by pixel."""
    grid = grids(clouds)[mode]

    def insert(index: int) -> object:
        camera = frames.camera(index)
        return grid.insert_picture(pictures[index], camera, frames.focal, frames.centre)

    return insert


def compare(frames: Frames) -> list[dict[str, object]]:
    """Print a row each: milliseconds of processor time a frame, and ratios to OctoMap's.

    Returns:
        The rows of docs/results.
    """
    clouds = [frames.points(index) for index in range(len(frames.depth))]
    pictures = [frames.picture(index) for index in range(len(frames.depth))]
    makers: dict[str, Callable[[], Insert]] = {
        "OctoMap exact": partial(octomap, frames, clouds, discretize=False),
        "OctoMap discretized": partial(octomap, frames, clouds, discretize=True),
        **{mode: partial(core, frames, clouds, pictures, mode) for mode in CLEARING},
    }
    spent = {name: np.zeros((ROUNDS, len(clouds))) for name in makers}
    for turn in range(ROUNDS):
        inserts = {name: make() for name, make in makers.items()}
        for index in range(len(clouds)):
            for name, insert in inserts.items():
                started = process_time()
                insert(index)
                spent[name][turn, index] = 1e3 * (process_time() - started)
    best = {name: rows.min(axis=0) for name, rows in spent.items()}
    sys.stdout.write(f"{frames.name} {frames.shape}, {len(clouds)} frames, {1e3 * CELL:.0f} mm\n")
    for name, rows in best.items():
        ratio = "".join(
            f"  {np.median(best[peer] / rows):6.1f} times faster than {peer}"
            for peer in ("OctoMap exact", "OctoMap discretized")
            if not name.startswith("OctoMap")
        )
        sys.stdout.write(
            f"  {name:20} p50 {np.median(rows):8.3f}  p95 {np.percentile(rows, 95):8.3f}  "
            f"worst {rows.max():8.3f} ms{ratio}\n"
        )
    sys.stdout.flush()
    return [
        {
            "what": f"{frames.shape}, {peer.removeprefix('OctoMap ')}",
            "measured": {
                mode: f"{np.median(best[peer] / best[mode]):.1f} times faster" for mode in CLEARING
            },
        }
        for peer in ("OctoMap exact", "OctoMap discretized")
    ]


def main() -> None:
    """Compare on the frames of a file, or on those of the bench."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", default="40")
    add_options(parser)
    options = parser.parse_args()
    rows = [row for frames in workloads(options.frames) for row in compare(frames)]
    title = "Occupancy update alone, 4 cm, against OctoMap in one run"
    write(options, title, None, rows)


if __name__ == "__main__":
    main()
