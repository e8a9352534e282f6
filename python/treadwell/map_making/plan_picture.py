"""`map.png` of scans: what is occupied, free and unknown from above, or lines."""

from pathlib import Path
from typing import Final

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from treadwell.map_making.picture import save_picture
from treadwell.map_making.plan_topology import Topology
from treadwell.map_making.plan_view import Seen
from treadwell.map_memory import OBSTACLE, RememberedMap
from treadwell.map_result import MappedLines

_UNKNOWN: Final = (0.80, 0.80, 0.82)
_POINTS: Final = (0.72, 0.74, 0.78)
_ROOMS: Final = tuple((r, g, b) for r, g, b, _ in matplotlib.colormaps["tab20"](range(20)).tolist())
_TINT: Final = 0.45
_WAY: Final = "#ff5fa2"
_LINE: Final = "#12305c"
_LONGER_SIDE_INCHES: Final = 11.0
_DPI: Final = 150
_TICKS: Final = 6


def draw_plan(
    path: Path,
    title: str,
    found: RememberedMap,
    seen: Seen,
    way: NDArray[np.float64],
) -> None:
    """Draw the picture, whole or not at all.

    Args:
        path: of the PNG file.
        title: what was mapped, one or two lines.
        found: the map.
        seen: what the model has beside the cells.
        way: (n, 2) m, where the sensor was.

    Raises:
        OSError: the file cannot be written.
    """
    probability, lines = seen.probability, seen.lines
    rows, cols = found.kind.shape
    size = np.maximum(np.array([cols, rows]) * found.cell, found.cell)
    inches = np.maximum(size / size.max() * _LONGER_SIDE_INCHES, 4.0)
    figure = Figure(figsize=tuple(inches), dpi=_DPI)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_facecolor(_UNKNOWN if probability is not None else "white")
    marks: list[Patch | Line2D] = []
    if probability is not None:
        shade = np.where(np.isnan(probability), 0.0, 1.0 - probability)[..., None]
        picture = np.where(np.isnan(probability)[..., None], _UNKNOWN, shade)
        marks.append(Patch(facecolor="black", label="occupied"))
        marks.append(Patch(facecolor="white", edgecolor="#8a8d94", label="free"))
        marks.append(Patch(facecolor=_UNKNOWN, edgecolor="#8a8d94", label="never seen"))
    else:
        points = (found.kind == OBSTACLE)[..., None]
        picture = np.where(points, _POINTS if lines else (0.09, 0.09, 0.11), (1.0, 1.0, 1.0))
        marks.append(Patch(color=_POINTS if lines else (0.09, 0.09, 0.11), label="points"))
    x, y = found.origin
    extent = (x, x + cols * found.cell, y, y + rows * found.cell)
    if found.kind.size:
        axes.imshow(picture, origin="lower", extent=extent, interpolation="antialiased")
    if lines is not None:
        marks.append(_draw_lines(axes, lines))
    if seen.topology is not None:
        marks += _draw_topology(axes, seen.topology, extent)
    if len(way) > 1:
        marks += axes.plot(way[:, 0], way[:, 1], color=_WAY, linewidth=0.6, label="the sensor")
    _frame(axes, found)
    axes.set_title(title, fontsize=11, loc="left", pad=10)
    axes.legend(
        handles=marks,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.06),
        ncols=4,
        frameon=False,
        fontsize=9,
    )
    save_picture(figure, path)


def _draw_lines(axes: Axes, lines: MappedLines) -> Line2D:
    segments = [[(a, b), (c, d)] for line in lines.each for a, b, c, d in line.stretches]
    axes.add_collection(LineCollection(segments, colors=_LINE, linewidths=1.4))
    return Line2D([], [], color=_LINE, label=f"{lines.count} lines")


def _draw_topology(
    axes: Axes, topology: Topology, extent: tuple[float, float, float, float]
) -> list[Line2D | Patch]:
    """Draw rooms in colours, ways, and places by how many ways meet there."""
    rooms = np.array(_ROOMS)[topology.room_of % len(_ROOMS)]
    rooms = np.dstack([rooms, np.where(topology.room_of > 0, _TINT, 0.0)])
    if topology.room_of.size:
        axes.imshow(rooms, origin="lower", extent=extent, interpolation="nearest")
    axes.add_collection(LineCollection(topology.paths, colors=_LINE, linewidths=1.2))
    found = topology.places()
    marks: list[Line2D | Patch] = [Line2D([], [], color=_LINE, label=f"{len(found.ways)} ways")]
    meet = np.array([place.position for place in found.each if place.ways != 1]).reshape(-1, 2)
    end = np.array([place.position for place in found.each if place.ways == 1]).reshape(-1, 2)
    doors = np.array([doorway.position for doorway in found.doorways]).reshape(-1, 2)
    for points, marker, colour, label in (
        (meet, "o", "#d1495b", "meet points"),
        (end, "s", "#66717e", "ends"),
        (doors, "D", "#edae49", "doorways"),
    ):
        marks += axes.plot(
            points[:, 0],
            points[:, 1],
            marker,
            markersize=4,
            color=colour,
            label=f"{len(points)} {label}",
        )
    marks.append(Patch(facecolor=(*_ROOMS[1], _TINT), label=f"{found.rooms} rooms, coloured"))
    return marks


def _frame(axes: Axes, found: RememberedMap) -> None:
    """Show the part of the map that holds something occupied or free, most of it at least."""
    known = np.argwhere(found.kind == OBSTACLE)
    if len(known):
        low, high = np.percentile(known, [0.1, 99.9], axis=0)
        margin = 0.03 * float((high - low).max()) + 2.0
        (bottom, left), (top, right) = low - margin, high + margin
        x, y = found.origin
        axes.set_xlim(x + left * found.cell, x + right * found.cell)
        axes.set_ylim(y + bottom * found.cell, y + top * found.cell)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.tick_params(labelsize=8)
    axes.xaxis.set_major_locator(MaxNLocator(_TICKS))
    axes.yaxis.set_major_locator(MaxNLocator(_TICKS))
    axes.ticklabel_format(useOffset=False, style="plain")
