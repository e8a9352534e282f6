"""A whole episode against real time and frozen physics, one core; without and with recording.

python benches/speed.py --scenario slalom --seeds 400-404
"""

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from episodes import seeds
from into_results import add_options, write

from treadwell.runner import run
from treadwell.timing.episode import frozen_ms

CORE = ("segment", "map", "stairs", "localize", "plan", "behave", "walk")


class Processor:
    """Notes at each camera frame how much processor time the run has taken, as its progress."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.looks: list[tuple[float, float]] = []

    def update(self, simulated: float, *_: object) -> None:
        """Take in simulated seconds."""
        self.looks.append((simulated, time.process_time()))

    def factor(self) -> float:
        """Return simulated seconds a second of processor time."""
        (first, begin), (last, end) = self.looks[0], self.looks[-1]
        return (last - first) / (end - begin)


def main() -> None:
    """Run and print a row each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="slalom")
    parser.add_argument("--seeds", type=seeds, default=list(range(5)))
    add_options(parser)
    options = parser.parse_args()
    rows: list[dict[str, str]] = []
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    import rerun  # noqa: F401

    for record in (False, True):
        factors, processor, shares, both, ratios = [], [], [], [], []
        for seed in options.seeds:
            with tempfile.TemporaryDirectory() as folder:
                out = Path(folder) / "run"
                looks = Processor()
                before = frozen_ms()
                result = run(
                    options.scenario, seed=seed, record=record, out=out, progress=looks
                ).result
            processor.append(looks.factor())
            ratios.append(1e3 / looks.factor() / (0.5 * (before + frozen_ms())))
            table = result.timing_ms
            core = sum(table[name].median * table[name].count for name in CORE) / 1e3
            factors.append(result.real_time_factor)
            shares.append(core / result.wall_seconds)
            both.append(table["segment"].median + table["map"].median)
        title = "with" if record else "without"
        sys.stdout.write(
            f"{title} recording: {np.median(factors):.1f} times real time "
            f"({min(factors):.1f} to {max(factors):.1f}), "
            f"{np.median(processor):.1f} by processor time "
            f"({min(processor):.1f} to {max(processor):.1f}), {np.median(ratios):.2f} times the "
            f"frozen physics ({min(ratios):.2f} to {max(ratios):.2f}), "
            f"core {100 * np.median(shares):.0f} % of the wall time, "
            f"segmentation and map {np.median(both):.2f} ms a frame\n"
        )
        sys.stdout.flush()
        times = f"{np.median(factors):.1f} times real time"
        spread = f"{min(factors):.1f} to {max(factors):.1f}"
        by_processor = f"{np.median(processor):.1f} by processor time"
        rows.append(
            {"what": f"{title} recording", "measured": f"{times} ({spread}), {by_processor}"}
        )
        what = f"processor time {title} recording against the frozen physics"
        rows.append({"what": what, "measured": f"{np.median(ratios):.2f}"})
        if not record:
            share = f"{100 * np.median(shares):.0f} %"
            what = "share of the core, walking included, in the wall time"
            rows.append({"what": what, "measured": share})
    write(options, f"Whole runs of `{options.scenario}` on one core", options.seeds, rows)


if __name__ == "__main__":
    main()
