"""What the map has where elements stand, counted in its last frame."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from episode_builders import World, trace, world

from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.measuring.element_watch import ElementCells, ElementWatch
from treadwell.measuring.watch import Watch

COURSE = """
[[course]]
kind = "ramp"
name = "slope"
position = [-0.4, 0.0]
length = 0.8
width = 0.4
rise = 0.08
[[course]]
kind = "box"
name = "curtain"
position = [0.0, 0.5]
size = [0.4, 0.05, 0.3]
base = 0.3
"""
WORLD = world(COURSE, start="position = [-2.0, 0.0]")
SIDE = 40

_watch: type[Watch] = ElementWatch


def seen(kind: np.ndarray, height: np.ndarray, built: World = WORLD) -> dict[str, ElementCells]:
    episode: Any = SimpleNamespace(course=built.course)
    watch = ElementWatch(episode)
    assert watch.findings() == ()
    watch.frame(trace(built, 0, view_kind=kind, view_height=height))
    return {one.name: one for one in watch.findings()}


def flat(value: float) -> np.ndarray:
    return np.full((SIDE, SIDE), value, dtype=np.float32)


def sloped(off: float, tilt: float = 0.0) -> np.ndarray:
    """Heights along the slope's own, so much off and turned by so much more about y."""
    x = -0.8 + (np.arange(SIDE) + 0.5) * 0.04
    angle = math.atan(0.1) + tilt
    return np.tile(((x + 0.4) * math.tan(angle) + off).astype(np.float32), (SIDE, 1))


def test_floor_on_a_slope_is_measured_against_its_height_there_and_its_tilt() -> None:
    kind = np.full((SIDE, SIDE), FLOOR, dtype=np.uint8)
    slope = seen(kind, sloped(0.002))["slope"]
    assert slope.cells == slope.floor > 100
    assert slope.errors == pytest.approx([0.002] * slope.cells, abs=1e-6)
    assert slope.tilt_error == pytest.approx(0.0, abs=1e-3)
    turned = seen(kind, sloped(0.0, math.radians(-2.0)))["slope"]
    assert turned.tilt_error == pytest.approx(math.radians(2.0), abs=1e-3)


def test_a_slope_without_floor_has_no_tilt() -> None:
    kind = np.full((SIDE, SIDE), OBSTACLE, dtype=np.uint8)
    slope = seen(kind, flat(0.1))["slope"]
    assert (slope.floor, slope.obstacle, slope.errors) == (0, slope.cells, ())
    assert slope.tilt_error is None


def test_of_what_is_thin_the_cells_count_whose_centre_lies_over_it() -> None:
    kind = np.full((SIDE, SIDE), FLOOR, dtype=np.uint8)
    kind[32:34] = OBSTACLE
    curtain = seen(kind, flat(0.0))["curtain"]
    assert curtain.obstacle == curtain.cells == 10


def test_what_has_no_solid_has_no_cell() -> None:
    built = world('[[course]]\nkind = "vegetation"', start="position = [-2.0, 0.0]")
    found = seen(np.full((SIDE, SIDE), FLOOR, dtype=np.uint8), flat(0.0), built)
    assert [one.cells for one in found.values()] == [0]
