"""Where the robot went, in the recording: lines that grow, written piece by piece.

A line that is written anew with each of its points takes the square of their number. So it is cut:
a piece that is long enough is written for good under a name of its own, and the next one begins.
"""

import math
from typing import Final

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import ESTIMATE, ODOMETRY, TRUTH
from treadwell.trace import Trace

_SPACING: Final = 0.03
"""Metres between the points of a drawn trajectory."""
_MOST: Final = 64
"""Points of a piece."""
_RAISED: Final = np.array([0.0, 0.0, 0.02])
"""Metres by which they are drawn above the ground."""
_COLOURS: Final = {"truth": TRUTH, "estimate": ESTIMATE, "odometry": ODOMETRY}


class Tracks:
    """Writes the true, the believed and the counted way."""

    def __init__(self, rows: FrameLog) -> None:
        """Begin with nothing.

        Args:
            rows: of the recording.
        """
        self._rows = rows
        self._pieces: dict[str, list[NDArray[np.float64]]] = {name: [] for name in _COLOURS}
        self._done = dict.fromkeys(_COLOURS, 0)

    def log(self, trace: Trace) -> None:
        """Write where the robot is at a camera frame; the time is set."""
        self._add("truth", trace.truth_from_robot)
        self._add("estimate", trace.map_from_robot)
        self._add("odometry", trace.odometry_from_robot)

    def _add(self, name: str, pose: NDArray[np.float64]) -> None:
        piece, here = self._pieces[name], pose[:3, 3] + _RAISED
        if piece and math.dist(here, piece[-1]) < _SPACING:
            return
        piece.append(here)
        entity = f"world/trajectory/{name}"
        if len(piece) == _MOST:
            self._done[name] += 1
            self._draw(f"{entity}/{self._done[name]}", name, [np.array(piece)])
            self._draw(entity, name, [])
            del piece[:-1]
        elif len(piece) > 1:
            self._draw(entity, name, [np.array(piece)])

    def _draw(self, entity: str, name: str, lines: list[NDArray[np.float64]]) -> None:
        self._rows.style(entity, rr.LineStrips3D, colors=[_COLOURS[name]], radii=[0.005])
        self._rows.log(entity, rr.LineStrips3D, strips=lines)
