"""A comparison as a figure for a paper: successes, paired differences, and ways on one course.

Of one kind of processor the same comparison gives the same bytes.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure

from treadwell.comparing.comparison import Candidate
from treadwell.comparing.figure_file import check_figure
from treadwell.comparing.metrics import METRICS, Metric
from treadwell.comparing.panels import draw_differences, draw_successes, draw_ways
from treadwell.comparing.statistics import LEVEL
from treadwell.comparing.styles import MOST_STYLES, Style, styles
from treadwell.comparing.ways import NO_WAYS, Ways, common_ways
from treadwell.errors import InputError, RecordingError
from treadwell.files import whole_file

COLUMN_INCHES, PAGE_INCHES = 3.5, 7.16
"""Widths of a column and of both, with the gap, of a page of IEEE's; others are near them."""
MOST_ROWS: Final = 6
"""Differences of a figure up to which all pairs are drawn; of more sides those with the first."""
MOST_METRICS: Final = 4
"""Figures of which differences are drawn: the first ones in which there are any."""
_ROW, _AXIS = 0.17, 0.62
"""Inches: a row, and what an axis needs around its rows."""
_SIDES_OF_A_COLUMN: Final = 3
"""Sides up to which a column is wide enough."""
_WAYS_INCHES: Final = (1.3, 3.6)
"""Least and largest height of the course."""
_LOOKS: Final[dict[Any, Any]] = {
    "font.family": ["DejaVu Sans"], "font.size": 7.0, "axes.titlesize": 7.5, "axes.linewidth": 0.6,
    "axes.spines.top": False, "axes.spines.right": False, "xtick.major.width": 0.6,
    "ytick.major.width": 0.6, "xtick.major.size": 2.5, "ytick.major.size": 2.5,
    "legend.frameon": False, "hatch.linewidth": 0.4, "hatch.color": "#666666",
    "text.parse_math": False, "text.usetex": False, "axes.formatter.use_mathtext": False,
    "axes.formatter.useoffset": False, "axes.unicode_minus": True,
    "svg.fonttype": "none", "svg.hashsalt": "treadwell", "pdf.fonttype": 42, "savefig.dpi": 300,
}  # fmt: skip
_METADATA: Final[dict[str, dict[str, Any]]] = {
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    ".svg": {"Date": None, "Creator": None},
    ".png": {"Software": None},
}


@dataclass(frozen=True, slots=True)
class Drawn:
    """What a figure shows.

    Attributes:
        caption: what a paper would say below it.
        note: what lacks, a sentence; empty where nothing does.
    """

    caption: str
    note: str


def draw_figure(path: Path, sides: Sequence[Candidate], document: dict[str, Any]) -> Drawn:
    """Draw a comparison; a file that is there is replaced, whole or not at all.

    Args:
        path: of the file; its ending says which kind: PDF and SVG hold lines and text, PNG pixels.
        sides: that are compared.
        document: what `compared` found of them.

    Raises:
        InputError: as `check_figure`, or there is nothing to draw.
        RecordingError: the file cannot be written.
    """
    check_figure(path)
    if not sides or not any(side.rows for side in sides):
        raise InputError("--figure: there is no episode to draw")
    kind, ways = path.suffix.lower(), common_ways(sides)
    with mpl.rc_context(), warnings.catch_warnings():
        mpl.rcdefaults()  # not what whoever draws has set for other figures
        mpl.rcParams.update(_LOOKS)
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        figure = _figure(document, ways, styles([side.name for side in sides]))
        try:
            with whole_file(path) as temporary:
                figure.savefig(temporary, format=kind[1:], metadata=_METADATA[kind])
        except OSError as error:
            raise RecordingError(f"--figure: {path}: {error.strerror}") from None
    return Drawn(_caption(document, ways), _note(document, ways))


def _figure(document: dict[str, Any], ways: Ways | None, chosen: Sequence[Style]) -> Figure:
    """Lay the panels out: in a column where they fit, else over the width of a page."""
    shown = shown_differences(document)
    scenarios, sides = len(document["candidates"][0]["scenarios"]), len(chosen)
    grouped = scenarios > 1 and sides <= MOST_STYLES
    wide = grouped or sides > _SIDES_OF_A_COLUMN
    width = PAGE_INCHES if wide else COLUMN_INCHES
    names = _legend_columns(chosen, width)
    heights = [0.1 + _ROW * math.ceil(sides / names)]
    above = [_successes_inches(scenarios if grouped else 0, sides)]
    above += [_differences_inches(shown)] if shown else []
    heights += [max(above)] if wide else above
    heights += [_course_inches(ways, width)] if ways else []
    figure = Figure(figsize=(width, sum(heights)), layout="constrained")
    FigureCanvasAgg(figure)
    parts = list(figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False).flat)
    handles = [style.handle() for style in chosen]
    parts[0].legend(handles=handles, loc="center", handlelength=3.2, ncols=names, borderaxespad=0.0)
    below = parts[1:]
    if wide and shown:
        below[:1] = parts[1].subfigures(1, 2)
    panels = iter(zip("abc", below, strict=False))
    letter, part = next(panels)
    axes = part.subplots()
    draw_successes(axes, document, chosen, grouped=grouped)
    _title(axes, letter, "success, 95 % intervals")
    if shown:
        _draw_all_differences(*next(panels), shown, document, chosen)
    if ways is not None:
        letter, part = next(panels)
        axes = part.subplots()
        draw_ways(axes, ways, chosen)
        _title(axes, letter, f"ways: {ways.scenario}, seed {ways.seed}")
    return figure


def _title(axes: Axes, letter: str, text: str) -> None:
    axes.set_title(f"({letter}) {text}", loc="left")


def _successes_inches(scenarios: int, sides: int) -> float:
    """Return the height of the panel of successes; no scenarios: a row is a side."""
    rows = (scenarios + 1) * (0.35 + 0.37 * sides) if scenarios else float(sides)
    return _AXIS + _ROW * rows


def _differences_inches(shown: dict[Metric, list[dict[str, Any]]]) -> float:
    pairs = max(len(found) for found in shown.values())
    return 0.1 + math.ceil(len(shown) / 2) * (_AXIS + 0.1 + _ROW * pairs)


def _legend_columns(chosen: Sequence[Style], width: float) -> int:
    """Return how many names stand side by side; a character of the font is 0.055 inches or so."""
    longest = 0.7 + 0.055 * max(len(style.label) for style in chosen)
    return max(1, min(len(chosen), int(width / longest)))


def _course_inches(ways: Ways | None, width: float) -> float:
    """Return the height that a course has when it is as wide as the figure."""
    if ways is None:
        return 0.0
    points = [way.places for way in ways.ways.values() if len(way.places)]
    points += [] if ways.sketch is None else [*ways.sketch.obstacles, *ways.sketch.floors]
    low = [min(float(each[:, axis].min()) for each in points) for axis in (0, 1)] if points else []
    high = [max(float(each[:, axis].max()) for each in points) for axis in (0, 1)] if points else []
    if not points:
        return _WAYS_INCHES[0]
    across, along = high[1] - low[1] + 0.3, high[0] - low[0] + 0.3
    return min(max((width - 0.5) * across / along + _AXIS, _WAYS_INCHES[0]), _WAYS_INCHES[1])


def shown_differences(document: dict[str, Any]) -> dict[Metric, list[dict[str, Any]]]:
    """Return what is drawn of differences: a figure -> a row for each pair of sides.

    Figures in which no pair differs are left out, but for success, and those beyond `MOST_METRICS`.
    Of more than `MOST_ROWS` pairs only those with the first side are drawn.
    """
    first = document["candidates"][0]["name"]
    found: dict[Metric, list[dict[str, Any]]] = {}
    for metric in METRICS:
        rows = [one for one in document["differences"] if one["metric"] == metric.name]
        if len(rows) > MOST_ROWS:
            rows = [one for one in rows if one["first"] == first]
        differs = any(one["difference"] for one in rows)
        if (
            any(one["pairs"] for one in rows)
            and (differs or metric.name == "success")
            and len(found) < MOST_METRICS
        ):
            found[metric] = rows
    return found


def _draw_all_differences(
    letter: str,
    part: SubFigure,
    shown: dict[Metric, list[dict[str, Any]]],
    document: dict[str, Any],
    chosen: Sequence[Style],
) -> None:
    names = [side["name"] for side in document["candidates"]]
    letters = {name: style.letter for name, style in zip(names, chosen, strict=True)}
    columns = min(2, len(shown))
    grid = part.subplots(math.ceil(len(shown) / columns), columns, squeeze=False)
    for axes, metric in zip(grid.flat, shown, strict=False):
        draw_differences(axes, metric, shown[metric], letters)
    for axes in list(grid.flat)[len(shown) :]:
        axes.set_axis_off()
    _title(grid[0, 0], letter, "paired differences")


def _caption(document: dict[str, Any], ways: Ways | None) -> str:
    """Return what a paper would say below the figure."""
    episodes = sorted({side["episodes"] for side in document["candidates"]})
    count = str(episodes[0]) if len(episodes) == 1 else f"{episodes[0]} to {episodes[-1]}"
    count += " episode" if episodes == [1] else " episodes"
    told = [f"Share of successes of {count}, with Wilson's 95 % interval."]
    if shown_differences(document):
        told.append(
            "Mean differences of pairs of the same scenario and seed, with 95 % intervals "
            "(Newcombe's of shares, the inverted permutation test of the rest; dotted: too few "
            f"pairs for one); filled: p < {LEVEL:g} after Holm's correction over "
            f"{document['tests']} tests."
        )
    if ways is not None:
        ends = "" if all(way.success for way in ways.ways.values()) else "; a cross ends a failure"
        told.append(f"True ways over {ways.scenario}, seed {ways.seed}{ends}.")
    return " ".join(f"({letter}) {text}" for letter, text in zip("abc", told, strict=False))


def _note(document: dict[str, Any], ways: Ways | None) -> str:
    """Say what a figure does not show, and why."""
    notes = [NO_WAYS if ways is None else ways.note]
    if len(document["candidates"]) > 1 and not shown_differences(document):
        notes.append("no pairs: no scenario and seed in common")
    return "; ".join(filter(None, notes))
