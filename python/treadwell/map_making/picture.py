"""`map.png` of recorded data: the map from above, and the way of the sensor."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from treadwell.files import whole_file
from treadwell.map_memory import FLOOR, UNKNOWN, RememberedMap
from treadwell.recording.map_picture import LABELS_INCHES, draw_cells, height_span

_OBSTACLE: Final = (0.09, 0.09, 0.11)
_UNKNOWN: Final = (0.80, 0.80, 0.82)
_IN_METRES: Final = 5000.0
"""Heights that differ by more, mm, are shown in metres."""
_TICKS: Final = 4
_WAY: Final = "#ff5fa2"
_MARGIN: Final = 0.02
"""Share of the map's longer side that is left free around it."""


def draw_map(path: Path, title: str, found: RememberedMap, way: NDArray[np.float64]) -> None:
    """Draw the picture, whole or not at all.

    Args:
        path: of the PNG file.
        title: what was mapped, one or two lines.
        found: the map.
        way: (n, 2) m, where the sensor was; empty where nobody knows.

    Raises:
        OSError: the file cannot be written.
    """
    figure = Figure(figsize=(9.0, 7.0), dpi=150)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_facecolor(_UNKNOWN)
    colours = draw_cells(axes, found, height_span(found))
    marks = []
    if len(way) > 1:
        marks += axes.plot(way[:, 0], way[:, 1], color=_WAY, linewidth=1.2, label="the sensor")
    elif len(way):
        marks += axes.plot(*way[0], "o", color=_WAY, markersize=5, label="the sensor")
    _frame(axes, found, way)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.tick_params(labelsize=8)
    axes.xaxis.set_major_locator(MaxNLocator(_TICKS))
    axes.yaxis.set_major_locator(MaxNLocator(_TICKS))
    axes.ticklabel_format(useOffset=False, style="plain")
    if (found.kind == FLOOR).any():
        bar = figure.colorbar(colours, ax=axes, shrink=0.85, pad=0.02, aspect=24)
        low, high = bar.mappable.get_clim()
        if high - low > _IN_METRES:
            bar.formatter = FuncFormatter(lambda value, _: f"{1e-3 * value:g}")
            bar.update_ticks()
        bar.set_label("height (m)" if high - low > _IN_METRES else "height (mm)")
        bar.outline.set_visible(False)
    axes.set_title(title, fontsize=11, loc="left", pad=10)
    patches = [
        Patch(color=_OBSTACLE, label="obstacle"),
        Patch(facecolor=_UNKNOWN, edgecolor="#8a8d94", label="never seen"),
    ]
    axes.legend(
        handles=[*marks, *patches],
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=axes.transAxes
        + ScaledTranslation(0.0, -LABELS_INCHES, figure.dpi_scale_trans),
        ncols=3,
        frameon=False,
        fontsize=8,
    )
    save_picture(figure, path)


def save_picture(figure: Figure, path: Path) -> None:
    """Write a figure as a PNG file, whole or not at all, the same bytes whoever wrote it.

    Raises:
        OSError: the file cannot be written.
    """
    with whole_file(path) as temporary:
        figure.savefig(
            temporary,
            format="png",
            bbox_inches="tight",
            facecolor="white",
            metadata={"Software": None},
        )


def _frame(axes: Axes, found: RememberedMap, way: NDArray[np.float64]) -> None:
    rows, cols = np.nonzero(found.kind != UNKNOWN)
    seen = (np.column_stack([cols, rows]) + 0.5) * found.cell + np.array(found.origin)
    every = np.vstack([part for part in (seen, way) if len(part)] or [np.zeros((1, 2))])
    low, high = every.min(axis=0), every.max(axis=0)
    margin = max(_MARGIN * float((high - low).max()), found.cell)
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
