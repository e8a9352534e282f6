"""What the map has where a box is, was, or moves, counted frame by frame."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from episode_builders import trace, world

from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.measuring.map_watch import MapFrame, MapWatch
from treadwell.measuring.watch import Watch

BOX = """
[[course]]
kind = "platform"
name = "box"
position = [0.2, 0.0]
size = [0.16, 0.16, 0.06]
[[event]]
at = 1.0
do = "remove"
name = "box"
"""
WORLD = world(BOX)
SIDE = 4
"""Cells on each side of the box: its edges lie on the lattice's lines."""

_watch: type[Watch] = MapWatch


class Scene:
    """A map of the floor on which the box stands, as only the watch sees it."""

    def __init__(self) -> None:
        self.place = np.zeros(3)
        self.events = SimpleNamespace(present={"box"}, place=lambda *_: self.place, fired=[])
        episode: Any = SimpleNamespace(
            course=WORLD.course, simulation=WORLD.simulation, events=self.events
        )
        self.watch = MapWatch(episode)
        self.kind = np.full((40, 40), FLOOR, dtype=np.uint8)
        self.height = np.zeros((40, 40), dtype=np.float32)
        # The window begins at -0.8 m: the box's first row and column.
        self.box = np.s_[18 : 18 + SIDE, 23 : 23 + SIDE]

    def see(self) -> MapFrame:
        made = trace(WORLD, 0, view_kind=self.kind, view_height=self.height)
        self.watch.frame(made)
        last: MapFrame = self.watch.findings().frames[-1]
        return last


def test_a_box_in_the_map_is_found() -> None:
    scene = Scene()
    assert scene.see().found == 0
    scene.height[scene.box] = 0.055
    seen = scene.see()
    assert (seen.covered, seen.found, seen.left, seen.between) == (SIDE**2, SIDE**2, 0, 0)


@pytest.mark.parametrize("kind", [FLOOR, OBSTACLE])
def test_a_removed_box_is_stale_until_the_map_forgets_it(kind: int) -> None:
    scene = Scene()
    scene.height[scene.box], scene.kind[scene.box] = 0.06, kind
    scene.see()
    scene.events.present.clear()
    seen = scene.see()
    assert (seen.covered, seen.left, seen.stale) == (0, SIDE**2, SIDE**2)
    scene.kind[scene.box], scene.height[scene.box] = FLOOR, 0.004
    assert scene.see().stale == 0
    scene.kind[scene.box], scene.height[scene.box] = 0, np.nan
    assert scene.see().stale == 0


def test_a_height_of_neither_the_box_nor_the_floor_is_between() -> None:
    scene = Scene()
    scene.height[scene.box] = np.linspace(0.0, 0.06, SIDE**2).reshape(SIDE, SIDE)
    seen = scene.see()
    assert seen.floors == SIDE**2
    # 0, 4, 8 mm are the floor; 52, 56, 60 mm the top.
    assert seen.between == SIDE**2 - 6


def test_a_box_that_moves_leaves_cells_and_covers_others() -> None:
    scene = Scene()
    scene.see()
    scene.place = np.array([0.08, 0.0, 0.0])
    seen = scene.see()
    assert (seen.covered, seen.left) == (SIDE**2, SIDE * 2)


def test_cells_keep_their_place_when_the_window_moves() -> None:
    scene = Scene()
    scene.see()
    scene.events.present.clear()
    moved = trace(
        WORLD, 0, view_kind=scene.kind, view_height=scene.height, view_origin=(-0.72, -0.84)
    )
    scene.watch.frame(moved)
    assert scene.watch.findings().frames[-1].left == SIDE**2


def test_the_map_is_kept_as_it_was_before_each_event_and_in_the_end() -> None:
    scene = Scene()
    scene.see()
    scene.height = np.full_like(scene.height, 0.01)
    scene.see()
    scene.events.fired.append((1.0, "remove"))
    scene.height = np.full_like(scene.height, 0.02)
    scene.see()
    before, end = scene.watch.findings().pictures
    assert (before.height.max(), end.height.max()) == (np.float32(0.01), np.float32(0.02))
