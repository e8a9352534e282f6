"""Planned footsteps in the recording: soles, the ground that they were planned over, the cost."""

import io
from typing import Final

import numpy as np
import rerun as rr
from numpy.typing import NDArray
from PIL import Image

from treadwell.footstep_plan import PlannedFootstep
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import CAREFUL_SOLE, EXIT, UNSEEN, WALKED_SOLE, height_colours
from treadwell.trace import SteppingTrace

Floats = NDArray[np.float64]

_ABOVE: Final = 0.003
"""Metres by which soles are drawn above what they are on."""
_SHADES: Final = 255
"""Colours from the lowest ground to the highest; one more is the unseen."""
_FAINTEST: Final = 110
"""Opacity of a sole that bears in no part; 255 is one that bears in all."""


class StepShapes:
    """Writes each plan of footsteps when it is new."""

    def __init__(
        self, rows: FrameLog, *, low: float, high: float, sole: tuple[float, float]
    ) -> None:
        """Say what is always the same.

        Args:
            rows: of the recording.
            low: m, height with the darkest colour.
            high: m, height with the brightest.
            sole: m, length and width of a sole.
        """
        self._rows, self._sole, self._range = rows, sole, (low, high)
        heights = np.linspace(low, high, _SHADES, dtype=np.float32)
        self._palette = [*height_colours(heights, low, high).ravel().tolist(), *UNSEEN]

    def log(self, stepping: SteppingTrace | None) -> None:
        """Write a plan; the time is set."""
        if stepping is None:
            return
        plan, log, style = stepping.plan, self._rows.log, self._rows.style
        style("world/soles/plan", rr.LineStrips3D, radii=[0.0015])
        style("map/ground", rr.EncodedImage, media_type=["image/png"])
        style("map/ground/soles", rr.LineStrips2D, radii=[0.7])
        style("map/ground/exit", rr.Points2D, colors=[EXIT], radii=[3.0])
        style("footsteps/cost", rr.SeriesLines, names=["whole way (s)", "planned steps (s)"])
        outlines = [self._outline(step) for step in plan]
        colours = [_colour(step) for step in plan]
        log("world/soles/plan", rr.LineStrips3D, strips=outlines, colors=colours)
        log("map/ground", rr.EncodedImage, blob=[self._picture(stepping)])
        pixels = [_pixels(stepping, outline[:, :2]) for outline in outlines]
        log("map/ground/soles", rr.LineStrips2D, strips=pixels, colors=colours)
        exits = np.empty((0, 2)) if stepping.exit is None else np.array([stepping.exit])
        log("map/ground/exit", rr.Points2D, positions=_pixels(stepping, exits))
        log("footsteps/cost", rr.Scalars, scalars=[plan.whole_cost, plan.cost])

    def _outline(self, step: PlannedFootstep) -> Floats:
        """Return the closed outline of a sole on its plane, (5, 3) m."""
        half = np.array(self._sole) / 2
        corners = half * np.array([(1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1)])
        cos, sin = step.forward()
        x = step.x + cos * corners[:, 0] - sin * corners[:, 1]
        y = step.y + sin * corners[:, 0] + cos * corners[:, 1]
        return np.column_stack([x, y, step.height + corners @ step.slope + _ABOVE])

    def _picture(self, stepping: SteppingTrace) -> bytes:
        """Return the ground as a PNG with a palette, its first row at the top."""
        low, high = self._range
        ground = stepping.ground
        known = np.isfinite(ground)
        share = (np.where(known, ground, low).clip(low, high) - low) / (high - low)
        shades = np.where(known, np.round(share * (_SHADES - 1)), _SHADES).astype(np.uint8)
        picture = Image.fromarray(shades[::-1], mode="P")
        picture.putpalette(self._palette)
        encoded = io.BytesIO()
        picture.save(encoded, "png", compress_level=1)
        return encoded.getvalue()


def _pixels(stepping: SteppingTrace, points: Floats) -> Floats:
    """Return where points (n, 2) of the map frame are in the picture of the ground."""
    at = (points - np.asarray(stepping.origin)) / stepping.cell
    pixels: Floats = np.column_stack([at[:, 0], stepping.ground.shape[0] - at[:, 1]])
    return pixels


def _colour(step: PlannedFootstep) -> tuple[int, int, int, int]:
    opacity = _FAINTEST + (255 - _FAINTEST) * step.bearing_share
    return (*(WALKED_SOLE if step.manner == "walked" else CAREFUL_SOLE), round(opacity))
