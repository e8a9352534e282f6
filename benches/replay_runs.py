"""Records N runs of several scenarios and both robots, replays each, and counts what differs.

    python benches/replay_runs.py --count 100 --seconds 8

Says for each how much faster than real time it was by the clock and by the processor's time (which
does not depend on what else runs), and which share of it was the core's, stage by stage.
"""

import argparse
import shutil
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

from into_results import add_options, write

import treadwell

CASES = (
    ("stairs_up", "qrio"),
    ("slalom", "qrio"),
    ("obstacle_course", "qrio"),
    ("obstacle_course", "nao"),
    ("sill", "nao"),
    ("nao_2", "nao"),
    ("visitor", "qrio"),
    ("curtain", "qrio"),
)


def replayed(folder: Path, scenario: str, robot: str, seed: int, seconds: float) -> dict[str, Any]:
    """Record and replay one run; return the replay's document with the processor's seconds."""
    limit = (f"time_limit={seconds}",)
    run = treadwell.run(scenario, robot=robot, seed=seed, overrides=limit, out=folder / "run")
    begin = time.process_time()
    done = treadwell.replay(run.folder, out=folder / "replay")
    document = done.result.document()
    document["cpu_seconds"] = time.process_time() - begin
    same = (folder / "run" / "trajectory.tum").read_bytes()
    document["same"] = (
        done.passed
        and document["replay"]["compared"] > 0
        and same == (folder / "replay" / "trajectory.tum").read_bytes()
    )
    return document


def main() -> int:
    """Run, and return 1 where a replay was not the same."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=16)
    parser.add_argument("--seconds", type=float, default=8.0, help="simulated, of each run")
    add_options(parser)
    options = parser.parse_args()
    totals: Counter[str] = Counter()
    stages: Counter[str] = Counter()
    for number in range(options.count):
        scenario, robot = CASES[number % len(CASES)]
        folder = Path(tempfile.mkdtemp())
        try:
            found = replayed(folder, scenario, robot, number // len(CASES), options.seconds)
        finally:
            shutil.rmtree(folder)
        simulated = found["simulated_seconds"]
        totals["same"] += found["same"]
        totals["simulated"] += simulated
        totals["cpu"] += found["cpu_seconds"]
        totals["wall"] += found["wall_seconds"]
        totals["core"] += found["replay"]["core_seconds"]
        for stage, spent in found["timing_ms"].items():
            stages[stage] += 1e-3 * spent["median"] * spent["count"]
        cpu, wall = simulated / found["cpu_seconds"], found["real_time_factor"]
        share = found["replay"]["core_seconds"] / found["wall_seconds"]
        print(
            f"{number + 1:4d} {scenario:16s} {robot:5s} {'same' if found['same'] else 'DIFFERS'}"
            f"  {cpu:5.1f}x cpu  {wall:5.1f}x wall  core {share:.0%}",
            flush=True,
        )
    simulated = totals["simulated"]
    print(f"the same: {totals['same']} of {options.count}")
    for name in ("cpu", "wall", "core"):
        print(f"real time / {name}: {simulated / totals[name]:.1f}")
    for stage, spent in stages.most_common():
        print(f"{stage:10s} {1e3 * spent / simulated:6.2f} ms for each simulated second")
    rows = [{"what": "the same bits", "measured": f"{totals['same']} of {options.count}"}]
    for name, what in (
        ("wall", "against real time, by the clock"),
        ("cpu", "against real time, by processor time"),
        ("core", "against real time, the core alone"),
    ):
        rows.append({"what": what, "measured": f"{simulated / totals[name]:.0f} times"})
    write(options, "Replay of recorded runs without MuJoCo", None, rows)
    return 0 if totals["same"] == options.count else 1


if __name__ == "__main__":
    sys.exit(main())
