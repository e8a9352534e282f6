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
from treadwell.comparing.power import fewest_pairs, pairs_for_power, threshold
from treadwell.comparing.statistics import LEVEL, holm, mcnemar, permutation, wilson
from treadwell.sweeps.row import Row

SCHEMA: Final = "treadwell.comparison/1"

MOST_EACH: Final = 12
"""Candidates up to which each is held against each: with 66 pairs and eleven figures there are 726
tests, and a permutation test of 20,000 draws can still show a difference after the correction. More
candidates are held against the first alone."""

NOT_SHOWN: Final = "no difference shown"
TOO_FEW: Final = "too few pairs"
"""What is said of a difference; else it is `better` or `worse`."""

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
    _judge([one for one in found if one["p"] is not None])
    for one in found:
        one.pop("tendency")
        one.pop("steps")
    return found


def _judge(tested: Sequence[dict[str, Any]]) -> None:
    """Note the corrected p of all tests, what each says, and how many pairs it would take."""
    ps = [one["p"] for one in tested]
    limits = _thresholds(ps)
    for one, p, limit in zip(tested, holm(ps), limits, strict=True):
        one["p_corrected"] = p
        least = fewest_pairs(one["test"], limit)
        one["pairs_least"] = least
        if p < LEVEL:
            one["verdict"] = one["tendency"]
        elif least is not None and one["pairs"] < least:
            one["verdict"] = TOO_FEW
        if p >= LEVEL:
            one["pairs_for_power"] = pairs_for_power(one["test"], one["steps"], limit)


def _thresholds(ps: Sequence[float]) -> list[float]:
    """Return of each test the p below which it is shown, the others being as they are."""
    # Tests of the same p have the same others.
    known = {p: threshold([*ps[: ps.index(p)], *ps[ps.index(p) + 1 :]]) for p in set(ps)}
    return [known[p] for p in ps]


def letter(number: int) -> str:
    """Return what stands for a candidate where names have no room: A, B, ...; from the 27th 27."""
    return chr(ord("A") + number) if number < 26 else str(number + 1)


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
        test, p = "mcnemar", mcnemar(lost, won)
        low, high = share_interval(kept, lost, won, len(both) - kept - lost - won)
    else:
        test, p = "permutation", permutation(steps)
        low, high = mean_interval(steps)
    mean = fmean(steps) if steps else None
    rises = mean is not None and mean > 0
    return {
        "metric": metric.name,
        "first": first.name,
        "other": other.name,
        "test": test,
        "pairs": len(both),
        "pairs_least": None,
        "pairs_for_power": None,
        "difference": mean,
        "low": low if both and math.isfinite(low) else None,
        "high": high if both and math.isfinite(high) else None,
        "p": p if both else None,
        "p_corrected": None,
        "verdict": NOT_SHOWN,
        "steps": steps,
        "tendency": "better" if rises == (metric.better == "more") else "worse",
    }
