"""The maps and ways of Maier 2012, Figs 3 and 4, and the error over time, Fig. 5."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from treadwell.errors import RecordingError
from treadwell.experiments import nao_cases as cases
from treadwell.experiments.experiment import Picture, Results
from treadwell.experiments.nao_localization import (
    BIN_S,
    LEVEL_M,
    binned,
    filter_walks,
    in_hallway,
)
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.walk_watch import Walk

Floats = NDArray[np.float64]

_STATIC, _LOCAL = "#3567c9", "#d8432f"
_FLOOR, _OTHER, _UNKNOWN = "#ffffff", "#e3d9c3", "#c4c6cb"
_BELIEVED, _TRUE, _ODOMETRY = "#ff3d94", "#000000", "#f0a400"
_HALLWAY, _BAND = "#e4e6ea", "#b9cbf0"


def nao_pictures(results: Results, folder: Path) -> list[Picture]:
    """Draw what was run into a folder; of each case its first run.

    Raises:
        RecordingError: a file cannot be written.
    """
    pictures = []
    for number, title in ((2, "Scenario 2 (Fig. 3)"), (3, "Scenario 3 (Fig. 4)")):
        for model in cases.WORLD_MODELS:
            for run in results.get(cases.walked(number, model), ())[:1]:
                if run.remembered is not None and len(run.findings.times):
                    path = folder / f"scenario_{number}_{model}.png"
                    draw_walk(path, run.findings, run.remembered)
                    pictures.append(Picture(f"{title}, map {model}", path))
    if walks := filter_walks(results):
        draw_errors(folder / "errors.png", walks)
        title = f"Error of {len(walks)} filters over one walk of scenario 1 (Fig. 5)"
        pictures.append(Picture(title, folder / "errors.png"))
    return pictures


def draw_walk(path: Path, walk: Walk, remembered: RememberedMap) -> None:
    """Draw the static map and what the robot had mapped in the end, from above, and three ways.

    Args:
        path: of the PNG file.
        walk: with one frame or more.
        remembered: what the map last said of every cell.

    Raises:
        RecordingError: the file cannot be written.
    """
    figure = Figure(figsize=(10.0, 6.6), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_facecolor(_UNKNOWN)
    level = float(walk.true[-1, 2])
    floor = remembered.kind == FLOOR
    with np.errstate(invalid="ignore"):
        same = floor & (np.abs(remembered.height - level) <= LEVEL_M)
    centres = remembered.centres()
    kinds = ((floor & ~same, _OTHER), (same, _FLOOR), (remembered.kind == OBSTACLE, _LOCAL))
    _draw_squares(axes, walk.static, walk.voxel, _STATIC, zorder=2)
    for cells, colour in kinds:
        _draw_squares(axes, centres[cells], remembered.cell, colour, zorder=1)
    ways = ((walk.true, _TRUE, "true", 3.0), (walk.odometry, _ODOMETRY, "odometry", 1.4))
    for places, colour, label, width in (*ways, (walk.believed, _BELIEVED, "believed", 1.4)):
        axes.plot(places[:, 0], places[:, 1], color=colour, linewidth=width, label=label, zorder=5)
    low, high = _bounds(walk)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    drawn = ((_STATIC, "static map"), (_LOCAL, "obstacle"), (_FLOOR, "floor"))
    patches = [Patch(color=colour, label=label) for colour, label in drawn]
    patches.append(Patch(color=_OTHER, label="of another level"))
    handles = [*axes.get_legend_handles_labels()[0], *patches]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=7, fontsize=8, facecolor=_UNKNOWN
    )
    _save(figure, path)


def _draw_squares(axes: Axes, centres: Floats, side: float, colour: str, *, zorder: float) -> None:
    squares = [Rectangle((x - side / 2, y - side / 2), side, side) for x, y in centres.tolist()]
    axes.add_collection(PatchCollection(squares, facecolor=colour, linewidth=0.0, zorder=zorder))


_MARGIN: Final = 0.2


def _bounds(walk: Walk) -> tuple[Floats, Floats]:
    """Return the lowest and the highest corner of what is worth seeing, m."""
    every = np.vstack([walk.static, walk.true[:, :2], walk.believed[:, :2]])
    return every.min(axis=0) - _MARGIN, every.max(axis=0) + _MARGIN


def draw_errors(path: Path, walks: list[Walk]) -> None:
    """Draw the error's mean and standard deviation over time, and when the hallway was walked.

    Args:
        path: of the PNG file.
        walks: one or more, each with a frame or more.

    Raises:
        RecordingError: the file cannot be written.
    """
    figure = Figure(figsize=(9.0, 3.6), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    first = walks[0]
    for begin, end in _spans(first.times, in_hallway(first)):
        axes.axvspan(begin, end, color=_HALLWAY, linewidth=0.0)
    for walk in walks:
        axes.plot(walk.times, 100 * walk.errors(), color="#8a8d94", linewidth=0.5, alpha=0.7)
    time, mean, std = binned(walks).T
    axes.errorbar(
        time, 100 * mean, 100 * std, color=_STATIC, linewidth=1.6, capsize=2.5, label="ours"
    )
    axes.axhline(6.0, color=_LOCAL, linestyle="--", linewidth=1.0, label="the paper, elsewhere")
    axes.axhline(10.0, color=_LOCAL, linewidth=1.0, label="the paper, in the hallway")
    axes.set_xlabel(f"time (s); bins of {BIN_S:g} s; grey: in the hallway")
    axes.set_ylabel("error in the plane (cm)")
    axes.set_ylim(0.0, max(12.0, 105 * max(float(walk.errors().max()) for walk in walks)))
    axes.legend(loc="upper right", fontsize=8)
    _save(figure, path)


def _spans(times: Floats, inside: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Return begin and end of each time that something lasted, s."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
    last = len(times) - 1
    return [
        (float(times[begin]), float(times[min(end, last)]))
        for begin, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def _save(figure: Figure, path: Path) -> None:
    try:
        figure.savefig(path, facecolor="white", metadata={"Software": None})
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from error
