"""Candidates side by side: each one's figures, and where one differs from another."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from statistics import fmean, median
from typing import Any, Final

from treadwell.comparing.intervals import mean_interval, share_interval
from treadwell.comparing.metrics import METRICS, Metric
from treadwell.comparing.statistics import LEVEL, holm, mcnemar, permutation, wilson
from treadwell.sweeps.row import Row

SCHEMA: Final = "treadwell.comparison/1"

MOST_EACH: Final = 12
"""Candidates up to which each is held against each: with 66 pairs and eleven figures there are 726
tests, and a permutation test of 20,000 draws can still show a difference after the correction. More
candidates are held against the first alone."""

Pair = tuple[str, str, int]


@dataclass(frozen=True, slots=True)
class Candidate:
    """One side: a sweep, or a variant of one.

    Attributes:
        name: what it is called in the tables.
        rows: its episodes.
        folder: of its sweep, in which recordings are; None: nobody knows of any.
    """

    name: str
    rows: tuple[Row, ...]
    folder: Path | None = None


def compared(candidates: Sequence[Candidate]) -> dict[str, Any]:
    """Return the comparison as plain data.

    Args:
        candidates: in the order of the tables.
    """
    scenarios = list(dict.fromkeys(row.scenario for one in candidates for row in one.rows))
    found = differences(candidates)
    return {
        "schema": SCHEMA,
        "candidates": [
            {
                "name": one.name,
                "episodes": len(one.rows),
                "figures": {metric.name: figure(metric, one.rows) for metric in METRICS},
                "scenarios": {
                    name: figure(METRICS[0], [row for row in one.rows if row.scenario == name])
                    for name in scenarios
                },
            }
            for one in candidates
        ],
        "against": "each" if len(candidates) <= MOST_EACH else "first",
        "correction": "holm",
        "level": LEVEL,
        "tests": sum(one["p"] is not None for one in found),
        "differences": found,
    }


def figure(metric: Metric, rows: Sequence[Row]) -> dict[str, Any]:
    """Return a metric over rows: `value` (None of nothing) and `count`; of a share the interval."""
    found = [value for value in map(metric.of, rows) if value is not None]
    if metric.kind == "share":
        yes = sum(map(bool, found))
        low, high = wilson(yes, len(found))
        share = yes / len(found) if found else None
        return {"value": share, "count": len(found), "yes": yes, "low": low, "high": high}
    middle = fmean if metric.kind == "mean" else median
    return {"value": float(middle(found)) if found else None, "count": len(found)}


def differences(candidates: Sequence[Candidate]) -> list[dict[str, Any]]:
    """Return each figure of each pair of candidates, by the episodes that both have.

    All are corrected together after Holm. Of more than `MOST_EACH` candidates only the pairs with
    the first are there.
    """
    # Where robots are compared with each other, the same seed on the same scenario is a pair.
    by_robot = any(
        len({(row.scenario, row.seed) for row in one.rows}) < len(one.rows) for one in candidates
    )
    rows = [_by_pair(one, by_robot=by_robot) for one in candidates]
    found: list[dict[str, Any]] = []
    for a, b in combinations(range(len(candidates)), 2):
        if a and len(candidates) > MOST_EACH:
            break
        pairs = [(rows[a][key], rows[b][key]) for key in sorted(rows[a].keys() & rows[b].keys())]
        found += [_difference(metric, pairs, candidates[a], candidates[b]) for metric in METRICS]
    tested = [one for one in found if one["p"] is not None]
    for one, p in zip(tested, holm([one["p"] for one in tested]), strict=True):
        one["p_corrected"] = p
        if p < LEVEL:
            one["verdict"] = one.pop("tendency")
    for one in found:
        one.pop("tendency", None)
    return found


def _by_pair(candidate: Candidate, *, by_robot: bool) -> dict[Pair, Row]:
    return {(row.scenario, row.robot if by_robot else "", row.seed): row for row in candidate.rows}


def _difference(
    metric: Metric, pairs: Sequence[tuple[Row, Row]], first: Candidate, other: Candidate
) -> dict[str, Any]:
    """Return one test: mean difference (other minus first), p, and which way it would be."""
    values = [(metric.of(a), metric.of(b)) for a, b in pairs]
    both = [(float(a), float(b)) for a, b in values if a is not None and b is not None]
    steps = [b - a for a, b in both]
    if metric.kind == "share":
        lost, won = sum(step < 0 for step in steps), sum(step > 0 for step in steps)
        kept = sum(a > 0 for a, b in both) - lost
        p = mcnemar(lost, won)
        low, high = share_interval(kept, lost, won, len(both) - kept - lost - won)
    else:
        p = permutation(steps)
        low, high = mean_interval(steps)
    mean = fmean(steps) if steps else None
    rises = mean is not None and mean > 0
    return {
        "metric": metric.name,
        "first": first.name,
        "other": other.name,
        "pairs": len(both),
        "difference": mean,
        "low": low if both and math.isfinite(low) else None,
        "high": high if both and math.isfinite(high) else None,
        "p": p if both else None,
        "p_corrected": None,
        "verdict": "no difference shown",
        "tendency": "better" if rises == (metric.better == "more") else "worse",
    }
