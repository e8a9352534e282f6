"""Stairs in `map.png`, as they were seen last."""

from collections.abc import Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from treadwell.recording.steppable import outline
from treadwell.trace import StairTrace

_STAIR: Final = "#7ff0ff"
_FRONT: Final = "#ffbe00"
_FITTED: Final = "#00b7ff"
_TOO_HIGH: Final = "#c9a0ff"


def draw_stairs(
    axes: Axes, stairs: Sequence[StairTrace], too_high: Sequence[StairTrace] = ()
) -> None:
    """Draw the stairs as they were seen last, with their heights; dotted what is too high."""
    labels = {"stair": "stair", "front": "its front edge", "fitted": "the same, fitted"}
    for stair in stairs:
        axes.add_patch(
            Polygon(
                outline(stair),
                closed=True,
                fill=False,
                edgecolor=_STAIR,
                linewidth=1.0,
                zorder=3.2,
                label=labels.pop("stair", None),
            )
        )
        kind = "fitted" if stair.front_fitted else "front"
        axes.plot(
            stair.front[:, 0],
            stair.front[:, 1],
            color=_FITTED if stair.front_fitted else _FRONT,
            linewidth=2.2,
            zorder=3.4,
            label=labels.pop(kind, None),
        )
        _tell_height(axes, stair, _STAIR)
    for i, stair in enumerate(too_high):
        axes.add_patch(
            Polygon(
                outline(stair),
                closed=True,
                fill=False,
                edgecolor=_TOO_HIGH,
                linestyle=":",
                linewidth=1.0,
                zorder=3.2,
                label=None if i else "step too high",
            )
        )
        _tell_height(axes, stair, _TOO_HIGH)


def _tell_height(axes: Axes, stair: StairTrace, colour: str) -> None:
    axes.annotate(
        f"{1e3 * stair.height():.0f}",
        tuple(stair.front[0, :2]),
        xytext=(-2, 2),
        textcoords="offset points",
        fontsize=6,
        color=colour,
        zorder=3.4,
    )
