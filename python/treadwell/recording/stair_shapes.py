"""Stairs in the recording: what is known of them, where feet are to land and where they landed."""

import math
from typing import Final

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from treadwell.protocols import Footstep
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import (
    FITTED_EDGE,
    FRONT_EDGE,
    LANDED_SOLES,
    PLANNED_SOLE,
    STAIR,
)
from treadwell.trace import FLOOR_DEPTH, StairTrace, Trace

_Colour = tuple[int, int, int, int]

_MARKS: Final = 12
"""Landings that stay to be seen."""
_FAINT: Final = 90
"""Opacity of what is remembered; 255 is seen now."""
_ABOVE: Final = 0.004
"""Metres by which lines lie above what they are on."""


class StairShapes:
    """Writes stairs, planned and done landings, and missteps of each camera frame."""

    def __init__(self, rows: FrameLog, sole: tuple[float, float]) -> None:
        """Begin with nothing.

        Args:
            rows: of the recording.
            sole: m, length and width of a sole.
        """
        self._rows, self._sole = rows, sole
        self._stairs_shown: list[tuple[object, ...]] = []
        self._listed: tuple[Footstep, ...] = ()
        self._touch = (True, True)
        self._marks: list[tuple[NDArray[np.float64], tuple[int, int, int]]] = []
        self._misstep: str | None = None
        looks = [
            ("", "", 0x00000000),
            ("no_ground", "misstep: no ground", 0xE74C3CFF),
            ("obstructed", "misstep: obstructed", 0xF1C40FFF),
            ("left_leg_buckled", "misstep: left leg buckled", 0x9B59B6FF),
            ("right_leg_buckled", "misstep: right leg buckled", 0x9B59B6FF),
            ("stumbled", "stumbled", 0xE67E22FF),
        ]
        names, labels, shades = zip(*looks, strict=True)
        colours = np.array(shades, dtype=np.uint32)
        style = rr.StateConfiguration(values=names, labels=labels, colors=colours)
        rows.stream.log("behaviour/misstep", style, static=True)

    def log(self, trace: Trace) -> None:
        """Write a camera frame; the time is set."""
        self._log_stairs(trace.stairs)
        self._log_planned(trace)
        self._log_landed(trace)
        if trace.misstep != self._misstep:
            self._misstep = trace.misstep
            self._rows.log("behaviour/misstep", rr.StateChange, state=[trace.misstep or ""])

    def _log_stairs(self, stairs: tuple[StairTrace, ...]) -> None:
        shown = [_content(stair) for stair in stairs]
        if shown == self._stairs_shown:
            return
        self._stairs_shown = shown
        # The floor at the foot of stairs is one of them, but its rim would lie over everything.
        steps = [s for s in stairs if s.depth() < FLOOR_DEPTH]
        rims = [_raised([*s.front, *s.back[::-1], s.front[0]]) for s in steps]
        self._lines("world/stairs", rims, [(*STAIR, _opacity(s)) for s in steps], 0.003)
        fronts = [_raised(s.front) for s in stairs]
        colours = [_edge_colour(s, fitted=s.front_fitted) for s in stairs]
        self._lines("world/stairs/front", fronts, colours, 0.006)
        self._rows.style(
            "world/stairs/height",
            rr.Points3D,
            radii=[0.001],
            colors=[(255, 255, 255)],
            show_labels=[True],
        )
        self._rows.log(
            "world/stairs/height",
            rr.Points3D,
            positions=[s.front.mean(axis=0) for s in steps],
            labels=[f"{1e3 * s.height():.0f} mm" for s in steps],
        )
        backs = [s for s in stairs if s.back_fitted]
        colours = [_edge_colour(s, fitted=True) for s in backs]
        self._lines("world/stairs/back", [_raised(s.back) for s in backs], colours, 0.004)

    def _log_planned(self, trace: Trace) -> None:
        """Draw where the listed steps are to land: relative to where the robot stood before."""
        if trace.footsteps != self._listed:
            self._listed, here = trace.footsteps, trace.map_from_robot
            soles = []
            for step in trace.footsteps:
                middle = here[:3, :3] @ (step.x, step.y, step.height) + here[:3, 3]
                yaw = math.atan2(here[1, 0], here[0, 0]) + step.yaw
                soles.append(self._outline(middle, (math.cos(yaw), math.sin(yaw))))
            self._lines("world/soles/planned", soles, [(*PLANNED_SOLE, 255)], 0.002)

    def _log_landed(self, trace: Trace) -> None:
        if trace.soles is None:
            return
        count = len(self._marks)
        for side, sole in enumerate(trace.soles):
            if trace.touch[side] and not self._touch[side]:
                outline = self._outline(np.array([sole.x, sole.y, sole.z]), sole.forward)
                self._marks.append((outline, LANDED_SOLES[side]))
        self._touch = trace.touch
        if len(self._marks) > count:
            del self._marks[:-_MARKS]
            colours = [(*colour, 255) for _, colour in self._marks]
            self._lines("world/soles/landed", [m for m, _ in self._marks], colours, 0.002)

    def _outline(
        self, middle: NDArray[np.float64], forward: tuple[float, float]
    ) -> NDArray[np.float64]:
        """Return the closed outline of a sole, (5, 3) m."""
        ahead = np.array([*forward, 0.0]) * self._sole[0] / 2
        left = np.array([-forward[1], forward[0], 0.0]) * self._sole[1] / 2
        corners = [ahead + left, ahead - left, -ahead - left, -ahead + left, ahead + left]
        return _raised([middle + corner for corner in corners])

    def _lines(
        self,
        entity: str,
        strips: list[NDArray[np.float64]],
        colours: list[_Colour],
        radius: float,
    ) -> None:
        self._rows.style(entity, rr.LineStrips3D, radii=[radius])
        self._rows.log(entity, rr.LineStrips3D, strips=strips, colors=colours)


def _content(stair: StairTrace) -> tuple[object, ...]:
    """Return all that is drawn of a stair, to be compared."""
    fitted = stair.front_fitted, stair.back_fitted
    return stair.front.tobytes(), stair.back.tobytes(), *fitted, _opacity(stair)


def _opacity(stair: StairTrace) -> int:
    return _FAINT if stair.steps_ago else 255


def _edge_colour(stair: StairTrace, *, fitted: bool) -> _Colour:
    return (*(FITTED_EDGE if fitted else FRONT_EDGE), _opacity(stair))


def _raised(points: list[NDArray[np.float64]] | NDArray[np.float64]) -> NDArray[np.float64]:
    raised: NDArray[np.float64] = np.asarray(points) + np.array([0.0, 0.0, _ABOVE])
    return raised
