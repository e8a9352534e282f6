"""Random staircases, low steps, steps at the limits, and basins: the counts in docs/results.md.

python benches/random_stairs.py ordinary --first 0 --count 20 --workers 2
python benches/random_stairs.py basin --count 20

Each number gives the same staircase, start and friction; the scenario files are kept with `--keep`.
"""

import argparse
import json
import math
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from climbs import step_summary
from episodes import Run, run, word

Table = dict[str, Any]
Draw = Callable[[np.random.Generator, int], Table]

BASINS = (0.08, 0.10, 0.12, 0.13, 0.15)
NARROWEST_BASIN = 0.125
"""Metres: Table I asks for a sole, 15 mm in front of it and 5 mm behind."""
LIMITS = (0.010, 0.015, 0.020, 0.030, 0.040, 0.050, 0.055)
CORRIDOR = 1.0


def ordinary(generator: np.random.Generator, _number: int) -> Table:
    """Two to five steps of 20 to 50 mm, 11 to 20 cm deep, 33 cm wide or wider, up or down."""
    return staircase(generator, 0.020, 0.050)


def low(generator: np.random.Generator, _number: int) -> Table:
    """The same with steps of 15 to 20 mm."""
    return staircase(generator, 0.015, 0.020)


def staircase(generator: np.random.Generator, lowest: float, highest: float) -> Table:
    """A staircase that stands free, all steps alike or each of its own height and depth."""
    count = int(generator.integers(2, 6))
    alike = bool(generator.integers(2))
    rises = generator.uniform(lowest, highest, count)
    treads = generator.uniform(0.11, 0.20, count)
    if alike:
        rises[:], treads[:] = rises[0], treads[0]
    width, down = float(generator.uniform(0.33, 0.9)), bool(generator.integers(2))
    start, physics = pose(generator)
    if not down:
        depth, top = float(treads[:-1].sum()), float(rises.sum())
        stairs = stairs_table((0.0, 0.0), 0.0, rises, treads, width, landing=0.40)
        goal = {"position": [depth + 0.2, 0.0], "height": top, "radius": 0.1}
        return scenario(start, goal, [stairs], physics)
    # From a platform down: the staircase ends at its edge, and the last rise is the platform's.
    top, depth = float(rises.sum()), float(treads[:-1].sum())
    course: list[Table] = [
        {"kind": "platform", "name": "top", "position": [-0.6, 0.0], "size": [1.2, 1.0, top]},
        stairs_table((depth, 0.0), math.pi, rises[:-1], treads[:-1], width, treads[-2]),
    ]
    goal = {"position": [depth + 0.6, 0.0], "height": 0.0}
    return scenario({**start, "height": top}, goal, course, physics)


def basin(generator: np.random.Generator, number: int) -> Table:
    """A basin of 8 to 15 cm across a corridor between two platforms 30 mm high."""
    gap = BASINS[number % len(BASINS)]
    start, physics = pose(generator)
    course: list[Table] = [
        {"kind": "platform", "name": "near", "position": [-0.6, 0.0], "size": [1.2, 1.0, 0.03]},
        {"kind": "platform", "name": "far", "position": [gap + 0.6, 0.0], "size": [1.2, 1.0, 0.03]},
        *corridor(-1.2, gap + 1.1, closed=True),
    ]
    goal = {"position": [gap + 0.7, 0.0], "height": 0.03}
    wide = gap > NARROWEST_BASIN
    return scenario({**start, "height": 0.03}, goal, course, physics, refused=not wide)


def limits(generator: np.random.Generator, number: int) -> Table:
    """One step of 10 to 55 mm across a corridor, a long platform behind it."""
    rise = LIMITS[number % len(LIMITS)]
    start, physics = pose(generator)
    course: list[Table] = [
        {"kind": "platform", "name": "step", "position": [0.6, 0.0], "size": [1.2, 1.0, rise]},
        *corridor(-1.2, 1.2, closed=False),
    ]
    goal = {"position": [0.6, 0.0]}
    return scenario(start, goal, course, physics, refused=rise > 0.05)


def pose(generator: np.random.Generator) -> tuple[Table, Table]:
    """Return start and physics: 0.4 to 0.8 m in front of x = 0, 20 degrees and 10 cm off."""
    x, y = -float(generator.uniform(0.4, 0.8)), float(generator.uniform(-0.1, 0.1))
    yaw = float(generator.uniform(-0.35, 0.35))
    return {"position": [x, y], "yaw": yaw}, {"friction": float(generator.uniform(0.6, 1.0))}


def stairs_table(
    position: tuple[float, float],
    yaw: float,
    rises: Iterable[float],
    treads: Iterable[float],
    width: float,
    landing: float,
) -> Table:
    """Return a `[[course]]` entry of stairs."""
    heights, depths = [float(r) for r in rises], [float(t) for t in treads]
    return {
        "kind": "stairs",
        "name": "stairs",
        "position": list(position),
        "yaw": yaw,
        "steps": len(heights),
        "rise": heights,
        "tread": depths,
        "width": width,
        "landing": float(landing),
    }


def corridor(begin: float, end: float, *, closed: bool) -> list[Table]:
    """Return walls on both sides and at the far end; where `closed`, at the near end too."""
    side = CORRIDOR / 2 + 0.025
    lines = [((begin, y), (end, y)) for y in (side, -side)] + [((end, -side), (end, side))]
    if closed:
        lines.append(((begin, -side), (begin, side)))
    return [{"kind": "wall", "from": list(a), "to": list(b), "height": 0.6} for a, b in lines]


def scenario(
    start: Table, goal: Table, course: list[Table], physics: Table, *, refused: bool = False
) -> Table:
    """Return a whole scenario."""
    outcome = "refused" if refused else "goal_reached"
    return {
        "schema": 1,
        "name": "random",
        "time_limit": 180.0,
        "start": start,
        "goal": goal,
        "course": course,
        "physics": physics,
        "expect": {"outcome": outcome},
    }


def toml(table: Table) -> str:
    """Write a scenario as TOML: every table inline, so that JSON's values are TOML's."""

    def value(item: object) -> str:
        if isinstance(item, dict):
            return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in item.items()) + " }"
        if isinstance(item, list):
            return "[" + ", ".join(value(entry) for entry in item) + "]"
        return json.dumps(item)

    return "".join(f"{key} = {value(item)}\n" for key, item in table.items())


FAMILIES: dict[str, Draw] = {"ordinary": ordinary, "low": low, "basin": basin, "limits": limits}


def measured_gap(one: Run, gap: float) -> float | None:
    """Return the depth that the robot believed the basin to have, m; None: it saw none."""
    near = [(abs(x - gap / 2), depth) for x, _, z, depth in one.depths if abs(z) < 0.015]
    near = [entry for entry in near if entry[0] < 0.06]
    return min(near)[1] if near else None


def described(family: str, number: int, table: Table, one: Run) -> str:
    """Return what was drawn, in a few words."""
    if family == "basin":
        gap = BASINS[number % len(BASINS)]
        measured = measured_gap(one, gap)
        error = "not seen" if measured is None else f"{1e3 * (measured - gap):+.1f} mm"
        return f"{1e3 * gap:.0f} mm, width error {error}"
    if family == "limits":
        return f"{1e3 * LIMITS[number % len(LIMITS)]:.0f} mm"
    stairs = table["course"][-1]
    way = "down" if table["course"][0]["kind"] == "platform" else "up"
    rises = " ".join(f"{1e3 * rise:.0f}" for rise in stairs["rise"])
    treads = " ".join(f"{1e2 * tread:.0f}" for tread in stairs["tread"])
    return f"{way} rises {rises} mm, treads {treads} cm, width {1e2 * stairs['width']:.0f} cm"


def group(family: str, number: int) -> str:
    """Return what a run is counted with."""
    if family == "basin":
        return f"basin {1e3 * BASINS[number % len(BASINS)]:.0f} mm"
    return f"step {1e3 * LIMITS[number % len(LIMITS)]:.0f} mm" if family == "limits" else family


def main() -> None:
    """Draw, run, print a line an episode and a row a group."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("family", choices=FAMILIES)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--keep", type=Path, help="folder in which the scenario files stay")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        numbers = range(options.first, options.first + options.count)
        tables, jobs = [], []
        for number in numbers:
            table = FAMILIES[options.family](np.random.default_rng([7, number]), number)
            path = folder / f"{options.family}_{number}.toml"
            path.write_text(toml(table))
            tables.append(table)
            jobs.append((str(path), number, tuple(options.overrides), False))
        runs: list[Run] = []
        with ProcessPoolExecutor(options.workers) as pool:
            for number, table, done in zip(numbers, tables, pool.map(run, jobs), strict=True):
                runs.append(done)
                sys.stdout.write(
                    f"{'ok  ' if done.passed() else 'FAIL'} {number:<4} "
                    f"{described(options.family, number, table, done)}: {done.outcome} "
                    f"{done.simulated_s:.1f} s, falls {done.falls}, up {done.climbed}, "
                    f"down {done.descended} {done.reason or ''} {', '.join(done.collisions)}\n"
                )
                sys.stdout.flush()
    for name in sorted({group(options.family, number) for number in numbers}):
        chosen = [
            one
            for number, one in zip(numbers, runs, strict=True)
            if group(options.family, number) == name
        ]
        sys.stdout.write(
            f"{name:<12} {sum(one.passed() for one in chosen)} of {len(chosen)} as expected, "
            f"{dict(Counter(word(one) for one in chosen))}, "
            f"falls {sum(one.falls for one in chosen)}, "
            f"collisions {sum(len(one.collisions) for one in chosen)}\n"
        )
    sys.stdout.write(step_summary([step for one in runs for step in one.steps]) + "\n")
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in runs], indent=1))


if __name__ == "__main__":
    main()
