"""The ceiling map against what hangs."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from episode_builders import trace, world

from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.measuring.ceiling_watch import CeilingErrors, CeilingWatch
from treadwell.measuring.watch import Watch

WORLD = world("""
[[course]]
kind = "box"
name = "beam"
position = [0.2, 0.0]
size = [0.16, 0.4, 0.2]
base = 0.66
[[course]]
kind = "box"
name = "crate"
position = [0.2, 0.5]
size = [0.16, 0.16, 0.2]
""")
CELLS = 4 * 10

_watch: type[Watch] = CeilingWatch


def watched(*maps: np.ndarray | None, kind: int = FLOOR) -> CeilingErrors:
    given = iter(maps)
    episode: Any = SimpleNamespace(
        course=WORLD.course, pilot=SimpleNamespace(ceilings=lambda: next(given))
    )
    watch = CeilingWatch(episode)
    for _ in maps:
        watch.frame(trace(WORLD, 0, view_kind=np.full((40, 40), kind, dtype=np.uint8)))
    return watch.findings()


def everywhere(height: float) -> np.ndarray:
    return np.full((40, 40), height, dtype=np.float32)


def test_only_what_hangs_is_compared_with_its_underside() -> None:
    found = watched(everywhere(0.68))
    assert found.cells == CELLS
    assert found.errors == pytest.approx([0.02] * CELLS, abs=1e-6)
    assert found.free == CELLS
    assert watched(everywhere(0.68), kind=OBSTACLE).free == 0


def test_a_cell_counts_with_the_ceiling_that_it_last_had() -> None:
    found = watched(everywhere(0.7), everywhere(0.64), everywhere(np.nan))
    assert found.errors == pytest.approx([-0.02] * CELLS, abs=1e-6)
    nothing = watched(everywhere(np.nan))
    assert nothing == CeilingErrors(CELLS, (), 0)


def test_of_a_map_without_ceilings_there_is_nothing_to_say() -> None:
    assert watched(None) == CeilingErrors(0, (), 0)
