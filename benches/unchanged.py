"""Whether a change leaves every run as it was, to the last bit: for changes that only move code.

    python benches/unchanged.py record FOLDER     # at the commit before
    python benches/unchanged.py check FOLDER      # at any later one: 0 where nothing changed

`record` keeps 12 scenarios x 2 seeds, and a short run of each part that none of them names (600 MB,
not committed). `check` replays each recording and compares every joint target and every belief;
then it runs each scenario again and compares both trajectories, the map, `physics.npz` and
`result.json` but for `configuration`, `version` and times. It names run and tick where two part.
`--replay-only` leaves the second half out, `--only NAME` takes the runs whose name has NAME in it.
"""

import argparse
import json
import shutil
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import treadwell

NOT_COMPARED = {
    "configuration",
    "version",
    "wall_seconds",
    "real_time_factor",
    "physics_real_time_factor",
    "timing_ms",
}


@dataclass(frozen=True)
class Case:
    """One run: a scenario, and what it is run with."""

    scenario: str
    robot: str
    seed: int = 0
    overrides: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The name of its folder."""
        words = [value.partition("=")[2] for value in self.overrides if "time_limit" not in value]
        return "-".join((self.scenario, self.robot, *words, str(self.seed)))


def _long() -> Iterator[Case]:
    for seed in (0, 1):
        yield Case("two_levels", "nao", seed)
        yield Case("kidnapped", "nao", seed)
        yield Case("obstacle_course", "qrio", seed)
        yield Case("obstacle_course", "nao", seed)
        yield Case("stairs_over", "qrio", seed)
        yield Case("stairs_down", "nao", seed)
        yield Case("stairs_too_high", "qrio", seed)
        yield Case("slalom", "qrio", seed)
        yield Case("visitor", "qrio", seed)
        yield Case("slope_up", "nao", seed)
        yield Case("random_stairs", "qrio", seed, ("navigation.behaviour=continuous",))
        yield Case("random_flat", "nao", seed, ("navigation.planner=voronoi",))


def _short() -> Iterator[Case]:
    """Twelve seconds of each part that no scenario above names."""
    for part in (
        "segmenter=scan_line_1994",
        "segmenter=scan_line_adaptive",
        "segmenter=hough",
        "segmenter=ransac",
        "segmenter=histogram",
        "world_model=averaging",
        "world_model=octree",
        "localizer=scan_match",
        "behaviour=walking",
        "a_star.footprint=oriented",
        "fog.update=per_point",
        "fog.clearing=projected",
    ):
        scenario = "slalom" if "walking" in part else "sill"
        yield Case(scenario, "qrio", 0, (f"navigation.{part}", "time_limit=12"))


def record(case: Case, folder: Path) -> str:
    """Run a case and keep its folder."""
    out = folder / case.name
    if (out / "result.json").exists():
        return "is there"
    shutil.rmtree(out, ignore_errors=True)
    run = treadwell.run(
        case.scenario, robot=case.robot, seed=case.seed, overrides=case.overrides, out=out
    )
    (out / "recording.rrd").unlink()
    (out / "case.json").write_text(json.dumps(asdict(case)))
    return f"{run.result.simulated_seconds:.1f} s, {run.outcome}"


def check(case: Case, folder: Path, replay_only: bool) -> str | None:
    """Return where a case parts from its recording, None where nothing differs."""
    was = folder / case.name
    scratch = Path(tempfile.mkdtemp())
    try:
        found = _replayed(was, scratch / "replay")
        if found is None and not replay_only:
            treadwell.run(
                case.scenario,
                robot=case.robot,
                seed=case.seed,
                overrides=case.overrides,
                out=scratch / "run",
                record=False,
            )
            found = _parted(was, scratch / "run")
        return found
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _replayed(was: Path, out: Path) -> str | None:
    done = treadwell.replay(was, out=out)
    facts = done.result.replay
    if facts.first_difference is not None:
        first = facts.first_difference
        return f"replay: tick {first.tick}, {first.time:.2f} s: {first.what}"
    if facts.error is not None or facts.compared != facts.observations or not facts.compared:
        return f"replay: {facts.error}, {facts.compared} of {facts.observations} ticks compared"
    if (was / "trajectory.tum").read_bytes() != (out / "trajectory.tum").read_bytes():
        return "replay: trajectory.tum"
    return None


def _parted(was: Path, now: Path) -> str | None:
    """Compare the files of two runs, what happened first before what follows from it."""
    for name, ticks_a_row in (("physics.npz", 1), ("map.npz", None)):
        found = _arrays(was / name, now / name, ticks_a_row)
        if found:
            return f"run: {name}: {found}"
    for name in ("trajectory.tum", "trajectory_truth.tum"):
        a, b = ((folder / name).read_text().splitlines() for folder in (was, now))
        if a != b:
            row = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), len(a))
            return f"run: {name}: row {row}"
    before, after = (json.loads((folder / "result.json").read_text()) for folder in (was, now))
    for key in sorted((before.keys() | after.keys()) - NOT_COMPARED):
        if before.get(key) != after.get(key):
            return f"run: result.json: {key}: {after.get(key)!r} instead of {before.get(key)!r}"
    return None


def _arrays(was: Path, now: Path, ticks_a_row: int | None) -> str | None:
    with np.load(was) as before, np.load(now) as after:
        if set(before.files) != set(after.files):
            return f"holds {sorted(after.files)} instead of {sorted(before.files)}"
        for name in sorted(before.files):
            a, b = before[name], after[name]
            if a.tobytes() == b.tobytes() and a.shape == b.shape and a.dtype == b.dtype:
                continue
            if a.shape[1:] != b.shape[1:] or not a.ndim:
                return name
            length = min(len(a), len(b))
            same = np.array([a[i].tobytes() == b[i].tobytes() for i in range(length)])
            row = int(np.argmin(same)) if not same.all() else length
            if ticks_a_row is None:
                return f"{name}: row {row}"
            steps_a_tick = len(before["ctrl"]) // max(1, len(before["qpos"]))
            tick = row // steps_a_tick if name == "ctrl" else row
            return f"{name}: row {row}, tick {tick}"
    return None


def recorded(folder: Path) -> list[Case]:
    """Return what a folder holds."""
    found = []
    for path in sorted(folder.glob("*/case.json")):
        fields: dict[str, Any] = json.loads(path.read_text())
        found.append(Case(**{**fields, "overrides": tuple(fields["overrides"])}))
    return found


def main() -> int:
    """Record, or check and return 1 where anything differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("verb", choices=("record", "check"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", default="", help="part of a name")
    parser.add_argument("--replay-only", action="store_true")
    parser.add_argument("--seconds", type=float, help="of each run that is recorded, at most")
    options = parser.parse_args()
    folder: Path = options.folder
    folder.mkdir(parents=True, exist_ok=True)
    every = [*_long(), *_short()] if options.verb == "record" else recorded(folder)
    cases = [case for case in every if options.only in case.name]
    if options.seconds is not None and options.verb == "record":
        limit = f"time_limit={options.seconds}"
        cases = [replace(case, overrides=(*case.overrides, limit)) for case in cases]
    if not cases:
        print(f"{folder}: no recording whose name has {options.only!r} in it", file=sys.stderr)
        return 2
    differing = 0
    with ProcessPoolExecutor(options.workers) as pool:
        if options.verb == "record":
            asked = {pool.submit(record, case, folder): case for case in cases}
        else:
            asked = {pool.submit(check, c, folder, options.replay_only): c for c in cases}
        for done in as_completed(asked):
            said = done.result()
            if options.verb == "check":
                differing += said is not None
                said = "the same" if said is None else f"DIFFERS  {said}"
            print(f"{asked[done].name:44s} {said}", flush=True)
    if options.verb == "check":
        print(f"the same: {len(cases) - differing} of {len(cases)}")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
