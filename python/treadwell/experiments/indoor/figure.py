"""What a figure of the chapter is to draw, and what comes of it."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from treadwell.map_making.picture import save_picture


@dataclass(frozen=True, slots=True)
class ChapterFigure:
    """A figure of the chapter, to be made again.

    Attributes:
        number: as the chapter has it.
        shows: what is seen, in a few words.
        chapter: what the chapter says of it.
        draw: a function of a module that draws it: given the picture's path and the file or folder
            of data, which it has none of where `data` is "", it returns what ours is.
        data: place in the folder of data that others recorded; "" where it needs none.
    """

    number: str
    shows: str
    chapter: str
    draw: Callable[[Path, Path], str]
    data: str = ""


@dataclass(frozen=True, slots=True)
class FigureToDraw:
    """One to draw, and where."""

    figure: ChapterFigure
    path: Path


@dataclass(frozen=True, slots=True)
class DrawnFigure:
    """What came of one.

    Attributes:
        figure: which.
        ours: what is seen in ours; why there is none where `path` is None.
        path: of the picture.
    """

    figure: ChapterFigure
    ours: str
    path: Path | None


def drawn(item: FigureToDraw) -> DrawnFigure:
    """Draw a figure; that its data are not there is an outcome."""
    figure, source = item.figure, Path()
    if figure.data:
        folder = os.environ.get("TREADWELL_DATA")
        if not folder:
            return DrawnFigure(
                figure, "not drawn: TREADWELL_DATA does not say where data are", None
            )
        source = Path(folder) / figure.data
        if not source.exists():
            return DrawnFigure(figure, f"not drawn: TREADWELL_DATA has no {figure.data}", None)
    return DrawnFigure(figure, figure.draw(item.path, source), item.path)


def panels(count: int, size: tuple[float, float]) -> tuple[Figure, list[Axes]]:
    """Return a figure of panels side by side, seen from above, each of this size, inches."""
    figure = Figure(figsize=(size[0] * count, size[1]), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes = list(figure.subplots(1, count, squeeze=False).flat)
    for place in axes:
        place.set_aspect("equal")
        place.set_xlabel("x (m)", fontsize=8)
        place.set_ylabel("y (m)", fontsize=8)
        place.tick_params(labelsize=7)
    return figure, axes


def save(figure: Figure, path: Path) -> None:
    """Write a picture, whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    save_picture(figure, path)
