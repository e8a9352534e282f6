"""The maps of Gutmann 2005, Figs 3, 5 and 7, by each world model side by side."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from treadwell.course.build import build_course
from treadwell.course.outlines import convex_outline
from treadwell.errors import RecordingError
from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import Picture, Results
from treadwell.judging.result import Result
from treadwell.map_memory import UNKNOWN, RememberedMap
from treadwell.measuring.map_watch import MapHistory
from treadwell.recording.map_picture import (
    draw_cells,
    draw_outlines,
    height_colours,
    height_span,
)
from treadwell.robot.load import load_robot
from treadwell.scenario.model import Scenario

Floats = NDArray[np.float64]
Bounds = tuple[float, float, float, float]
"""West, east, south and north, m."""


class Panel(NamedTuple):
    """A map to draw: its title, what it says, and the true outlines of what stood there, m."""

    title: str
    remembered: RememberedMap
    outlines: Sequence[Floats] = ()


_IN_FRONT: Final = (0.0, 1.2, -0.6, 0.6)
_AROUND: Final = (-0.4, 1.6, -1.0, 1.0)
_STAGE: Final = (0.0, 4.0, -0.6, 0.6)


def fog_pictures(results: Results, folder: Path) -> list[Picture]:
    """Draw what was run into a folder; of each case its first run.

    Raises:
        RecordingError: a file cannot be written.
    """
    made = (
        ("Three levels, two rough obstacles (Fig. 3)", "levels.png", _levels(results), _AROUND),
        ("A box, and after it was removed (Fig. 5)", "removed.png", _removed(results), _IN_FRONT),
        ("A box at the end of its way", "moved.png", _moved(results), _IN_FRONT),
        ("The obstacle course (Fig. 7)", "course.png", _course(results), _STAGE),
    )
    pictures = []
    for title, name, panels, bounds in made:
        if panels:
            draw_panels(folder / name, panels, bounds)
            pictures.append(Picture(title, folder / name))
    return pictures


def _levels(results: Results) -> list[Panel]:
    return _remembered(results, cases.levels)


def _course(results: Results) -> list[Panel]:
    return _remembered(results, cases.course)


def _remembered(results: Results, name: cases.Naming) -> list[Panel]:
    firsts = {model: results.get(name(model), ())[:1] for model in cases.WORLD_MODELS}
    return [
        Panel(model, run.remembered, true_outlines(run.result))
        for model, runs in firsts.items()
        for run in runs
        if run.remembered
    ]


def true_outlines(result: Result) -> list[Floats]:
    """Return the outlines of what stood on the course from the beginning, (n, 2) m each.

    Rubble has one around all its stones.
    """
    scenario = Scenario.model_validate(dict(result.configuration))
    course = build_course(scenario, load_robot(scenario.robot))
    outlines: list[Floats] = []
    for element in course.elements:
        pieces = [piece.outline for piece in element.pieces] if element.present else []
        outlines += [convex_outline(np.vstack(pieces))] if element.kind == "rubble" else pieces
    return outlines


def _removed(results: Results) -> list[Panel]:
    panels = []
    for model in cases.WORLD_MODELS:
        for run in results.get(cases.removed(model), ())[:1]:
            history: MapHistory = run.findings
            told = (f"{model}, the box there", f"{model}, removed")
            shown = zip(told, history.pictures, history.outlines, strict=False)
            panels += [Panel(*one) for one in shown]
    return panels


def _moved(results: Results) -> list[Panel]:
    return [
        Panel(model, run.findings.pictures[-1], run.findings.outlines[-1])
        for model in cases.WORLD_MODELS
        for run in results.get(cases.moved(model), ())[:1]
    ]


def known_bounds(maps: Sequence[RememberedMap], around: float) -> Bounds:
    """Return what is around all known cells of maps of which each has some, m."""
    low, high = [], []
    for found in maps:
        rows, cols = np.nonzero(found.kind != UNKNOWN)
        corner = np.array(found.origin)
        low.append(corner + found.cell * np.array([cols.min(), rows.min()]))
        high.append(corner + found.cell * np.array([cols.max() + 1, rows.max() + 1]))
    (west, south), (east, north) = np.min(low, axis=0) - around, np.max(high, axis=0) + around
    return float(west), float(east), float(south), float(north)


def draw_panels(path: Path, panels: Sequence[Panel], bounds: Bounds) -> None:
    """Draw maps side by side, two in a row or, where they are wide, one, with one scale of colours.

    Args:
        path: of the PNG file.
        panels: one or more.
        bounds: what is shown.

    Raises:
        RecordingError: the file cannot be written.
    """
    west, east, south, north = bounds
    wide = east - west > 2 * (north - south)
    cols = 1 if wide else min(2, len(panels))
    rows = -(-len(panels) // cols)
    width = 7.8 if wide else 4.0
    height = width * (north - south) / (east - west) + 0.6
    size = ((width + 0.4) * cols + 1.0, height * rows)
    figure = Figure(figsize=size, dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, cols, squeeze=False)
    span = height_span(*(panel.remembered for panel in panels))
    for place, panel in zip(axes.flat, panels, strict=False):
        draw_cells(place, panel.remembered, span)
        draw_outlines(place, panel.outlines)
        place.set_title(panel.title, fontsize=9, loc="left")
        place.set_xlabel("x (m)", fontsize=8)
        place.set_ylabel("y (m)", fontsize=8)
        place.set_xlim(west, east)
        place.set_ylim(south, north)
        place.set_facecolor("#ccccd1")
        place.set_aspect("equal")
        place.tick_params(labelsize=7)
        for spine in place.spines.values():
            spine.set_visible(False)
    for place in axes.flat[len(panels) :]:
        place.set_axis_off()
    bar = figure.colorbar(height_colours(span), ax=axes, shrink=0.8, aspect=30)
    bar.set_label("floor height (mm); obstacles black, unknown grey, truth orange", fontsize=8)
    bar.outline.set_visible(False)
    try:
        figure.savefig(path, facecolor="white", metadata={"Software": None})
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from error
