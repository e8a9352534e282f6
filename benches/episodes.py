"""Many episodes of some scenarios, random seeds, every noise on: the counts in docs/results.md.

python benches/episodes.py slalom doorway --seeds 100-119 --workers 2
"""

import argparse
import json
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from treadwell.episode import Episode
from treadwell.errors import TreadwellError


@dataclass(frozen=True)
class Run:
    """How one episode went."""

    scenario: str
    seed: int
    outcome: str
    reason: str | None
    falls: int
    collisions: int
    simulated_s: float
    wall_s: float
    odometry_error_m: float
    odometry_error_rad: float
    stage_ms: dict[str, float]

    def passed(self) -> bool:
        """Whether it did what the scenario expects, without a fall or a collision."""
        expected = "refused" if self.scenario == "boxed_in" else "goal_reached"
        return self.outcome == expected and self.falls == 0 and self.collisions == 0


def run(job: tuple[str, int, tuple[str, ...]]) -> Run:
    """Run one episode without recording it."""
    scenario, seed, overrides = job
    episode = Episode(scenario, seed=seed, overrides=overrides)
    timings: dict[str, list[float]] = {stage: [] for stage in episode.pilot.stages}
    start, step, problem = time.perf_counter(), None, None
    try:
        while episode.verdict is None:
            step = episode.tick()
            for stage, seconds in zip(episode.pilot.stages, episode.pilot.timing, strict=True):
                if not np.isnan(seconds):
                    timings[stage].append(1e3 * seconds)
    except TreadwellError as error:
        problem = str(error)
    wall = time.perf_counter() - start
    true = episode.judge.frame
    x, y, _, yaw = step.estimate.odometry if step else (true.x, true.y, 0.0, true.yaw)
    turn = yaw - true.yaw
    verdict = episode.verdict
    judge = episode.judge
    return Run(
        scenario,
        seed,
        verdict.outcome if verdict else "error",
        verdict.reason if verdict else problem,
        judge.falls,
        len(judge.collisions),
        1e-9 * episode.simulation.time_ns,
        wall,
        float(np.hypot(x - true.x, y - true.y)),
        float(abs(np.arctan2(np.sin(turn), np.cos(turn)))),
        {stage: float(np.median(values)) for stage, values in timings.items() if values},
    )


def seeds(text: str) -> list[int]:
    """Read `100-119` or `3`."""
    first, _, last = text.partition("-")
    return list(range(int(first), int(last or first) + 1))


def main() -> None:
    """Run, print a line an episode and a row a scenario, write JSON where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", nargs="+")
    parser.add_argument("--seeds", type=seeds, default=list(range(20)))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    jobs = [
        (scenario, seed, tuple(options.overrides))
        for scenario in options.scenarios
        for seed in options.seeds
    ]
    runs: list[Run] = []
    with ProcessPoolExecutor(options.workers) as pool:
        for done in pool.map(run, jobs):
            runs.append(done)
            mark = "ok  " if done.passed() else "FAIL"
            sys.stdout.write(
                f"{mark} {done.scenario:<12} seed {done.seed:<5} {done.outcome:<13}"
                f"{done.simulated_s:6.1f} s {done.simulated_s / done.wall_s:5.1f}x "
                f"falls {done.falls} collisions {done.collisions} {done.reason or ''}\n"
            )
            sys.stdout.flush()
    for scenario in options.scenarios:
        mine = [one for one in runs if one.scenario == scenario]
        passed = sum(one.passed() for one in mine)
        outcomes = dict(Counter(one.outcome for one in mine))
        error = np.median([one.odometry_error_m for one in mine])
        sys.stdout.write(
            f"{scenario:<12} {passed} of {len(mine)} passed, {outcomes}, "
            f"falls {sum(one.falls for one in mine)}, "
            f"collisions {sum(one.collisions for one in mine)}, odometry {100 * error:.1f} cm, "
            f"median {np.median([one.simulated_s for one in mine]):.1f} s, "
            f"real-time factor {np.median([one.simulated_s / one.wall_s for one in mine]):.1f}\n"
        )
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in runs], indent=1))


if __name__ == "__main__":
    main()
