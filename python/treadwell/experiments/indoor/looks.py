"""Landmarks that nobody named: looks of things, laid out in three dimensions (Fig. 36.17)."""

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from treadwell._core import Embedding
from treadwell.experiments.indoor.figure import save

Floats = NDArray[np.float64]

_SIDE: Final = 12
"""Of a picture of a thing, pixels."""
_KINDS: Final = ("rock", "post", "box", "step in a wall")
_LEARNED: Final = 160
_ASKED: Final = 200
_NEAREST: Final = 5
_NOISE: Final = 0.06
_COLOURS: Final = ("#1f7a8c", "#e2571e", "#7b4fb5", "#6a994e")


def draw_looks(path: Path, _source: Path) -> str:
    """Draw where looks lie; what kind each is of colours it, and was told to nobody."""
    numbers = np.random.default_rng(0)
    learned = np.stack([_look(at % len(_KINDS), numbers) for at in range(_LEARNED)])
    asked = np.stack([_look(at % len(_KINDS), numbers) for at in range(_ASKED)])
    embedding = Embedding(learned)
    known, places = embedding.place(learned), embedding.place(asked)
    away = np.linalg.norm(places[:, None] - known[None], axis=2)
    near = np.argsort(away, axis=1, kind="stable")[:, :_NEAREST] % len(_KINDS)
    votes = np.stack([(near == kind).sum(axis=1) for kind in range(len(_KINDS))], axis=1)
    right = int((votes.argmax(axis=1) == np.arange(_ASKED) % len(_KINDS)).sum())
    figure = Figure(figsize=(6.0, 4.8), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.add_subplot(projection="3d")  # its class has no types
    for kind, (name, colour) in enumerate(zip(_KINDS, _COLOURS, strict=True)):
        axes.scatter(*known[kind :: len(_KINDS)].T, s=9, color=colour, label=name)
    axes.set_title(f"{_LEARNED} looks in {known.shape[1]} dimensions", fontsize=9, loc="left")
    axes.tick_params(labelsize=6)
    axes.legend(fontsize=8, loc="upper right")
    save(figure, path)
    return (
        f"of {_ASKED} other looks the {_NEAREST} nearest tell the kind of {right / _ASKED:.0%}, "
        f"from {_SIDE * _SIDE} pixels to {known.shape[1]} numbers; depths drawn by formulas, with "
        "noise"
    )


def _look(kind: int, numbers: np.random.Generator) -> Floats:
    """Return how much nearer than its background each pixel of a thing is, from a random side."""
    turn, slender, lean = numbers.uniform([0.0, 0.75, -0.08], [1.6, 1.3, 0.08])
    middle = (np.arange(_SIDE) + 0.5) / _SIDE * 2.0 - 1.0
    x, z = np.meshgrid(middle, middle)
    shift = numbers.uniform(-0.08, 0.08, 2)
    z = z - shift[1]
    x = x - shift[0] - lean * z
    if kind == 0:
        depth = 0.7 - (x / slender) ** 2 - z**2
    elif kind == 1:
        depth = 0.06 - (x / slender) ** 2
    elif kind == 2:
        left, right = 0.6 * slender * np.cos(turn), 0.6 * slender * np.sin(turn)
        depth = np.where(np.abs(z) < 0.6, np.where(x < 0.0, left + x, right - x), -1.0)
    else:
        depth = np.where(x > 0.3 * slender - 0.15, 0.9, 0.3)
    seen = np.sqrt(np.maximum(depth, 0.0)).ravel()
    return np.asarray(seen + _NOISE * numbers.standard_normal(seen.shape))
