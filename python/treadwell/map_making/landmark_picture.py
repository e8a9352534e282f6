"""`map.png` of landmarks: where they are, how well that is known, and the robot's way."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from treadwell.map_making.picture import save_picture

_WAY: Final = "#ff5fa2"
_LANDMARK: Final = "#17181c"
_SURVEYED: Final = "#1f7a8c"
_DOUBTED: Final = "#b0b3b8"
_MARGIN: Final = 0.06
"""Share of the longer side that is left free around."""
_LEAST_SIDE_M: Final = 1.0
_LEAST_SHARE: Final = 1e-6
"""Of the largest coordinate, the shortest side that is shown."""
SHARE: Final = 0.95
"""Of where a landmark may be, what its ellipse holds."""
SURE: Final = 0.9
"""Landmarks that are there with less probability are drawn pale."""


def draw_landmarks(
    path: Path,
    title: str,
    landmarks: NDArray[np.float64],
    places: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Draw the picture, whole or not at all.

    Args:
        path: of the PNG file.
        title: what was mapped.
        landmarks: (n, 7): x, y, m; covariance xx, xy, yy, m²; probability; name, NaN without.
        places: (n, 2) m each, where the robot was, and where landmarks were surveyed.

    Raises:
        OSError: the file cannot be written.
    """
    figure = Figure(figsize=(9.0, 7.0), dpi=150)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    way, surveyed = places
    axes.plot(way[:, 0], way[:, 1], color=_WAY, linewidth=0.6, alpha=0.7)
    axes.plot(surveyed[:, 0], surveyed[:, 1], "x", color=_SURVEYED, markersize=6)
    for x, y, xx, xy, yy, probability, name in landmarks:
        colour = _LANDMARK if probability >= SURE else _DOUBTED
        axes.add_patch(_ellipse((x, y), np.array([[xx, xy], [xy, yy]]), colour))
        axes.plot(x, y, ".", color=colour, markersize=2.5)
        if np.isfinite(name):
            axes.annotate(
                f"{name:.0f}", (x, y), (6, 5), textcoords="offset points", fontsize=8, color=colour
            )
    axes.set_aspect("equal")
    _frame(axes, np.vstack([landmarks[:, :2], way, surveyed]))
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.tick_params(labelsize=8)
    axes.grid(color="#ececef", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_title(title, fontsize=11, loc="left", pad=10)
    handles = [
        Line2D([], [], color=_WAY, linewidth=1.2, label="the robot"),
        Line2D(
            [],
            [],
            color=_LANDMARK,
            marker="o",
            fillstyle="none",
            linestyle="none",
            markersize=8,
            label=f"landmark: {SHARE:.0%} by the filter",
        ),
    ]
    if len(surveyed):
        label = "surveyed, after alignment"
        handles.append(Line2D([], [], color=_SURVEYED, marker="x", linestyle="none", label=label))
    if (landmarks[:, 5] < SURE).any():
        label = f"less than {SURE:.0%} sure that it is there"
        handles.append(Line2D([], [], color=_DOUBTED, marker="+", linestyle="none", label=label))
    axes.legend(
        handles=handles,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.1),
        ncols=4,
        frameon=False,
        fontsize=8,
    )
    save_picture(figure, path)


def _frame(axes: Axes, places: NDArray[np.float64]) -> None:
    """Leave a margin, and be never so near that coordinates have no digits left to tell by."""
    low, high = places.min(axis=0), places.max(axis=0)
    side = max(float((high - low).max()), _LEAST_SIDE_M, _LEAST_SHARE * float(np.abs(places).max()))
    middle, half = 0.5 * (low + high), 0.5 * (high - low) + _MARGIN * side
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])


def _ellipse(place: tuple[float, float], covariance: NDArray[np.float64], colour: str) -> Ellipse:
    """Return the ellipse that holds a share of a Gaussian on the plane."""
    variances, axes = np.linalg.eigh(covariance)
    across, along = 2.0 * np.sqrt(-2.0 * np.log(1.0 - SHARE) * np.maximum(variances, 0.0))
    angle = float(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])))
    return Ellipse(place, along, across, angle=angle, fill=False, edgecolor=colour, linewidth=0.9)
