"""A whole episode against real time on one core, without and with recording; each stage's median.

python benches/speed.py --scenario slalom --seeds 400-404
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import numpy as np
from episodes import seeds

from treadwell.runner import run

CORE = ("segment", "map", "stairs", "localize", "plan", "behave", "walk")


def main() -> None:
    """Run and print a row each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="slalom")
    parser.add_argument("--seeds", type=seeds, default=list(range(5)))
    options = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    import rerun  # noqa: F401

    for record in (False, True):
        factors, shares, both = [], [], []
        for seed in options.seeds:
            with tempfile.TemporaryDirectory() as folder:
                out = Path(folder) / "run"
                result = run(options.scenario, seed=seed, record=record, out=out).result
            table = result.timing_ms
            core = sum(table[name].median * table[name].count for name in CORE) / 1e3
            factors.append(result.real_time_factor)
            shares.append(core / result.wall_seconds)
            both.append(table["segment"].median + table["map"].median)
        title = "with" if record else "without"
        sys.stdout.write(
            f"{title} recording: {np.median(factors):.1f} times real time "
            f"({min(factors):.1f} to {max(factors):.1f}), core {100 * np.median(shares):.0f} % "
            f"of the wall time, segmentation and map {np.median(both):.2f} ms a frame\n"
        )
        sys.stdout.flush()


if __name__ == "__main__":
    main()
