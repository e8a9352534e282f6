"""`map.npz` gives back what was written, and refuses whatever else it finds."""

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from episode_builders import grid

from treadwell.errors import InputError
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.recording.map_file import read_map, write_map

VOXELS = np.array([[0.02, 0.06, 0.1, 0.04], [1.0, 1.0, 1.0, 0.08]], np.float32)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    made = grid()
    made.kind[3, 4], made.kind[5, 6] = FLOOR, OBSTACLE
    made.height[3, 4], made.height[5, 6], made.sightings[3, 4] = 0.03, 0.3, 7
    write_map(tmp_path / "map.npz", made, VOXELS)
    return tmp_path / "map.npz"


def test_what_was_written_comes_back(path: Path) -> None:
    found = read_map(path)
    assert (found.surface.origin, found.surface.cell) == ((-1.0, -1.0), 0.04)
    assert (found.surface.kind[3, 4], found.surface.kind[5, 6]) == (FLOOR, OBSTACLE)
    assert found.surface.height[3, 4] == np.float32(0.03)
    assert found.surface.sightings[3, 4] == 7
    np.testing.assert_array_equal(found.voxels, VOXELS)
    assert [each.name for each in path.parent.iterdir()] == ["map.npz"]


def test_a_map_without_a_cell_is_one(tmp_path: Path) -> None:
    write_map(tmp_path / "map.npz", grid(rows=0, cols=0, cell=0.0), VOXELS[:0])
    assert read_map(tmp_path / "map.npz").surface.kind.size == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"kind": np.zeros((2, 2), np.uint8)},
        {"kind": np.full((50, 75), 3, np.uint8)},
        {"kind": np.zeros((50, 75), np.int64)},
        {"cell": np.array(np.nan)},
        {"cell": np.array(-0.04)},
        {"origin": np.array([np.inf, 0.0])},
        {"origin": np.zeros(3)},
        {"voxels": np.zeros((2, 3), np.float32)},
        {"voxels": np.full((2, 4), np.nan, np.float32)},
        {"voxels": np.zeros((2, 4), np.float32)},
        {"height": np.array([None], object)},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_what_does_not_belong_together_is_refused(path: Path, changes: dict[str, Any]) -> None:
    with np.load(path) as file:
        arrays: dict[str, Any] = dict(file)
    np.savez(path, **arrays | changes)
    with pytest.raises(InputError, match=r"map\.npz"):
        read_map(path)


def test_garbage_is_refused(path: Path) -> None:
    whole = path.read_bytes()
    generator = np.random.default_rng(0)
    for _ in range(200):
        content = bytearray(whole[: int(generator.integers(1, len(whole) + 1))])
        for at in generator.integers(0, len(content), 20):
            content[at] = int(generator.integers(256))
        path.write_bytes(content)
        with suppress(InputError):
            read_map(path)
