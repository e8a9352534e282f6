"""Slopes, and surfaces above each other: their tables of the experiment `fog`."""

import math
from collections.abc import Iterable
from typing import Final

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import NOTHING, THE_PAPER, Results, Table, middle, share
from treadwell.measuring.ceiling_watch import CeilingErrors
from treadwell.measuring.element_watch import ElementCells


def ceilings(results: Results) -> Table:
    """Return the table of beams over the way: found where they are, and passed or not."""
    rows = []
    for name in cases.BEAMS:
        runs = results.get(name, ())
        found: list[CeilingErrors] = [run.findings for run in runs]
        errors = [1e3 * error for one in found for error in one.errors]
        if runs:
            rows.append(
                (
                    name,
                    share(sum(run.passed for run in runs), len(runs)),
                    str(len(errors)),
                    middle([abs(error) for error in errors]),
                    f"{max(map(abs, errors)):.0f}" if errors else NOTHING,
                    f"{100 * sum(one.free for one in found) / max(len(errors), 1):.1f}",
                )
            )
    return Table(
        "A beam over the way (section VI)",
        ("case", "as expected", "cells with a ceiling", "median error, mm", "worst", "free, %"),
        tuple(rows),
        (
            "beam_seen: from where the robot stands, 0.65 to 0.7 m above the floor, and at 0.5 m; "
            "all its cells are to be free, and none. By the paper: it proposes a ceiling map and "
            "has none, so that every beam is an obstacle. beam_high and beam_low: walked under "
            "and refused. Wanted: 40 mm; always right.",
        ),
    )


def slopes_walked(results: Results) -> Table:
    """Return the table of slopes that are walked up and down, or refused."""
    rows = []
    for angle in cases.SLOPES:
        cells = []
        for name in (cases.slope_up(angle), cases.slope_down(angle)):
            runs = results.get(name, ())
            fell = sum(run.result.falls for run in runs)
            reached = sum(run.outcome == "goal_reached" for run in runs)
            refused = sum(run.outcome == "refused" for run in runs)
            cells.append(f"{reached} / {refused} / {fell} / {len(runs)}" if runs else NOTHING)
        if set(cells) != {NOTHING}:
            rows.append((f"{angle}", *cells))
    return Table(
        "Slopes of one metre, walked (section VI)",
        ("degrees", "up: goal / refused / falls / of", "down: the same"),
        tuple(rows),
        (
            "The paper: only horizontal planes. Wanted: up to 10 "
            "degrees walked; 15 degrees refused.",
        ),
    )


_PAPER: Final = {
    "slope": "no floor",
    "curtain": "obstacle",
    "table": "floor at its top",
    "box below": "the table's height",
}
"""What the paper says of each element."""


def surfaces(results: Results) -> Table:
    """Return the table of what the map has of a slope and of what lies above each other."""
    elements: dict[str, list[ElementCells]] = {}
    for name in (cases.SLOPE, cases.OVER):
        for run in results.get(name, ()):
            for one in run.findings:
                elements.setdefault(one.name, []).append(one)
    return Table(
        "A slope of 5 to 10 degrees; a curtain; a table with a box below it (sections III, VI)",
        (
            "element",
            "cells",
            "floor, %",
            "obstacle, %",
            "floor off its top, mm",
            "tilt, degrees",
            THE_PAPER,
        ),
        tuple((name, *_shares(some), _PAPER.get(name, NOTHING)) for name, some in elements.items()),
        (
            "Of cells in the end. The paper: of two surfaces the higher one is kept, and what lies "
            "below is ignored, so that the box's cells have the table's height.",
        ),
    )


def _shares(some: Iterable[ElementCells]) -> tuple[str, ...]:
    counted = list(some)
    cells = sum(one.cells for one in counted)
    errors = [1e3 * error for one in counted for error in one.errors]
    tilts = [math.degrees(one.tilt_error) for one in counted if one.tilt_error is not None]
    return (
        str(cells),
        f"{100 * sum(one.floor for one in counted) / max(cells, 1):.1f}",
        f"{100 * sum(one.obstacle for one in counted) / max(cells, 1):.1f}",
        middle(errors),
        middle(tilts, 2),
    )
