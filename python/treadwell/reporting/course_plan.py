"""Where on the course robots failed: the course from above, a mark for each end."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from markupsafe import Markup, escape
from numpy.typing import NDArray

from treadwell.errors import TreadwellError
from treadwell.reporting.sweep_data import EpisodeRow

Floats = NDArray[np.float64]
_WIDTH, _TALLEST = 720, 420
_MARGIN: Final = 0.3
"""Metres around what is shown."""
_KINDS: Final = ("fell", "timed_out", "stuck", "refused", "error")
"""Outcomes with classes `m0` to `m4` of the style sheet; all others have `m5`."""
_FAR: Final = 1e4
"""Metres: an end farther off is not shown."""


def course_plan(rows: Sequence[EpisodeRow]) -> Markup:
    """Return a picture of where episodes of one line ended.

    The course is drawn where the scenario can still be loaded, as it is with the first row's seed;
    courses that are drawn at random differ from seed to seed.

    Args:
        rows: of one scenario, robot and variant, each with its end; at least one.
    """
    outlines, start, goal = _course(rows[0])
    ends = [row for row in rows if row.end is not None and max(map(abs, row.end)) < _FAR]
    places = np.array([row.end for row in ends]).reshape(-1, 2)
    points = [places, *outlines, *(each[None, :2] for each in (start, goal) if each is not None)]
    every = np.vstack([each for each in points if len(each)] or [np.zeros((1, 2))])
    low, high = every.min(axis=0) - _MARGIN, every.max(axis=0) + _MARGIN
    scale = min(_WIDTH / (high[0] - low[0]), _TALLEST / (high[1] - low[1]))
    height = (high[1] - low[1]) * scale

    def pixel(place: Floats) -> tuple[float, float]:
        return float((place[0] - low[0]) * scale), float(height - (place[1] - low[1]) * scale)

    parts = []
    for outline in outlines:
        corners = " ".join("{:.1f},{:.1f}".format(*pixel(corner)) for corner in outline)
        parts.append(f'<polygon class="course" points="{corners}"/>')
    if goal is not None:
        x, y = pixel(goal)
        parts.append(f'<circle class="goal" cx="{x:.1f}" cy="{y:.1f}" r="{goal[2] * scale:.1f}"/>')
    if start is not None:
        x, y = pixel(start)
        parts.append(f'<circle class="start" cx="{x:.1f}" cy="{y:.1f}" r="6"/>')
        parts.append(f'<text class="tick" x="{x + 9:.1f}" y="{y + 4:.1f}">start</text>')
    kinds = list(dict.fromkeys(row.outcome for row in ends))
    for row, place in zip(ends, places, strict=True):
        x, y = pixel(place)
        told = f"seed {row.seed}: {row.outcome} {row.reason}"
        parts.append(
            f'<circle class="end m{_kind(row.outcome)}" cx="{x:.1f}" cy="{y:.1f}" '
            f'r="5"><title>{escape(told)}</title></circle>'
        )
    keys = "".join(
        f'<span class="key n{_kind(kind)}">{escape(kind.replace("_", " "))}</span>'
        for kind in sorted(kinds, key=_kind)
    )
    name = " · ".join(word for word in rows[0].line if word)
    told = f"course of seed {rows[0].seed}" if outlines else "the course is not known here"
    caption = f"<figcaption>{escape(name)} ({escape(told)}) {keys}</figcaption>"
    svg = (
        f'<svg viewBox="0 0 {(high[0] - low[0]) * scale:.0f} {height:.0f}" role="img" '
        f'aria-label="{escape(name)}">{"".join(parts)}</svg>'
    )
    return Markup(f'<figure class="plan">{caption}{svg}</figure>')


def _kind(outcome: str) -> int:
    return _KINDS.index(outcome) if outcome in _KINDS else len(_KINDS)


def _course(row: EpisodeRow) -> tuple[list[Floats], Floats | None, Floats | None]:
    """Return outlines (n, 2), start (x, y) and goal (x, y, radius) m; nothing where unknown."""
    from treadwell.course.build import build_course
    from treadwell.robot.load import load_robot
    from treadwell.scenario.loading import load_scenario
    from treadwell.scenario.scaling import to_robot

    try:
        seed = int(row.seed)
        made = load_scenario(row.source, robot=row.robot_given, seed=seed, overrides=row.settings)
        robot = load_robot(made.robot)
        made = to_robot(made, robot)
        course = build_course(made, robot)
    except (TreadwellError, ValueError):
        return [], None, None
    outlines = [
        np.asarray(piece.outline, np.float64)
        for element in course.elements
        if element.present
        for piece in element.pieces
    ]
    goal = made.goal
    return (
        outlines,
        np.array(course.start.position, np.float64),
        np.array([*goal.position, goal.radius], np.float64),
    )
