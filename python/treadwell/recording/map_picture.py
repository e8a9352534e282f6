"""`map.png`: the remembered map from above, with the true course and the ways over it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from treadwell.files import whole_file
from treadwell.judging.result import Result
from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, RememberedMap
from treadwell.recording.sole_outlines import draw_soles
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.stair_outlines import draw_stairs
from treadwell.recording.step_memory import StepMemory
from treadwell.recording.trajectory import Trajectory, jumps
from treadwell.scenario.model import Goal
from treadwell.scenario.scaling import multiplied
from treadwell.scenario.types import Scale

if TYPE_CHECKING:
    # A map of somebody's data is drawn by the same functions without MuJoCo, which builds courses.
    from treadwell.course.course import Course

_UNKNOWN: Final = (0.80, 0.80, 0.82)
_OBSTACLE: Final = (0.09, 0.09, 0.11)
_BELIEVED, _CLIMBED, _TRUE, _OUTLINE, _GOAL = "#ff5fa2", "#7d3cd7", "#ffffff", "#e4572e", "#b8f53d"
_TRUE_COURSE: Final = "true course"
_LEAST_SPAN: Final = 0.02
"""Metres that the colours span at least, to either side of the middle."""
_MARGIN: Final = 0.25
LABELS_INCHES: Final = 0.45
"""Room below the map for the numbers and the name of its axis, whatever the map's height."""


@dataclass(frozen=True, slots=True)
class Caption:
    """What a picture says of its run.

    Attributes:
        title: what was run and what came of it, two lines.
        goal: the scenario's table, in the lengths in which it is written.
    """

    title: str
    goal: Mapping[str, Any]


def caption_of(result: Result) -> Caption:
    """Return what the picture of a whole run says."""
    outcome = result.outcome.replace("_", " ")
    if result.reason:
        outcome += f" · {result.reason.split(':')[0].replace('_', ' ')}"
    facts = f"{outcome} after {result.simulated_seconds:.1f} s, {result.path_length:.2f} m"
    if result.falls:
        facts += f", {result.falls} fall{'s' if result.falls > 1 else ''}"
    hits = len(result.collisions)
    facts += f", {hits} collision{'' if hits == 1 else 's'}"
    title = f"{result.scenario} · {result.robot} · seed {result.seed}\n{facts}"
    return Caption(title, result.configuration["goal"])


def draw_map(
    path: Path,
    course: "Course",
    caption: Caption,
    remembered: RememberedMap,
    estimate: Trajectory,
    truth: Trajectory,
    stairs: StairMemory,
    footsteps: tuple[StepMemory, tuple[float, float]] | None = None,
) -> None:
    """Draw the picture, whole or not at all.

    A way has a gap where the robot found itself elsewhere, or was carried off: it walked no line
    from the one place to the other.

    Args:
        path: of the PNG file.
        course: what truly stands where, and start and goal.
        caption: title and goal.
        remembered: what the map last said of every cell.
        estimate: the believed way.
        truth: the true one.
        stairs: what was known of stairs, and when the robot climbed.
        footsteps: where soles were planned and put, and the length and width of a sole, m: a
            walked step is shorter, and no two fall between two frames. None: ways have no gaps.

    Raises:
        OSError: the file cannot be written.
    """
    goal = multiplied(Goal.model_validate(dict(caption.goal)), Scale(course.scale))
    caption = replace(caption, goal=goal.model_dump())
    west, east, south, north = _bounds(course, caption, remembered, truth)
    width, height = east - west, north - south
    scale = 9.0 / max(width, height / 0.7)
    figure = Figure(
        figsize=(max(6.5, width * scale + 2.0), max(3.6, height * scale + 1.5)), dpi=150
    )
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_facecolor(_UNKNOWN)
    colours = draw_cells(axes, remembered, height_span(remembered))
    _draw_course(axes, course)
    draw_stairs(axes, *stairs.told_apart(remembered))
    stride = math.inf if footsteps is None else footsteps[1][0]
    _draw_ways(axes, (estimate, truth), stairs, stride)
    if footsteps is not None:
        draw_soles(axes, *footsteps)
    _draw_ends(axes, course, caption)
    axes.set_xlim(west, east)
    axes.set_ylim(south, north)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.tick_params(labelsize=8)
    for spine in axes.spines.values():
        spine.set_visible(False)
    bar = figure.colorbar(colours, ax=axes, shrink=0.85, pad=0.02, aspect=24)
    bar.set_label("floor height (mm)")
    bar.outline.set_visible(False)
    axes.set_title(caption.title, fontsize=11, loc="left", pad=10)
    axes.legend(
        handles=[
            *axes.get_legend_handles_labels()[0],
            Patch(color=_OBSTACLE, label="obstacle"),
            Patch(facecolor=_UNKNOWN, edgecolor="#8a8d94", label="never seen"),
        ],
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=axes.transAxes
        + ScaledTranslation(0.0, -LABELS_INCHES, figure.dpi_scale_trans),
        ncols=6,
        frameon=True,
        facecolor="#b9bcc4",
        edgecolor="none",
        fontsize=8,
    )
    with whole_file(path) as temporary:
        figure.savefig(
            temporary, bbox_inches="tight", facecolor="white", metadata={"Software": None}
        )


def _bounds(
    course: "Course", caption: Caption, remembered: RememberedMap, truth: Trajectory
) -> tuple[float, float, float, float]:
    """Return west, east, south and north of what is worth seeing, m."""
    row, col = np.nonzero(remembered.kind != UNKNOWN)
    seen = (np.column_stack([col, row]) + 0.5) * remembered.cell + np.array(remembered.origin)
    points = [np.array([course.start.position, caption.goal["position"]])]
    points += [truth.positions()[:, :2], seen]
    points += [piece.outline for e in course.elements if e.present for piece in e.pieces]
    every = np.vstack([p for p in points if len(p)])
    low, high = every.min(axis=0) - _MARGIN, every.max(axis=0) + _MARGIN
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def height_span(*maps: RememberedMap) -> tuple[float, float]:
    """Return the lowest and the highest floor that colours have to tell apart, mm."""
    heights = np.concatenate([1e3 * one.height[one.kind == FLOOR] for one in maps])
    low, high = (0.0, 0.0) if not heights.size else np.percentile(heights, [0.5, 99.5])
    middle = (low + high) / 2
    half = max((high - low) / 2, 1e3 * _LEAST_SPAN)
    return float(middle - half), float(middle + half)


def height_colours(span_mm: tuple[float, float]) -> ScalarMappable:
    """Return the colours of floors between two heights."""
    return ScalarMappable(Normalize(*span_mm), cmap="viridis")


def draw_cells(
    axes: Axes, remembered: RememberedMap, span_mm: tuple[float, float]
) -> ScalarMappable:
    """Draw floors by height, obstacles and the unknown; return what a colour bar shows."""
    floor = remembered.kind == FLOOR
    colours = height_colours(span_mm)
    rows, cols = remembered.kind.shape
    if not rows:
        return colours
    picture = np.full((rows, cols, 3), _UNKNOWN)
    picture[floor] = colours.to_rgba(1e3 * remembered.height[floor])[:, :3]
    picture[remembered.kind == OBSTACLE] = _OBSTACLE
    x, y = remembered.origin
    axes.imshow(
        picture,
        origin="lower",
        interpolation="nearest",
        extent=(x, x + cols * remembered.cell, y, y + rows * remembered.cell),
        zorder=1,
    )
    return colours


def _draw_course(axes: Axes, course: "Course") -> None:
    """Draw the outlines of everything that is there from the beginning; dashed what comes later."""
    for present, style in ((True, "-"), (False, "--")):
        pieces = [piece for e in course.elements if e.present == present for piece in e.pieces]
        draw_outlines(axes, [piece.outline for piece in pieces], style)


def draw_outlines(axes: Axes, outlines: Sequence[NDArray[np.float64]], style: str = "-") -> None:
    """Draw what truly stands there, (n, 2) m each; the first of a picture stands in its legend."""
    for outline in outlines:
        shape = Polygon(outline, closed=True, fill=False, edgecolor=_OUTLINE, linewidth=1.3)
        shape.set(linestyle=style, zorder=3)
        if not any(one.get_label() == _TRUE_COURSE for one in axes.patches):
            shape.set_label(_TRUE_COURSE)
        axes.add_patch(shape)


def _draw_ways(
    axes: Axes, ways: tuple[Trajectory, Trajectory], told: StairMemory, stride: float
) -> None:
    """Draw the believed way and the true one, and where the robot climbed on the first.

    Where the robot knew that it did not know its place, it believed nothing.
    """
    estimate, truth = ways
    climbing = np.array(told.climbing, dtype=bool)
    lost = np.zeros(len(estimate.rows), dtype=bool)
    lost[: len(told.lost)] = told.lost[: len(lost)]
    true, believed = _with_gaps(truth, stride), _with_gaps(estimate, stride, hidden=lost)
    back: dict[str, Any] = {
        "color": "black",
        "linewidth": 3.4,
        "alpha": 0.35,
        "solid_capstyle": "round",
    }
    axes.plot(*true, **back, zorder=4)
    axes.plot(*true, color=_TRUE, linewidth=2.0, zorder=5, label="true way")
    axes.plot(*believed, color=_BELIEVED, linewidth=1.4, zorder=6, label="believed")
    for row in jumps(truth.rows, stride):
        place = truth.positions()[row, :2].tolist()
        axes.plot(*place, "o", color=_TRUE, markeredgecolor="black", markersize=6, zorder=7)
        _named(axes, "carried here", place)
    if climbing.any():
        climbed = _with_gaps(estimate, stride, hidden=~climbing)
        axes.plot(*climbed, color=_CLIMBED, linewidth=2.0, zorder=6.5, label="climbed")


def _named(axes: Axes, name: str, place: Sequence[float]) -> None:
    """Write what a place is below it."""
    axes.annotate(
        name,
        (place[0], place[1]),
        xytext=(0, -14),
        textcoords="offset points",
        ha="center",
        fontsize=8,
        zorder=8,
    )


def _with_gaps(
    way: Trajectory, stride: float, hidden: NDArray[np.bool_] | None = None
) -> NDArray[np.float64]:
    """Return x and y of a way, (2, n) m, with NaN between rows that no walk joins."""
    places = way.positions()[:, :2]
    if hidden is not None:
        places = np.where(hidden[:, None], np.nan, places)
    return np.insert(places, jumps(way.rows, stride), np.nan, axis=0).T


def _draw_ends(axes: Axes, course: "Course", caption: Caption) -> None:
    goal = caption.goal
    for position in goal["via"]:
        axes.add_patch(
            Circle(position, goal["radius"], fill=False, edgecolor=_GOAL, linestyle=":", zorder=6)
        )
    axes.add_patch(
        Circle(goal["position"], goal["radius"], facecolor=_GOAL, alpha=0.35, zorder=3.5)
    )
    axes.add_patch(
        Circle(
            goal["position"],
            goal["radius"],
            fill=False,
            edgecolor=_GOAL,
            linewidth=1.8,
            zorder=6,
            label="goal",
        )
    )
    start, yaw = course.start.position, course.start.yaw
    axes.plot(*start, "o", color="white", markeredgecolor="black", markersize=8, zorder=7)
    tip = np.array(start) + 0.12 * np.array([np.cos(yaw), np.sin(yaw)])
    axes.annotate(
        "",
        xy=(float(tip[0]), float(tip[1])),
        xytext=start,
        arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 1.2},
        zorder=8,
    )
    _named(axes, "start", start)
