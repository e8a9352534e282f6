"""OctoMap's castRay beside the rays of the core's localizer: the same map and rays, in one run.

python benches/peers/rays.py [--cells M...]   needs: pip install pyoctomap

What Python spends on a call of castRay is measured by rays of no length and taken off.
"""

import argparse
import sys
from pathlib import Path
from time import process_time

import numpy as np
import pyoctomap
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).resolve().parents[1]))
from into_results import add_options, write

from treadwell._core import Octree, RangeField
from treadwell.timing.frames import Frames
from treadwell.timing.room import room

GUESSES, BEAMS, TOGETHER = 500, 100, 8
RANGE = 5.0
ROUNDS = 5
_SPREAD = (0.1, 0.1)
"""Of the guesses: m to each side, rad to each."""

Rays = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Where they begin and where to."""


def rays(frames: Frames) -> Rays:
    """Return the same beams from guesses about a frame, a beam of eight guesses after the other.

    Args:
        frames: what is seen; the beams are drawn from its middle frame.
    """
    rng = np.random.default_rng(1)
    index = len(frames.depth) // 2
    beams = rng.choice(frames.directions().reshape(-1, 3), BEAMS) @ frames.rotation[index].T
    beams /= np.linalg.norm(beams, axis=1)[:, None]
    count = -(-GUESSES // TOGETHER) * TOGETHER
    shift, turn = rng.uniform(-1.0, 1.0, (count, 3)), rng.uniform(-1.0, 1.0, count) * _SPREAD[1]
    eyes = frames.position[index] + shift * [_SPREAD[0], _SPREAD[0], 0.0]
    cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y, z = beams.T
    along = np.stack([cos * x - sin * y, sin * x + cos * y, np.tile(z, (count, 1))], axis=-1)
    origins = np.repeat(eyes[:, None], BEAMS, axis=1)
    by_group = [
        array.reshape(-1, TOGETHER, BEAMS, 3).swapaxes(1, 2).reshape(-1, 3)[: GUESSES * BEAMS]
        for array in (origins, along)
    ]
    return np.ascontiguousarray(by_group[0]), np.ascontiguousarray(by_group[1])


def octomap_ms(tree: pyoctomap.OcTree, cast: Rays, reach: float) -> tuple[float, NDArray[np.bool_]]:
    """Return what all rays take, ms, and which end."""
    end = np.zeros(3)
    started = process_time()
    ended = [
        tree.castRay(origin, along, end, True, reach) for origin, along in zip(*cast, strict=True)
    ]
    return 1e3 * (process_time() - started), np.array(ended)


def compare(frames: Frames, cell: float) -> dict[str, str]:
    """Print what the rays take in both maps, and how often they say the same.

    Returns:
        The row of docs/results.
    """
    ours, theirs = Octree(cell), pyoctomap.OcTree(cell)
    for index, (x, y, z) in enumerate(frames.position.tolist()):
        points = frames.points(index)
        ours.insert(points, (x, y, z), max_range=RANGE)
        theirs.insertPointCloud(points, np.array([x, y, z]), max_range=RANGE)
    field, cast = RangeField(ours), rays(frames)
    ratios, core, peer = [], [], []
    for _ in range(ROUNDS):
        call, _ = octomap_ms(theirs, cast, 1e-6)
        spent, ended = octomap_ms(theirs, cast, RANGE)
        peer.append(spent - call)
        started = process_time()
        found = field.cast(*cast, RANGE)
        core.append(1e3 * (process_time() - started))
        ratios.append(peer[-1] / core[-1])
    same = np.mean(ended == np.isfinite(found))
    sys.stdout.write(
        f"{1e3 * cell:.0f} mm, {GUESSES} x {BEAMS} rays: core {np.median(core):.2f} ms, OctoMap "
        f"{np.median(peer):.1f} ms without Python's calls; {np.median(ratios):.0f} times faster "
        f"({min(ratios):.0f} to {max(ratios):.0f}); both end or neither {same:.2%}\n"
    )
    faster = f"{min(ratios):.0f} to {max(ratios):.0f} times faster; both end or neither {same:.0%}"
    return {"what": f"voxels of {100 * cell:.0f} cm", "measured": faster}


def main() -> None:
    """Compare in the room of the benches."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cells", type=float, nargs="+", default=[0.04, 0.02])
    add_options(parser)
    given = parser.parse_args()
    frames = room("320x240", 40)
    rows = [compare(frames, cell) for cell in given.cells]
    write(given, "Rays of a localization step, against OctoMap's castRay", None, rows)


if __name__ == "__main__":
    main()
