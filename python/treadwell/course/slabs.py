"""Slabs side by side, each tilted its own way: as boxes that reach into the ground."""

import math
from typing import Final

import mujoco
import numpy as np

from treadwell.course.outlines import Floats, heading, left_of
from treadwell.course.pieces import Piece, Top
from treadwell.random_streams import stream
from treadwell.scenario.ground_elements import Slabs

THICK: Final = 0.06
"""Metres of a slab beyond the height of the highest: so it reaches into the ground."""


def slab_pieces(slabs: Slabs, name: str, seed: int) -> tuple[list[Piece], list[Top]]:
    """Return a box and a top for each slab.

    Args:
        slabs: the element.
        name: its name: heights and tilts are drawn from that and the seed.
        seed: the episode's.
    """
    rows, columns = slabs.counts()
    extent = np.array([slabs.size[0] / rows, slabs.size[1] / columns])
    generator = stream(seed, f"course.{name}")
    turn = np.column_stack([heading(slabs.yaw), left_of(slabs.yaw)])
    pieces, tops = [], []
    for row in range(rows):
        for column in range(columns):
            place = (np.array([row, column]) + 0.5) * extent - np.array(slabs.size) / 2
            middle = np.array(slabs.position) + turn @ place
            slope, height = _drawn(generator, slabs, extent)
            part = f"slab {row + 1} {column + 1}"
            piece, top = _slab(part, middle, turn, extent, slope, height, slabs.rise)
            pieces.append(piece)
            tops.append(top)
    return pieces, tops


def _drawn(generator: np.random.Generator, slabs: Slabs, extent: Floats) -> tuple[Floats, float]:
    """Return a slab's slope along its length and across, (2,), and its middle's height, m."""
    way = heading(float(generator.uniform(-math.pi, math.pi)))
    steep = math.tan(float(generator.uniform(0.0, slabs.tilt)))
    half = float(np.abs(way) @ extent) / 2
    steep = min(steep, slabs.rise / 2 / half)
    spare = max(0.0, slabs.rise - 2 * steep * half)
    return steep * way, steep * half + spare * float(generator.random())


def _slab(
    part: str,
    middle: Floats,
    turn: Floats,
    extent: Floats,
    slope: Floats,
    height: float,
    most: float,
) -> tuple[Piece, Top]:
    """Return a slab and its top.

    Args:
        part: its name.
        middle: (2,) of its top, world.
        turn: (2, 2) world from the slabs' length and width.
        extent: (2,) its length and width as seen from above, m.
        slope: (2,) rise of its top along its length and across.
        height: of its middle, m.
        most: height of the highest slab, m.
    """
    across = np.array([*(turn @ slope), -1.0])
    up = -across / np.linalg.norm(across)
    along = np.array([*turn[:, 0], slope[0]]) / math.hypot(1.0, slope[0])
    axes = np.column_stack([along, np.cross(up, along), up])
    # Its corners lie within its share of the ground: a joint is left at its sides.
    half = np.array([*extent, THICK + most]) / 2
    half[:2] *= up[2]
    center = np.array([*middle, height]) - half[2] * up
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    face = {z: center + (np.column_stack([signs, np.full(4, z)]) * half) @ axes.T for z in (-1, 1)}
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, axes.ravel())
    return (
        Piece("box", part, np.vstack([face[-1], face[1]]), center, half, quaternion),
        Top(part, face[1]),
    )
