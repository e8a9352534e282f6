"""Bonxai's occupancy update beside the core's, on the same frames, in one run.

    python benches/peers/bonxai.py FOLDER [--frames PATH|N] [--flags "-O3 -march=native"]

FOLDER holds Bonxai's sources (github.com/facontidavide/Bonxai), which need Eigen 3; $CXX builds
them together with `bonxai.cpp`. Printed for each mode: milliseconds of processor time a frame, how
many times faster than Bonxai, and how its map agrees with that of `every_ray`.
"""

import argparse
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time
from typing import IO, Final

import numpy as np
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).resolve().parents[1]))
from into_results import add_options, write

from treadwell.timing.benches import CLEARING, grids
from treadwell.timing.frames import Frames, write_frames
from treadwell.timing.room import workloads

CELL: Final = 0.04
RANGE: Final = 4.0
ROUNDS: Final = 5
"""Each frame counts with the least of so many times: what else the machine does is not ours."""
EVEN: Final = 0.5
"""Probability of what nothing is known of."""


def built(sources: Path, flags: str, folder: Path) -> Path:
    """Build the driver.

    Args:
        sources: of Bonxai.
        flags: of the compiler, of our own choice.
        folder: to put it into.
    """
    program = folder / "bonxai"
    includes = [
        f"-I{sources / 'bonxai_core/include'}",
        f"-I{sources / 'bonxai_map/include'}",
    ]
    units = [
        Path(__file__).with_suffix(".cpp"),
        sources / "bonxai_map/src/probabilistic_map.cpp",
    ]
    compiler = shlex.split(os.environ.get("CXX", "c++"))
    command = [*compiler, "-std=c++17", *shlex.split(flags), *includes, *map(str, units)]
    subprocess.run([*command, "-o", str(program)], check=True)
    return program


class Bonxai:
    """The driver, waiting for numbers of frames."""

    def __init__(self, program: Path, frames: Path) -> None:
        """Start it.

        Args:
            program: the driver.
            frames: a file of them.
        """
        self._process = subprocess.Popen(
            [program, frames, str(CELL), str(RANGE)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def clear(self) -> None:
        """Begin with an empty map."""
        print("new", file=self._pipe(self._process.stdin), flush=True)

    def insert(self, index: int) -> float:
        """Take in a frame; the processor's time for it, ms."""
        print(index, file=self._pipe(self._process.stdin), flush=True)
        return float(self._pipe(self._process.stdout).readline())

    def close(self) -> None:
        """End it."""
        self._pipe(self._process.stdin).close()
        self._process.wait()

    @staticmethod
    def _pipe(pipe: IO[str] | None) -> IO[str]:
        if pipe is None:
            raise BrokenPipeError
        return pipe


def alike(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> float:
    """Return the intersection of two sets of voxels over their union."""
    return float((one & other).sum() / max(1, (one | other).sum()))


def compare(frames: Frames, bonxai: Bonxai) -> list[dict[str, object]]:
    """Print a row each, frame by frame in turn.

    Returns:
        The rows of docs/results.
    """
    count = len(frames.depth)
    clouds = [frames.points(index) for index in range(count)]
    pictures = [frames.picture(index) for index in range(count)]
    spent = {name: np.zeros((ROUNDS, count)) for name in ("Bonxai", *CLEARING)}
    maps = grids(clouds)
    for turn in range(ROUNDS):
        maps = grids(clouds)
        bonxai.clear()
        for index in range(count):
            spent["Bonxai"][turn, index] = bonxai.insert(index)
            seen = (pictures[index], frames.camera(index), frames.focal, frames.centre)
            for mode, grid in maps.items():
                started = process_time()
                grid.insert_picture(*seen)
                spent[mode][turn, index] = 1e3 * (process_time() - started)
    best = {name: rows.min(axis=0) for name, rows in spent.items()}
    found = {mode: grid.probability() for mode, grid in maps.items()}
    sys.stdout.write(f"{frames.name} {frames.shape}, {count} frames, {1e3 * CELL:.0f} mm\n")
    sys.stdout.write(f"  Bonxai     p50 {np.median(best['Bonxai']):7.3f} ms\n")
    measured: dict[str, str] = {}
    for mode in CLEARING:
        times = float(np.median(best["Bonxai"]) / np.median(best[mode]))
        occupied = alike(found["exact"] > EVEN, found[mode] > EVEN)
        free = alike(found["exact"] < EVEN, found[mode] < EVEN)
        measured[mode] = f"{times:.1f} times, {occupied:.3f} / {free:.3f}"
        sys.stdout.write(
            f"  {mode:10} p50 {np.median(best[mode]):7.3f} ms  {times:5.2f} times faster"
            f"  IoU occupied {occupied:.4f}  free {free:.4f}\n"
        )
    sys.stdout.flush()
    return [{"what": f"{frames.name} {frames.shape}", "measured": measured}]


def main() -> None:
    """Compare on the frames of a file, or on those of the bench."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("sources", type=Path, help="Bonxai's")
    parser.add_argument("--frames", default="40", help="a file, or how many of the bench's")
    parser.add_argument("--flags", default="-O3", help="of the compiler")
    add_options(parser)
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        program = built(options.sources, options.flags, Path(folder))
        for frames in workloads(options.frames):
            file = Path(folder) / "frames.dfr"
            write_frames(frames, file)
            bonxai = Bonxai(program, file)
            rows += compare(frames, bonxai)
            bonxai.close()
    write(options, "Occupancy update alone, 4 cm, against Bonxai in one run", None, rows)


if __name__ == "__main__":
    main()
