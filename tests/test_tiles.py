"""Claims about the tiles of a recorded map: they tell what changed, all of it, and nothing else."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.recording.tiles import SIDE, Tiles

CELL = 0.04
Seen = dict[str, set[tuple[float, float, float]]]


def cells_of(tiles: Tiles, kind: int, *, every: bool = False) -> Seen:
    cells = tiles.changed(kind, every=every)
    places = np.column_stack([cells.x, cells.y, cells.height])
    return {
        name: {tuple(np.round(place, 4)) for place in part.tolist()}
        for name, (part,) in cells.split(places)
    }


def truth(
    origin: tuple[float, float], kind: NDArray[np.uint8], height: NDArray[np.float32], of: int
) -> set[tuple[float, float, float]]:
    row, col = np.nonzero(kind == of)
    x, y = origin[0] + (col + 0.5) * CELL, origin[1] + (row + 0.5) * CELL
    places = np.column_stack([x, y, height[row, col]])
    return {tuple(np.round(place, 4)) for place in places.tolist()}


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.integers(-70, 70), st.integers(-70, 70)), min_size=1, max_size=6),
    st.integers(0, 99),
)
def test_what_stays_of_all_tiles_is_the_window(corners: list[tuple[int, int]], seed: int) -> None:
    random, tiles = np.random.default_rng(seed), Tiles()
    shown: dict[int, Seen] = {FLOOR: {}, OBSTACLE: {}}
    for col, row in corners:
        origin = (0.02 + col * CELL, row * CELL)
        kind = random.choice(3, (40, 50), p=(0.5, 0.3, 0.2)).astype(np.uint8)
        height = random.integers(0, 3, kind.shape).astype(np.float32)
        height[kind == 0] = np.nan
        tiles.update(origin, CELL, kind, height)
        for of, parts in shown.items():
            parts |= cells_of(tiles, of)
            assert set.union(set(), *parts.values()) == truth(origin, kind, height, of)


def test_only_the_tile_changes_in_which_a_cell_did() -> None:
    tiles = Tiles()
    kind, height = np.ones((3 * SIDE, 3 * SIDE), np.uint8), np.zeros((3 * SIDE, 3 * SIDE), "f4")
    assert tiles.update((0.0, 0.0), CELL, kind, height)
    assert len(cells_of(tiles, FLOOR)) == 9
    assert not tiles.update((0.0, 0.0), CELL, kind.copy(), height.copy())
    assert not cells_of(tiles, FLOOR)
    raised = height.copy()
    raised[SIDE, 0] = 0.01
    assert tiles.update((0.0, 0.0), CELL, kind, raised)
    assert list(cells_of(tiles, FLOOR)) == ["0_1"]
    assert not cells_of(tiles, OBSTACLE)
    kind = kind.copy()
    kind[0, 2 * SIDE] = OBSTACLE
    tiles.update((0.0, 0.0), CELL, kind, raised)
    assert list(cells_of(tiles, FLOOR)) == list(cells_of(tiles, OBSTACLE)) == ["2_0"]
    tiles.update((0.0, 0.0), CELL, kind, raised)
    assert not cells_of(tiles, OBSTACLE)
    assert list(cells_of(tiles, OBSTACLE, every=True)) == ["2_0"]


def test_a_tile_keeps_its_name_where_the_window_moves() -> None:
    tiles = Tiles()
    kind, height = np.zeros((SIDE, SIDE), np.uint8), np.zeros((SIDE, SIDE), np.float32)
    kind[-1, -1] = FLOOR
    tiles.update((1.0, 2.0), CELL, kind, height)
    (first,) = cells_of(tiles, FLOOR)
    moved = np.zeros_like(kind)
    moved[-6, -4] = FLOOR
    assert not tiles.update((1.0 + 3 * CELL, 2.0 + 5 * CELL), CELL, moved, height)
    assert not cells_of(tiles, FLOOR)
    assert list(cells_of(tiles, FLOOR, every=True)) == [first]


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_height_that_is_no_number_is_as_it_was(value: float) -> None:
    tiles, kind = Tiles(), np.ones((4, 4), np.uint8)
    height = np.full((4, 4), value, np.float32)
    assert tiles.update((0.0, 0.0), CELL, kind, height)
    assert not tiles.update((0.0, 0.0), CELL, kind, height.copy())
