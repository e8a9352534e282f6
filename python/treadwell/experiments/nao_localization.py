"""Where the robot believed to be: Table I and Fig. 5 of the experiment `nao`, and being lost."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.experiments import nao_cases as cases
from treadwell.experiments.experiment import NOTHING, Results, Table, middle, share
from treadwell.measuring.walk_watch import Walk
from treadwell.runner import Run

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

LOST_M: Final = 0.5
"""A run is lost where the believed place is further off than this in the plane."""
BIN_S: Final = 10.0
"""Width of the bins of Fig. 5."""
FOUND_M, FOUND_RAD, LEVEL_M = 0.2, 0.2, 0.1
"""The robot knows where it is when place, heading and height are no further off."""
WALKING_M, WALKING_RAD = 0.002, 0.01
"""From one frame to the next a robot that walks moves or turns at least by so much."""
SOON_S: Final = 20.0
"""Seconds of walking within which it has to know."""
HALLWAY: Final = (1.3, 1.0)
"""The hallway of `two_levels`: x above the first and y below the second, m."""


def accuracy(results: Results) -> Table:
    """Return Table I of the paper with ours beside it."""
    rows = []
    for one in cases.SCENARIOS:
        for model in cases.WORLD_MODELS:
            runs = results.get(cases.walked(one.number, model), ())
            if walks := [run.findings for run in runs if len(run.findings.times)]:
                paper = f"{one.mean:.2f} ± {one.std:.2f}"
                name = f"{one.number}, {model}"
                rows.append((name, paper, f"{one.wanted:.2f}", *_accuracy(runs, walks)))
    return Table(
        "Error of the believed place in the plane (Table I; odometry: Fig. 3)",
        (
            "scenario, map",
            "the paper, m",
            "wanted",
            "mean ± sd",
            "worst run's mean",
            "largest",
            "lost",
            "odometry, mean",
            "odometry, in the end",
            "walked, s",
            "goal",
        ),
        tuple(rows),
        (
            "All frames of all runs that the robot walked, with the localizer monte_carlo. "
            f"Lost: runs with an error above {LOST_M:g} m at any time. Odometry: median of the "
            "runs. The paper: odometry is clearly useless.",
        ),
    )


def _accuracy(runs: Sequence[Run], walks: Sequence[Walk]) -> tuple[str, ...]:
    errors = [walk.errors() for walk in walks]
    together = np.concatenate(errors)
    odometry = [walk.odometry_errors() for walk in walks]
    return (
        f"{together.mean():.3f} ± {together.std():.3f}",
        f"{max(one.mean() for one in errors):.3f}",
        f"{together.max():.3f}",
        share(sum(bool(one.max() > LOST_M) for one in errors), len(errors)),
        middle([float(one.mean()) for one in odometry], 2),
        middle([float(one[-1]) for one in odometry], 2),
        middle([float(walk.times[-1]) for walk in walks], 0),
        share(sum(run.outcome == "goal_reached" for run in runs), len(runs)),
    )


def filter_walks(results: Results) -> list[Walk]:
    """Return the walk of scenario 1 with the first seed as each of the filters believed it."""
    names = [cases.walked(1, "octree"), *(cases.filtered(i) for i in range(1, cases.FILTERS))]
    runs = [run for name in names for run in results.get(name, ())[:1]]
    return [run.findings for run in runs if run.outcome != "error" and len(run.findings.times)]


def binned(walks: Sequence[Walk]) -> Floats:
    """Return Fig. 5: (n, 3) middle of each bin of time, s, mean and standard deviation there, m."""
    times = np.concatenate([walk.times for walk in walks])
    errors = np.concatenate([walk.errors() for walk in walks])
    place = (times // BIN_S).astype(int)
    rows = [
        ((bin_ + 0.5) * BIN_S, errors[place == bin_].mean(), errors[place == bin_].std())
        for bin_ in np.unique(place)
    ]
    return np.array(rows)


def in_hallway(walk: Walk) -> Bools:
    """Say for each frame whether the robot truly was in the hallway."""
    inside: Bools = (walk.true[:, 0] > HALLWAY[0]) & (walk.true[:, 1] < HALLWAY[1])
    return inside


def hallway(results: Results) -> Table:
    """Return the table of Fig. 5: the rise of the error in the hallway."""
    walks = filter_walks(results)
    inside = np.concatenate([in_hallway(walk) for walk in walks] or [np.zeros(0, dtype=bool)])
    rows: tuple[tuple[str, ...], ...] = ()
    if inside.any() and not inside.all():
        errors = 1e3 * np.concatenate([walk.errors() for walk in walks])
        within, without = float(errors[inside].mean()), float(errors[~inside].mean())
        means = 1e3 * binned(walks)[:, 1]
        scatter = float(np.std([1e3 * walk.errors().mean() for walk in walks]))
        ours = (f"{within:.0f}", f"{without:.0f}", f"{within - without:+.0f}")
        spread = (f"{means.min():.0f} to {means.max():.0f}", f"{scatter:.0f}")
        rows = (
            ("the paper", "100", "60", "+40", NOTHING, NOTHING),
            ("wanted", NOTHING, NOTHING, "at most +20", NOTHING, "at most 30"),
            (f"ours, {len(walks)} filters", *ours, *spread),
        )
    return Table(
        "Error in the hallway, mm (Fig. 5)",
        ("", "in the hallway", "elsewhere", "rise", "bins of 10 s", "filter to filter, sd"),
        rows,
        (
            "Filters over the same data, as in the paper: scenario 1 of one seed, which the robot "
            "walks by the first of them; for each other one the walk is repeated, bit for bit, "
            "recorded, and replayed with `navigation.monte_carlo.seed` of its own.",
        ),
    )


def finding(results: Results) -> Table:
    """Return the table of a robot that is not told where it starts, or is carried off."""
    rows = tuple(
        (name, "18 of 20", *_finding(runs))
        for name in cases.FINDING
        if (runs := [run for run in results.get(name, ()) if len(run.findings.times)])
    )
    return Table(
        "Finding out where it is, on two levels (the paper: not reported)",
        ("case", "wanted", "found soon", "found at all", "s of walking", "s", "goal", "falls"),
        rows,
        (
            f"Found: from then on within {FOUND_M:g} m, {FOUND_RAD:g} rad, and on the right "
            f"level, {LEVEL_M:g} m. Soon: within {SOON_S:g} s of walking, counted from the start "
            "or since it was carried off; frames between which the robot stood do not count.",
        ),
    )


def _finding(runs: Sequence[Run]) -> tuple[str, ...]:
    found = [found_after(run.findings) for run in runs]
    made = [one for one in found if one is not None]
    return (
        share(sum(walking <= SOON_S for _, walking in made), len(runs)),
        share(len(made), len(runs)),
        middle([walking for _, walking in made]),
        middle([seconds for seconds, _ in made]),
        share(sum(run.outcome == "goal_reached" for run in runs), len(runs)),
        str(sum(run.result.falls for run in runs)),
    )


def found_after(walk: Walk) -> tuple[float, float] | None:
    """Return after how many s, and s of walking, the robot knew for good; None where it did not."""
    off = (walk.errors() > FOUND_M) | (walk.heading_errors() > FOUND_RAD)
    off |= np.abs(walk.believed[:, 2] - walk.true[:, 2]) > LEVEL_M
    counts = walk.times >= walk.carried
    wrong = np.flatnonzero(off & counts)
    first = int(wrong[-1]) + 1 if len(wrong) else int(np.argmax(counts))
    if first >= len(walk.times) or not counts.any():
        return None
    span = counts[:-1] & counts[1:] & (np.arange(1, len(walk.times)) <= first)
    lasted = np.diff(walk.times)
    return float(walk.times[first] - walk.carried), float(lasted[span & _walks(walk)].sum())


def _walks(walk: Walk) -> Bools:
    """Say for each pair of frames in a row whether the robot walked between them, (n - 1,)."""
    way = np.hypot(*np.diff(walk.true[:, :2], axis=0).T)
    turn = np.abs((np.diff(walk.true[:, 3]) + math.pi) % math.tau - math.pi)
    walks: Bools = (way > WALKING_M) | (turn > WALKING_RAD)
    return walks
