"""What each rule of `terrain` is worth: recordings replayed without each rule in turn.

    python benches/rules_trial.py record corpus/    # a run of each course, once
    python benches/rules_trial.py replay corpus/    # each without each rule, to the first change
    python benches/rules_trial.py settings corpus/  # each with each number doubled and halved

A replay gives the core what was sensed then and stops where a command first differs from the
recorded one. A rule, or a number, that changes no command in any recording decided nothing there.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import treadwell
from treadwell.core_settings import build_core
from treadwell.errors import TreadwellError
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.observation_log import read_answers, read_observations
from treadwell.reference.parameters import find_parameters
from treadwell.replaying.difference import between_answers
from treadwell.replaying.source import open_source

RULES = (
    *("stair_cells", "far_levels", "lone_cells", "laid_stairs", "slopes", "gaps"),
    *("landing_edges", "height_differences", "shadows", "steep_slopes", "platform_edges"),
    *("tall_edges", "felt", "head_room", "voronoi", "edge_costs", "escape"),
)
"""Those that not all others build on."""
FAMILIES = {"random_house": 8, "random_yard": 6, "random_stairs": 4, "random_flat": 2}
"""Scenario -> seeds, from 0 on."""


def recorded(job: tuple[str, str | None, int, Path]) -> str:
    """Record a run; return a line on it."""
    scenario, robot, seed, folder = job
    name = f"{Path(scenario).stem}-{robot or 'own'}-{seed}"
    if (folder / name / "result.json").exists():
        return f"{name}: is there"
    try:
        run = treadwell.run(scenario, robot=robot, seed=seed, out=folder / name)
    except TreadwellError as error:
        return f"{name}: {error}"
    for path in run.folder.iterdir():
        if path.suffix in (".rrd", ".png"):
            path.unlink()
    return f"{name}: {run.outcome}"


def first_change(job: tuple[Path, tuple[str, ...]]) -> float | None:
    """Return when the core first answers otherwise with other settings, s; None where never."""
    folder, overrides = job
    source = open_source(folder, overrides)
    pilot = build_core(source.scenario, source.core.settings, {}, source.core.static_map)
    answers = read_answers(source.path)
    for observation, was in zip(read_observations(source.path), answers, strict=False):
        now, tick = observation.time_ns, pilot.tick(observation)
        answer = (
            encode_command(now, tick.positions, tick.velocities, tick.torques),
            encode_estimate(
                now, tick.estimate, tick.odometry, tick.state, tick.outcome, tick.reason
            ),
        )
        if between_answers(answer, was, source.joints) is not None:
            return 1e-9 * now
    return None


def safely(job: tuple[Path, tuple[str, ...]]) -> float | str | None:
    """Return when a change came first, None where none did, or why it cannot be told."""
    try:
        return first_change(job)
    except (TreadwellError, ValueError) as error:
        return str(error).splitlines()[0]


def doubled_and_halved() -> Iterator[tuple[str, str]]:
    """Return each number of the core's settings, twice and half as large, as overrides."""
    for one in find_parameters():
        value = one.default
        if not one.key.startswith("navigation.") or isinstance(value, bool):
            continue
        if isinstance(value, int | float) and value:
            for factor in (2.0, 0.5):
                scaled = value * factor
                scaled = int(scaled) if isinstance(value, int) else scaled
                yield one.key, f"{one.key}={scaled!r}"


def replayed(
    folders: Sequence[Path], variants: Sequence[tuple[str, str]], workers: int, out: Path
) -> None:
    """Replay every recording with every variant; print and write what changed."""
    jobs = [(folder, (override,)) for _, override in variants for folder in folders]
    rows: dict[str, dict[str, float | str | None]] = {override: {} for _, override in variants}
    with ProcessPoolExecutor(workers) as pool:
        for (folder, (override,)), found in zip(jobs, pool.map(safely, jobs), strict=True):
            row = rows[override]
            row[folder.name] = found
            if len(row) == len(folders):
                changed = [at for at in row.values() if isinstance(at, float)]
                refused = [why for why in row.values() if isinstance(why, str)]
                line = f"{override}: {len(changed)} of {len(folders)} recordings change"
                print(line + (f"; refused: {refused[0]}" if refused else ""), flush=True)
                out.write_text(json.dumps(rows, indent=1) + "\n")


def main() -> int:
    """Record or replay."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("record", "replay", "settings"))
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--courses", nargs="*", default=[], help="scenarios or files, beside the families"
    )
    parser.add_argument("--robots", nargs="*", default=[None], help="instead of the scenarios' own")
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    if options.what == "record":
        runs = [(name, seed) for name, count in FAMILIES.items() for seed in range(count)]
        runs = [(name, 0) for name in options.courses] if options.courses else runs
        options.folder.mkdir(parents=True, exist_ok=True)
        jobs = [(n, robot, seed, options.folder) for n, seed in runs for robot in options.robots]
        with ProcessPoolExecutor(options.workers) as pool:
            for line in pool.map(recorded, jobs):
                print(line, flush=True)
        return 0
    folders = sorted(path.parent for path in options.folder.glob("*/observations.mcap"))
    if options.what == "settings":
        replayed(
            folders, list(doubled_and_halved()), options.workers, options.folder / "settings.json"
        )
    else:
        variants = [(rule, f'navigation.terrain.left_out="{rule}"') for rule in RULES]
        replayed(folders, variants, options.workers, options.folder / "rules.json")
    return 0


if __name__ == "__main__":
    sys.exit(main())
