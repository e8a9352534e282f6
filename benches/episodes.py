"""Many episodes of some scenarios, random seeds, every noise on: the counts in docs/results.

python benches/episodes.py slalom doorway --seeds 100-119 --workers 2
"""

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from into_results import add_options, write

from treadwell.episode import Episode
from treadwell.errors import TreadwellError
from treadwell.experiments.stairs import steps_row
from treadwell.measuring.step_watch import StepError, StepWatch
from treadwell.physics.recorded_audit import replay_audit


@dataclass(frozen=True)
class Run:
    """How one episode went."""

    scenario: str
    seed: int
    outcome: str
    reason: str | None
    falls: int
    collisions: list[str]
    simulated_s: float
    wall_s: float
    odometry_error_m: float
    odometry_error_rad: float
    stage_ms: dict[str, float]
    core_share: float
    audit: str
    expected: str
    climbed: int
    descended: int
    planned_steps: int
    states_s: dict[str, float]
    steps: list[StepError]

    def passed(self) -> bool:
        """Whether it did what the scenario expects, without a fall or a collision."""
        return self.outcome == self.expected and self.falls == 0 and not self.collisions


def run(job: tuple[str, int, tuple[str, ...], bool]) -> Run:
    """Run one episode without recording it."""
    scenario, seed, overrides, audited = job
    episode = Episode(scenario, seed=seed, overrides=overrides)
    start, step, problem = time.perf_counter(), None, None
    watch, states = StepWatch(episode), Counter[str]()
    try:
        while episode.verdict is None:
            step = episode.tick()
            watch.tick(step)
            states[step.state] += 1
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
        [f"{hit.robot_part} on {hit.element} at {hit.time:.1f} s" for hit in judge.collisions],
        1e-9 * episode.simulation.time_ns,
        wall,
        float(np.hypot(x - true.x, y - true.y)),
        float(abs(np.arctan2(np.sin(turn), np.cos(turn)))),
        {
            name: float(1e3 * np.median(values))
            for name, values in episode.seconds.items()
            if values
        },
        sum(sum(episode.seconds[stage]) for stage in episode.pilot.stages) / wall,
        replayed(episode) if audited else "not asked for",
        episode.scenario.expect.outcome,
        judge.stairs_climbed,
        judge.stairs_descended,
        watch.planned,
        {state: 0.01 * ticks for state, ticks in states.items()},
        watch.steps,
    )


def replayed(episode: Episode) -> str:
    """Let plain MuJoCo step the run again: `same`, or where it first differs."""
    with tempfile.TemporaryDirectory() as folder:
        episode.simulation.save_audit(Path(folder))
        row = replay_audit(Path(folder))
    return "same" if row is None else f"differs from row {row}"


def seeds(text: str) -> list[int]:
    """Read `100-119` or `3`."""
    first, _, last = text.partition("-")
    return list(range(int(first), int(last or first) + 1))


def summary(scenario: str, runs: list[Run]) -> str:
    """Return the row of a scenario."""
    outcomes = dict(Counter(word(one) for one in runs))
    states = sorted({state for one in runs for state in one.states_s})
    spent = {s: np.median([one.states_s.get(s, 0.0) for one in runs]) for s in states}
    climbed = Counter(f"{one.climbed} up {one.descended} down" for one in runs)
    steps = [step for one in runs for step in one.steps]
    audits = Counter(one.audit for one in runs)
    return (
        f"{scenario:<12} {sum(one.passed() for one in runs)} of {len(runs)} passed, {outcomes}, "
        f"falls {sum(one.falls for one in runs)}, "
        f"collisions {sum(len(one.collisions) for one in runs)}, "
        f"odometry {100 * np.median([one.odometry_error_m for one in runs]):.1f} cm, "
        f"{np.degrees(np.median([one.odometry_error_rad for one in runs])):.2f} degrees, "
        f"median {np.median([one.simulated_s for one in runs]):.1f} s, "
        f"audits {dict(audits)}\n"
        f"{'':<12} {dict(climbed)}; {'; '.join(steps_row(scenario, steps)[1:])}\n"
        f"{'':<12} median seconds {', '.join(f'{s} {spent[s]:.1f}' for s in states)}\n"
    )


def results_row(scenario: str, runs: list[Run], *, audited: bool) -> dict[str, object]:
    """Return the row of a scenario in docs/results."""
    measured = {
        "passed": f"{sum(one.passed() for one in runs)} of {len(runs)}",
        "falls": str(sum(one.falls for one in runs)),
        "collisions": str(sum(len(one.collisions) for one in runs)),
        "simulated time, median": f"{np.median([one.simulated_s for one in runs]):.1f} s",
        "odometry at the end, median": (
            f"{100 * np.median([one.odometry_error_m for one in runs]):.1f} cm"
        ),
    }
    if audited:
        measured["audits that are the same"] = str(sum(one.audit == "same" for one in runs))
    return {"what": f"`{scenario}`", "measured": measured}


def word(one: Run) -> str:
    """Return how a run ended: the outcome, or the word of the reason behind it."""
    reason = (one.reason or "").partition(":")[0]
    return f"{one.outcome} {reason}".strip()


def timing(runs: list[Run]) -> str:
    """Return medians over the runs: real-time factor, the core's share, each stage."""
    factor = np.median([one.simulated_s / one.wall_s for one in runs])
    share = np.median([one.core_share for one in runs])
    names = sorted({name for one in runs for name in one.stage_ms})
    stages = {n: np.median([one.stage_ms[n] for one in runs if n in one.stage_ms]) for n in names}
    listed = ", ".join(f"{name} {value:.3f}" for name, value in stages.items())
    return f"real-time factor {factor:.1f}, core {100 * share:.0f} % of the wall; ms: {listed}\n"


def main() -> None:
    """Run, print a line an episode and a row a scenario, write JSON where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", nargs="+")
    parser.add_argument("--seeds", type=seeds, default=list(range(20)))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--audit", action="store_true", help="step every run again in plain MuJoCo")
    parser.add_argument("--json", type=Path)
    add_options(parser)
    options = parser.parse_args()
    jobs = [
        (scenario, seed, tuple(options.overrides), options.audit)
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
                f"falls {done.falls} collisions {len(done.collisions)} "
                f"up {done.climbed} down {done.descended} planned {done.planned_steps} "
                f"{done.reason or ''} {', '.join(done.collisions)}\n"
            )
            sys.stdout.flush()
    for scenario in options.scenarios:
        sys.stdout.write(summary(scenario, [one for one in runs if one.scenario == scenario]))
    sys.stdout.write(timing(runs))
    rows = [
        results_row(name, [one for one in runs if one.scenario == name], audited=options.audit)
        for name in options.scenarios
    ]
    write(options, "Passed", options.seeds, rows)
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in runs], indent=1))


if __name__ == "__main__":
    main()
