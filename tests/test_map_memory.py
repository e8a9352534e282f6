"""Claims about the map's memory: a cell keeps its last value, whatever the window does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN, MapMemory

CELL = 0.04


def window(
    memory: MapMemory,
    col: int,
    row: int,
    kind: np.ndarray,
    height: float = 0.01,
    seen: int = 3,
    forgotten: int = 0,
) -> None:
    kind = np.asarray(kind, dtype=np.uint8)
    heights = np.where(kind == UNKNOWN, np.nan, height).astype(np.float32)
    sightings = np.where(kind == FLOOR, seen, 0).astype(np.uint16)
    memory.update((col * CELL, row * CELL), CELL, kind, heights, sightings, forgotten=forgotten)


def value(memory: MapMemory, col: int, row: int) -> int:
    remembered = memory.map()
    i = round((row * CELL - remembered.origin[1]) / CELL)
    j = round((col * CELL - remembered.origin[0]) / CELL)
    return int(remembered.kind[i, j])


def test_what_shifts_out_is_kept() -> None:
    memory = MapMemory()
    window(memory, 0, 0, [[FLOOR, OBSTACLE], [FLOOR, UNKNOWN]])
    window(memory, 500, -300, [[OBSTACLE, FLOOR], [FLOOR, FLOOR]])
    assert value(memory, 0, 0) == FLOOR
    assert value(memory, 1, 0) == OBSTACLE
    assert value(memory, 500, -300) == OBSTACLE
    assert value(memory, 250, 0) == UNKNOWN


def test_a_cell_that_turns_unknown_within_the_window_is_forgotten() -> None:
    memory = MapMemory()
    window(memory, 0, 0, [[FLOOR, FLOOR]])
    window(memory, 0, 0, [[UNKNOWN, FLOOR]])
    assert value(memory, 0, 0) == UNKNOWN


def test_a_cell_that_comes_back_unseen_keeps_its_value_until_it_is_seen() -> None:
    memory = MapMemory()
    window(memory, 0, 0, [[FLOOR, FLOOR]])
    window(memory, 5, 0, [[FLOOR, FLOOR]])
    window(memory, 0, 0, [[UNKNOWN, UNKNOWN]])
    window(memory, 0, 0, [[UNKNOWN, OBSTACLE]])
    assert value(memory, 0, 0) == FLOOR
    assert value(memory, 1, 0) == OBSTACLE
    window(memory, 0, 0, [[UNKNOWN, UNKNOWN]])
    assert value(memory, 0, 0) == FLOOR
    assert value(memory, 1, 0) == UNKNOWN


def test_what_the_core_forgot_is_forgotten_and_what_had_left_its_window_is_not() -> None:
    memory = MapMemory()
    window(memory, -9, 0, [[FLOOR, OBSTACLE]])
    window(memory, 0, 0, [[FLOOR, OBSTACLE]])
    window(memory, 40, 0, [[FLOOR, FLOOR]], forgotten=1)
    assert [value(memory, col, 0) for col in (0, 1)] == [UNKNOWN, UNKNOWN]
    assert [value(memory, col, 0) for col in (-9, -8, 40, 41)] == [FLOOR, OBSTACLE, FLOOR, FLOOR]
    # It is seen to be forgotten once, whatever was in its place before.
    window(memory, 0, 0, [[UNKNOWN, FLOOR]], forgotten=1)
    assert [value(memory, col, 0) for col in (0, 1, 40)] == [UNKNOWN, FLOOR, FLOOR]
    window(memory, 0, 0, [[UNKNOWN, UNKNOWN]], forgotten=2)
    assert [value(memory, col, 0) for col in (1, 40)] == [UNKNOWN, FLOOR]


def test_centres_are_where_the_cells_are() -> None:
    memory = MapMemory()
    window(memory, 3, -2, [[FLOOR, UNKNOWN]])
    remembered = memory.map()
    row, col = np.argwhere(remembered.kind == FLOOR)[0]
    assert remembered.centres()[row, col] == pytest.approx([3.5 * CELL, -1.5 * CELL])


@given(
    st.lists(
        st.tuples(
            st.integers(-40, 40),
            st.integers(-40, 40),
            st.lists(st.sampled_from([FLOOR, OBSTACLE]), min_size=6, max_size=6),
        ),
        min_size=1,
        max_size=12,
    )
)
def test_memory_is_the_last_value_of_each_cell(
    windows: list[tuple[int, int, list[int]]],
) -> None:
    memory, expected = MapMemory(), {}
    for col, row, values in windows:
        window(memory, col, row, np.array(values).reshape(2, 3))
        expected |= {(col + i % 3, row + i // 3): kind for i, kind in enumerate(values)}
    assert all(value(memory, *cell) == kind for cell, kind in expected.items())
    assert int((memory.map().kind != UNKNOWN).sum()) == len(expected)
