"""What is known of the space, and where the robot may be in it: voxels and guesses, recorded."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from treadwell._core import Octree
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.layout import ESTIMATE, height_colours
from treadwell.trace import Trace

Floats = NDArray[np.floating]

_FAINT = 90
"""Opacity, of 255, of the static map: what was seen shows in it."""
_LOCAL = (215, 60, 40)
"""Colour of what was seen."""


class Volumes:
    """Writes the map that was told, the one that was made, and the guesses of a localizer."""

    def __init__(
        self, rows: FrameLog, static_map: Octree | None, height: tuple[float, float]
    ) -> None:
        """Log the map that was told, if any.

        Args:
            rows: of the recording.
            static_map: what the robot knows of the place beforehand.
            height: m, what has the darkest and the brightest colour.
        """
        self._rows = rows
        if static_map is not None:
            centres, halves = bars(*static_map.occupied())
            shades = height_colours(centres[:, 2].astype(np.float32), *height)
            opacity = np.full((len(shades), 1), _FAINT, dtype=np.uint8)
            boxes = rr.Boxes3D(
                centers=centres,
                half_sizes=halves,
                colors=np.hstack([shades, opacity]),
                fill_mode=rr.components.FillMode.Solid,
            )
            rows.stream.log("world/maps/static", boxes, static=True)

    def log(self, trace: Trace) -> None:
        """Write a camera frame's; the time is set."""
        if len(trace.occupied):
            centres, halves = bars(trace.occupied[:, :3], trace.occupied[:, 3])
            self._rows.style(
                "world/maps/local",
                rr.Boxes3D,
                colors=[_LOCAL],
                fill_mode=[rr.components.FillMode.Solid],
            )
            self._rows.log("world/maps/local", rr.Boxes3D, centers=centres, half_sizes=halves)
        if len(trace.guesses):
            entity = "world/maps/guesses"
            self._rows.style(entity, rr.Arrows3D, colors=[ESTIMATE], radii=[0.004])
            self._rows.log(
                entity,
                rr.Arrows3D,
                origins=trace.guesses[:, :3],
                vectors=_headings(trace.guesses[:, 3]),
            )


def bars(centres: Floats, sides: Floats) -> tuple[Floats, Floats]:
    """Join voxels of one size that lie side by side: first those in a row, then rows alike.

    A viewer draws some ten thousand boxes at most, and a house has more voxels. Layers stay apart:
    their heights are their colours.

    Args:
        centres: (n, 3) m, of an octree's voxels.
        sides: (n,) m.

    Returns:
        Centres and half sizes of boxes that fill the same space, (m, 3) each, m.
    """
    halves = np.repeat(sides[:, None] / 2, 3, axis=1)
    if not len(centres):
        return centres, halves
    unit = halves.min()
    for along, across in ((0, 1), (1, 0)):
        # Counted in the least half side, of which all are multiples: equal is equal then.
        at, half = (np.rint(values / unit).astype(np.int64) for values in (centres, halves))
        keys = (at[:, along], at[:, across], half[:, across], half[:, 2], at[:, 2])
        order = np.lexsort(keys)
        begin, end = (at[order, along] + sign * half[order, along] for sign in (-1, 1))
        same = begin[1:] == end[:-1]
        for key in keys[1:]:
            same &= np.diff(key[order]) == 0
        first = np.flatnonzero(np.r_[True, ~same])
        last = np.r_[first[1:], len(order)] - 1
        centres, halves = centres[order[first]], halves[order[first]]
        centres[:, along] = 0.5 * unit * (begin[first] + end[last])
        halves[:, along] = 0.5 * unit * (end[last] - begin[first])
    return centres, halves


def _headings(yaw: Floats) -> Floats:
    """Return short arrows (n, 3) that point to headings, rad."""
    return 0.08 * np.column_stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)])
