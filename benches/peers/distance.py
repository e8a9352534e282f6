"""OpenCV's exact distance transform beside the core's: float32 distances of the same grids.

python benches/peers/distance.py [--side N]   needs: pip install opencv-python-headless
"""

import argparse
import sys
from pathlib import Path
from time import process_time

import cv2
import numpy as np
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).resolve().parents[1]))
from into_results import add_options, write

from treadwell._core import distances

CELLS = 32_000_000
"""Rounds times cells, where that leaves some rounds."""


def grids(side: int) -> dict[str, NDArray[np.bool_]]:
    """Return blocked cells: rooms with things, clutter, and hardly anything."""
    rng = np.random.default_rng(5)
    boxes = np.zeros((side, side), bool)
    for _ in range(40):
        col, row = rng.integers(0, side, 2)
        width, height = rng.integers(2, side // 20, 2)
        boxes[row : row + height, col : col + width] = True
    few = np.zeros((side, side), bool)
    few.flat[rng.integers(0, few.size, 10)] = True
    return {"40 boxes": boxes, "one cell in 20": rng.random((side, side)) < 0.05, "10 cells": few}


def main() -> None:
    """Print the best of many rounds, one thread each, and whether both say the same."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--side", type=int, default=400)
    add_options(parser)
    options = parser.parse_args()
    side, rows = options.side, []
    cv2.setNumThreads(1)
    for name, blocked in grids(side).items():
        free = (~blocked).astype(np.uint8)
        rounds = max(5, CELLS // side**2)
        spent = np.zeros((2, rounds))
        for turn in range(rounds):
            started = process_time()
            ours = distances(blocked)
            between = process_time()
            theirs = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
            spent[:, turn] = between - started, process_time() - between
        core, peer = 1e3 * spent.min(axis=1)
        off = np.abs(ours - theirs).max()
        sys.stdout.write(
            f"{side}x{side}, {name}: core {core:.2f} ms, OpenCV {peer:.2f} ms, "
            f"{peer / core:.1f} times faster; differ by {off:.0e} cells at most\n"
        )
        rows.append({"what": name, "measured": f"{peer / core:.1f} times faster, {core:.2f} ms"})
    write(options, f"Distance transform, {side}x{side}, against OpenCV's precise one", None, rows)


if __name__ == "__main__":
    main()
