"""Stairs as blocks: straight or turning, up, and down again where asked for."""

from dataclasses import dataclass

import numpy as np

from treadwell.course.outlines import Floats, clipped, heading, rectangle
from treadwell.course.pieces import Piece, Top, block, level
from treadwell.scenario.elements import Stairs

RUN_ON = 0.02
"""How far a block runs on under the higher one beside it, metres, at least."""


@dataclass(frozen=True)
class Tread:
    """One step in the order of walking over the stairs."""

    part: str
    front: Floats
    """Middle of its front edge, world x, y."""
    yaw: float
    depth: float
    height: float

    @property
    def back(self) -> Floats:
        """Middle of its back edge, world x, y."""
        return self.front + self.depth * heading(self.yaw)


def treads_of(stairs: Stairs) -> list[Tread]:
    """Return the steps in the order of walking: up, the landing, and the same down again.

    Each step's front edge is turned about its middle by `turn` against the one before, and its
    middle is the middle of the back edge of the one before.
    """
    heights, depths = np.cumsum(stairs.rises()), stairs.treads()
    order = [(f"step {i + 1}", i) for i in range(stairs.steps)]
    if stairs.descent:
        order += [(f"step {i + 1} down", i) for i in reversed(range(stairs.steps - 1))]
    treads: list[Tread] = []
    for part, i in order:
        front = treads[-1].back if treads else np.array(stairs.position)
        yaw = treads[-1].yaw + stairs.turn if treads else stairs.yaw
        treads.append(Tread(part, front, yaw, depths[i], float(heights[i])))
    return treads


def stairs_pieces(stairs: Stairs) -> tuple[list[Piece], list[Top]]:
    """Return a block and a top for each step.

    Where edges are turned against each other, the lower block runs on under the higher one, so
    that no gap opens; its top ends at the higher one's edge.
    """
    treads = treads_of(stairs)
    wedge = stairs.width / 2 * abs(np.sin(stairs.turn)) + RUN_ON
    pieces, tops = [], []
    for i, tread in enumerate(treads):
        begin, end = 0.0, tread.depth
        higher_before = i > 0 and treads[i - 1].height > tread.height
        higher_behind = i + 1 < len(treads) and treads[i + 1].height > tread.height
        if higher_behind:
            end += min(wedge, treads[i + 1].depth)
        if higher_before:
            begin -= min(wedge, treads[i - 1].depth)
        solid = rectangle(tread.front, tread.yaw, (begin, end), stairs.width)
        top = solid
        if higher_behind:
            top = clipped(top, treads[i + 1].front, heading(treads[i + 1].yaw))
        if higher_before:
            top = clipped(top, tread.front, -heading(treads[i - 1].yaw))
        pieces.append(block(tread.part, solid, tread.yaw, 0.0, tread.height))
        tops.append(level(tread.part, top, tread.height))
    return pieces, tops
