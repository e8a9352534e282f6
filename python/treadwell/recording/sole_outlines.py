"""Soles in `map.png`: where they were planned, and where they came down."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from treadwell.recording.step_memory import StepMemory

_PLANNED: Final = "#ff8c00"
_TAKEN: Final = "#f2f2f2"


def draw_soles(axes: Axes, memory: StepMemory, sole: tuple[float, float]) -> None:
    """Draw where soles were planned and put, while the feet took listed steps."""
    kinds = (
        ("planned sole", memory.planned, _PLANNED, 0.7, 5.2),
        ("sole that came down", memory.taken, _TAKEN, 0.9, 5.4),
    )
    for name, places, colour, width, order in kinds:
        label: str | None = name
        for place in places:
            ahead = np.array(place.forward) * sole[0] / 2
            left = np.array([-place.forward[1], place.forward[0]]) * sole[1] / 2
            corners = [ahead + left, ahead - left, -ahead - left, -ahead + left]
            axes.add_patch(
                Polygon(
                    np.array([place.x, place.y]) + corners,
                    closed=True,
                    fill=False,
                    edgecolor=colour,
                    linewidth=width,
                    zorder=order,
                    label=label,
                )
            )
            label = None
