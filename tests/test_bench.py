"""Claims about `treadwell bench`: its workload, its figures, and how it refuses."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as budget
from hypothesis import strategies as st

from treadwell._core import OccupancyGrid, WorldModel
from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.timing.benches import agreement, occupancy, step, times
from treadwell.timing.frames import read_frames, write_frames
from treadwell.timing.room import room


def test_the_fast_mode_makes_the_same_map_as_the_exact_one() -> None:
    """At 88x72 and at 320x240, on the frames of the bench; occupancy alone and the floors."""
    for camera, count in (("88x72", 20), ("320x240", 8)):
        frames = room(camera, count)
        assert occupancy(frames)["agreement"] == {"occupied": 1.0, "free": 1.0, "freed": 0}
        assert step(frames)["agreement"] == {"cells": 1.0}


def test_the_workload_is_the_same_every_time_and_more_frames_walk_the_same_way() -> None:
    one, again = room("88x72", 3), room("88x72", 3)
    assert np.array_equal(one.depth, again.depth)
    assert (one.depth > 0.0).mean() > 0.9
    assert np.allclose(np.linalg.det(one.rotation), 1.0)


def test_frames_come_back_from_a_file(tmp_path: Path) -> None:
    frames = room("88x72", 2)
    write_frames(frames, tmp_path / "room.bin")
    read = read_frames(tmp_path / "room.bin")
    assert np.array_equal(read.depth, frames.depth)
    assert np.allclose(read.points(1), frames.points(1), atol=1e-5)


@pytest.mark.parametrize(
    ("data", "says"),
    [(b"", "begin with DFR1"), (b"DFR1" + bytes(60), "do not fill")],
)
def test_a_bad_file_is_refused(tmp_path: Path, data: bytes, says: str) -> None:
    path = tmp_path / "bad.bin"
    path.write_bytes(data)
    with pytest.raises(InputError, match=says):
        read_frames(path)
    with pytest.raises(InputError, match="nowhere"):
        read_frames(tmp_path / "nowhere.bin")


def test_json_holds_times_ratio_and_agreement(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["bench", "--frames", "2", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["schema"] == "treadwell.bench/1"
    assert [(row["bench"], row["frames"]) for row in document["benches"]] == [
        ("occupancy", "room 88x72"),
        ("step", "room 88x72"),
        ("occupancy", "room 320x240"),
        ("step", "room 320x240"),
    ]
    for row in document["benches"]:
        assert row["ratio"] > 0.0
        assert row["agreement"]
        for mode in ("exact", "fast"):
            assert 0.0 < row[mode]["p50"] <= row[mode]["p95"] <= row[mode]["worst"]


@pytest.mark.parametrize("arguments", [["nothing"], ["--frames", "0"], ["--frames", "nowhere.bin"]])
def test_a_bad_command_is_refused(arguments: list[str]) -> None:
    assert execute(["bench", *arguments]) == 2


def test_times_are_of_each_frames_best_call() -> None:
    calls = np.array([[0.002, 0.004], [0.003, 0.001]])
    found = times(calls, calls / 2.0)
    assert (found.worst, found.bindings_share) == (2.0, 0.5)


def test_agreement_counts_what_each_mode_says() -> None:
    exact = np.array([0.9, 0.9, 0.1, 0.1, 0.5], np.float32)
    fast = np.array([0.9, 0.1, 0.1, 0.5, 0.5], np.float32)
    found = agreement(exact, fast)
    assert (found.occupied, found.free, found.freed) == (0.5, 0.5, 1)


@budget(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
def test_following_rays_together_changes_no_voxel(seed: int, count: int) -> None:
    """Frames of many rays from eyes that stay or move, near and far, into a grid that fills."""
    rng = np.random.default_rng(seed)
    grids = [
        OccupancyGrid((40, 40, 20), (-0.8, -0.8, 0.0), settings=json.dumps({"clearing": name}))
        for name in ("every_ray", "shared")
    ]
    for _ in range(count):
        eye = tuple(float(part) for part in rng.uniform([-0.7, -0.7, 0.3], [0.7, 0.7, 0.7]))
        low, high = rng.uniform(-1.0, 0.0, 3), rng.uniform(0.0, 1.0, 3)
        # Side by side, as the pixels of a picture's rows.
        ends = np.stack(np.meshgrid(*np.linspace(low, high, 26).T, indexing="ij"), axis=-1)
        points = np.ascontiguousarray(ends.reshape(-1, 3) + rng.normal(0.0, 0.01, (26**3, 3)))
        for _ in range(int(rng.integers(1, 12))):
            for grid in grids:
                grid.insert(points, eye)
    exact, fast = (grid.probability() for grid in grids)
    assert np.array_equal(exact, fast)


def test_an_occupancy_grid_refuses_what_is_no_cloud() -> None:
    grid = OccupancyGrid((4, 4, 4), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        grid.insert(np.zeros((2, 6)), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="row by row"):
        grid.insert(np.zeros((3, 5)).T, (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="finite"):
        grid.insert(np.zeros((2, 3)), (np.nan, 0.0, 0.0))
    with pytest.raises(InputError, match="unknown variant `some`"):
        OccupancyGrid((4, 4, 4), (0.0, 0.0, 0.0), settings='{"clearing": "some"}')
    with pytest.raises(InputError, match="one of fog, averaging"):
        WorldModel("fig")
