"""Hours of simulated time in one process: does its memory grow?

    python benches/soak.py --hours 10
    python benches/soak.py --hours 1 --scenarios slalom visitor_nao

Episodes one after the other, with all that a run without recording does. Prints the resident memory
after each, and by how much it grew from the second tenth of the time to the last one: the mean and
the least of each, since what the allocator has not given back yet comes and goes.
"""

import argparse
import gc
import json
import os
import sys
import tempfile
import time
from pathlib import Path
from statistics import fmean

from into_results import add_options, write

from treadwell.runner import run

SCENARIOS = ("slalom", "stairs_up", "visitor_nao")
PAGE = os.sysconf("SC_PAGE_SIZE")


def resident_mb() -> float:
    """Return what of this process is in memory, MB."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * PAGE / 1e6


def main() -> int:
    """Run episodes for the time that was asked for; 1 where memory grew by more than is allowed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, default=10.0, help="of simulated time")
    parser.add_argument("--scenarios", nargs="+", default=SCENARIOS)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--allowed", type=float, default=10.0, help="growth, MB")
    add_options(parser)
    arguments = parser.parse_args()
    simulated_s, seed = 0.0, arguments.first_seed
    begin, wanted_s = time.perf_counter(), 3600.0 * arguments.hours
    tenths_mb: dict[int, list[float]] = {}
    while simulated_s < wanted_s:
        scenario = arguments.scenarios[seed % len(arguments.scenarios)]
        with tempfile.TemporaryDirectory() as folder:
            done = run(scenario, seed=seed, record=False, out=Path(folder) / "run")
        tenth = min(9, int(10.0 * simulated_s / wanted_s))
        simulated_s += done.result.simulated_seconds
        seed += 1
        now_mb = resident_mb()
        tenths_mb.setdefault(tenth, []).append(now_mb)
        row = {"episodes": seed - arguments.first_seed, "simulated_h": simulated_s / 3600.0}
        print(json.dumps(row | {"resident_mb": round(now_mb, 1)}), flush=True)
    # In a short run an episode may be longer than a tenth.
    early = tenths_mb[min((tenth for tenth in tenths_mb if tenth > 0), default=0)]
    late = tenths_mb[max(tenths_mb)]
    grown_mb = {"mean": fmean(late) - fmean(early), "least": min(late) - min(early)}
    wall_s = round(time.perf_counter() - begin)
    rounded = {name: round(value, 2) for name, value in grown_mb.items()}
    print(json.dumps({"grown_mb": rounded, "most_mb": max(late), "wall_s": wall_s}))
    rows = [
        {
            "what": f"{name} of a tenth of the time, second / last",
            "measured": f"{of(early):.1f} / {of(late):.1f} MB",
        }
        for name, of in (("mean", fmean), ("least", min))
    ]
    title = f"Memory over {arguments.hours:g} hours of simulated time in one process"
    write(arguments, title, range(arguments.first_seed, seed), rows)
    return int(max(grown_mb.values()) > arguments.allowed)


if __name__ == "__main__":
    sys.exit(main())
