"""The picture of the experiment `stairs`: what was known of each step before it was climbed."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from treadwell.errors import RecordingError
from treadwell.experiments.experiment import Picture, Results
from treadwell.measuring.step_watch import EDGE_M, HEIGHT_M, StepError

FILE: Final = "steps.png"
_TITLE: Final = "Each step as it was known before a foot left for it, against the truth"


def stairs_pictures(results: Results, folder: Path) -> list[Picture]:
    """Draw the steps of all runs into a folder; nothing where none was known.

    Raises:
        RecordingError: the file cannot be written.
    """
    steps = [step for some in results.values() for run in some for step in run.steps]
    known = [step for step in steps if step.is_known()]
    if not known:
        return []
    draw_steps(folder / FILE, known)
    return [Picture(_TITLE, folder / FILE)]


def draw_steps(path: Path, steps: Sequence[StepError]) -> None:
    """Draw how high each step was believed to be, and how far off height and edge were.

    Args:
        path: of the PNG file.
        steps: one or more, each known.

    Raises:
        RecordingError: the file cannot be written.
    """
    rises = [1e3 * step.rise for step in steps]
    heights = [1e3 * step.height for step in steps]
    edges = [1e3 * step.edge for step in steps]
    figure = Figure(figsize=(9.0, 4.2), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    believed = [rise + off for rise, off in zip(rises, heights, strict=True)]
    span = (min(*rises, *believed, 0.0) - 5.0, max(*rises, *believed, 0.0) + 5.0)
    left.plot(span, span, color="#e4572e", linewidth=1.3, label="the truth")
    left.plot(rises, believed, ".", color="#31688e", markersize=5, label="ours")
    left.set(xlabel="true change of height (mm)", ylabel="believed change of height (mm)")
    left.set(xlim=span, ylim=span, aspect="equal")
    asked = (1e3 * EDGE_M, 1e3 * HEIGHT_M)
    corner, size = (-asked[0], -asked[1]), (2 * asked[0], 2 * asked[1])
    right.add_patch(Rectangle(corner, *size, fill=False, linestyle="--", label="asked for"))
    right.plot(0.0, 0.0, "+", color="#e4572e", markersize=12, label="the truth")
    right.plot(edges, heights, ".", color="#31688e", markersize=5, label="ours")
    right.set(xlabel="edge off, along the foot's line (mm)", ylabel="height off (mm)")
    for axes in (left, right):
        axes.tick_params(labelsize=8)
        axes.legend(fontsize=8)
    try:
        figure.savefig(path, facecolor="white", metadata={"Software": None})
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from error
