"""Vegetation: thin stems that rays meet and feet do not."""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from treadwell.course.outlines import Floats, heading, left_of
from treadwell.random_streams import stream
from treadwell.scenario.ground_elements import Vegetation

THICK_M: Final = 0.004
"""Side of a stem's triangle."""
LEAN: Final = 0.25
"""Metres a metre of height by which a stem leans at most."""
LOWEST: Final = 0.5
"""Of the height: the shortest stem."""
_SIDES: Final = np.array(
    [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]], np.int32
)
"""The sides of a stem of three edges: corners 0 to 2 at its foot, 3 to 5 at its tip."""


def stems(vegetation: Vegetation, name: str, seed: int) -> tuple[Floats, NDArray[np.int32]]:
    """Return vertices (n, 3) m, world, and faces (m, 3) of all stems: one mesh, one body for rays.

    Args:
        vegetation: the element.
        name: its name: the stems are drawn from that and the seed.
        seed: the episode's.
    """
    generator = stream(seed, f"course.{name}")
    count = vegetation.stems()
    along, across = (side * (generator.random(count) - 0.5) for side in vegetation.size)
    ahead, left = heading(vegetation.yaw), left_of(vegetation.yaw)
    foot = np.array(vegetation.position) + np.outer(along, ahead) + np.outer(across, left)
    height = vegetation.height * generator.uniform(LOWEST, 1.0, count)
    height[int(generator.integers(count))] = vegetation.height
    direction, lean = generator.uniform(0.0, 2.0 * math.pi, count), LEAN * generator.random(count)
    shift = (height * lean)[:, None] * np.column_stack([np.cos(direction), np.sin(direction)])
    turn = generator.uniform(0.0, 2.0 * math.pi, count)[:, None] + 2.0 * math.pi * np.arange(3) / 3
    around = THICK_M / math.sqrt(3.0) * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    feet, tips = foot[:, None] + around, foot[:, None] + shift[:, None] + around
    vertices = np.zeros((count, 6, 3))
    vertices[:, :3, :2], vertices[:, 3:, :2] = feet, tips
    vertices[:, 3:, 2] = height[:, None]
    faces = _SIDES[None] + 6 * np.arange(count, dtype=np.int32)[:, None, None]
    return vertices.reshape(-1, 3), faces.reshape(-1, 3)
