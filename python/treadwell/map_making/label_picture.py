"""`labels.png` of a map: what is what, from above and from the side."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from treadwell.map_making.picture import save_picture
from treadwell.map_making.room_labels import COLOURS, NAMES

PICTURE: Final = "labels.png"


def draw_labels(
    path: Path, title: str, places: NDArray[np.float32], labels: NDArray[np.uint8]
) -> None:
    """Draw the picture, whole or not at all.

    Args:
        path: of the PNG file.
        title: what was mapped.
        places: (n, 3) m.
        labels: (n,) indices into `NAMES`.

    Raises:
        OSError: the file cannot be written.
    """
    figure = Figure(figsize=(9.0, 8.0), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    above, beside = figure.subplots(2, 1, height_ratios=[3, 1])
    above.set_title(title, fontsize=11, loc="left")
    for axes, axis, seen_from in ((above, 1, 2), (beside, 2, 1)):
        scatter(axes, places, labels, axis, seen_from)
    above.set_ylabel("y (m)")
    beside.set_ylabel("z (m)")
    beside.set_xlabel("x (m)")
    handles = [
        Line2D([], [], marker="s", linestyle="", color=colour, label=f"{name} ({count})")
        for name, colour, count in zip(
            NAMES, COLOURS, np.bincount(labels, minlength=len(NAMES)), strict=True
        )
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=6, frameon=False, fontsize=8)
    save_picture(figure, path)


def scatter(
    axes: Axes,
    places: NDArray[np.float32],
    labels: NDArray[np.uint8],
    axis: int,
    seen_from: int,
) -> None:
    """Draw places in the colours of their labels, x against an axis, the nearest to the eye last.

    Args:
        axes: to draw into.
        places: (n, 3) m.
        labels: (n,) indices into `NAMES`.
        axis: that points up in the picture.
        seen_from: the axis that one looks along; of y from the side of small values.
    """
    sign = 1.0 if seen_from == 2 else -1.0
    order = np.argsort(sign * places[:, seen_from], kind="stable")
    colours = np.array(COLOURS)[labels[order]]
    x, up = places[order][:, [0, axis]].T
    axes.scatter(x, up, c=colours, s=7, marker="s", linewidths=0)
    axes.set_aspect("equal")
    axes.tick_params(labelsize=8)
