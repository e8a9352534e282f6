"""The panels of a comparison's figure: successes, paired differences, and the ways on a course."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon
from matplotlib.ticker import MaxNLocator

from treadwell.comparing.metrics import Metric
from treadwell.comparing.styles import Style
from treadwell.comparing.ways import Sketch, Ways

ALL: Final = "all"
"""The row of all scenarios together."""
_GRID: Final[dict[str, Any]] = {"color": "#dddddd", "linewidth": 0.5, "zorder": 0}
_COURSE: Final = "#666666"
_MARGIN_M: Final = 0.15
_LITTLE: Final = 0.1
"""Metres or radians below which differences are shown in thousandths."""
_SPREAD: Final = 0.62
"""Share of a scenario's row over which its sides are spread."""


def draw_successes(
    axes: Axes, document: dict[str, Any], chosen: Sequence[Style], *, grouped: bool
) -> None:
    """Draw each side's share of successes with Wilson's interval.

    Args:
        axes: to draw on.
        document: the comparison.
        chosen: the style of each side.
        grouped: whether a row is a scenario, the first one all of them; else a row is a side, with
            its count.
    """
    sides = document["candidates"]
    names = list(sides[0]["scenarios"])
    if grouped:
        rows = [[side["figures"]["success"] for side in sides]]
        rows += [[side["scenarios"][name] for side in sides] for name in names]
        labels = [ALL, *names]
    else:
        rows = [[side["figures"]["success"]] for side in sides]
        labels = [style.letter for style in chosen]
    for number, row in enumerate(rows):
        for index, figure in enumerate(row):
            style = chosen[index] if grouped else chosen[number]
            _share(axes, figure, number + _offset(index, len(row)), style)
        if grouped and number + 1 < len(rows):
            shade = "#e4e4e4" if number else "#999999"
            axes.axhline(number + 0.5, color=shade, linewidth=0.5)
        if not grouped:
            axes.annotate(
                f"{row[0]['yes']} of {row[0]['count']}", (1.0, number), (3, 0), va="center",
                xycoords=("axes fraction", "data"), textcoords="offset points",
                annotation_clip=False,
            )  # fmt: skip
    axes.set_yticks(range(len(labels)), labels)
    axes.set_ylim(len(labels) - 0.5, -0.5)
    axes.set_xlim(-3, 103)
    axes.set_xticks([0, 25, 50, 75, 100])
    axes.set_xlabel("success (%)")
    axes.grid(axis="x", **_GRID)
    axes.tick_params(axis="y", length=0)


def _offset(index: int, count: int) -> float:
    return _SPREAD * ((index + 0.5) / count - 0.5)


def _share(axes: Axes, figure: dict[str, Any], place: float, style: Style) -> None:
    """Draw one share; nothing of no episodes."""
    if figure["value"] is None:
        return
    low, high = 100 * figure["low"], 100 * figure["high"]
    axes.plot([low, high], [place, place], color=style.colour, linewidth=1.0, zorder=3)
    axes.plot(
        100 * figure["value"], place, style.marker, color=style.colour, markersize=3.6, zorder=4
    )


def draw_differences(
    axes: Axes, metric: Metric, found: Sequence[dict[str, Any]], letters: dict[str, str]
) -> None:
    """Draw paired differences of one figure with their intervals.

    A filled marker is a difference that the test shows, an open one is none; a dotted line goes
    through where so few pairs have no interval.

    Args:
        axes: to draw on.
        metric: which figure.
        found: its differences, a row each, from the top.
        letters: of the sides, by name.
    """
    scale, label = _scale(metric, found)
    for place, one in enumerate(found):
        if one["difference"] is None:
            continue
        at = scale * one["difference"]
        if one["low"] is None or one["high"] is None:
            axes.axhline(place, color="#000000", linewidth=0.8, linestyle=(0, (1, 2)), zorder=2)
            axes.plot([at], [place])  # the axis has to reach it
        else:
            limits = [scale * one["low"], scale * one["high"]]
            axes.plot(limits, [place, place], color="#000000", linewidth=1.0, zorder=2)
        shown = one["verdict"] in ("better", "worse")
        axes.plot(
            at, place, "o", color="#000000", markersize=4.0, markeredgewidth=0.8, zorder=4,
            markerfacecolor="#000000" if shown else "#ffffff",
        )  # fmt: skip
    axes.axvline(0.0, color="#000000", linewidth=0.6, zorder=1)
    axes.margins(x=0.12)
    labels = [f"{letters[one['other']]} − {letters[one['first']]}" for one in found]
    axes.set_yticks(range(len(found)), labels)
    axes.set_ylim(len(found) - 0.5, -0.5)
    axes.xaxis.set_major_locator(MaxNLocator(3))
    axes.set_xlabel(f"{label}\n{metric.better} is better")
    axes.grid(axis="x", **_GRID)
    axes.tick_params(axis="y", length=0)


def _scale(metric: Metric, found: Sequence[dict[str, Any]]) -> tuple[float, str]:
    """Return a factor and the name of an axis with its unit: percent, thousandths of little."""
    if metric.kind == "share":
        return 100.0, f"{metric.title} (%)"
    words, _, unit = metric.title.rpartition(" ")
    if not words or unit not in ("s", "m", "ms", "rad"):
        return 1.0, metric.title
    reached = [abs(one[key]) for one in found for key in ("difference", "low", "high") if one[key]]
    if unit in ("m", "rad") and max(reached, default=0.0) < _LITTLE:
        return 1000.0, f"{words} (m{unit})"
    return 1.0, f"{words} ({unit})"


def draw_ways(axes: Axes, found: Ways, chosen: Sequence[Style]) -> None:
    """Draw the course from above and the ways over it; a cross ends the way of a failure."""
    points = [way.places for way in found.ways.values()]
    if found.sketch is not None:
        _draw_sketch(axes, found.sketch)
        x, y, radius = found.sketch.goal
        points += [*found.sketch.obstacles, *found.sketch.floors]
        ends = [found.sketch.start, (x - radius, y - radius), (x + radius, y + radius)]
        points += [np.array(ends)]
    for number, way in sorted(found.ways.items()):
        style = chosen[number]
        axes.plot(
            *way.places.T, color=style.colour, linestyle=style.dashes, linewidth=1.1, zorder=5
        )
        if len(way.places):
            mark = style.marker if way.success else "x"
            axes.plot(
                *way.places[-1], mark, color=style.colour, markersize=3.6 if way.success else 6,
                markeredgewidth=0.8 if way.success else 1.4, zorder=6,
            )  # fmt: skip
    every = np.vstack([each for each in points if len(each)] or [np.zeros((1, 2))])
    (west, south), (east, north) = every.min(axis=0) - _MARGIN_M, every.max(axis=0) + _MARGIN_M
    axes.set_xlim(west, east)
    axes.set_ylim(south, north)
    axes.set_aspect("equal", adjustable="box")
    axes.xaxis.set_major_locator(MaxNLocator(6))
    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


def _draw_sketch(axes: Axes, sketch: Sketch) -> None:
    for outline in sketch.floors:
        _outline(axes, outline, facecolor="#f4f4f4", linewidth=0.6)
    for outline in sketch.obstacles:
        _outline(axes, outline, facecolor="#d0d0d0", linewidth=0.6)
    for outline in sketch.later:
        _outline(axes, outline, facecolor="none", linewidth=0.6, linestyle=(0, (2, 1.5)))
    x, y, radius = sketch.goal
    for place in sketch.via:
        axes.add_patch(Circle(place, radius, fill=False, linewidth=0.6, linestyle=":", zorder=2))
    axes.add_patch(
        Circle((x, y), radius, fill=False, hatch="////", edgecolor=_COURSE, linewidth=0.8, zorder=2)
    )
    axes.plot(
        *sketch.start, "o", color="#ffffff", markeredgecolor="#000000", markersize=5, zorder=6
    )
    for text, place, lift in (("start", sketch.start, 5), ("goal", (x, y + radius), 3)):
        axes.annotate(
            text, place, (0, lift), textcoords="offset points", ha="center", zorder=8,
            bbox={"facecolor": "#ffffffbb", "edgecolor": "none", "pad": 0.4},
        )  # fmt: skip


def _outline(axes: Axes, outline: Any, **looks: Any) -> None:  # noqa: ANN401 - Matplotlib's
    axes.add_patch(Polygon(outline, closed=True, edgecolor=_COURSE, zorder=1, **looks))
