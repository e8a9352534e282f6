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
from treadwell.errors import InputError, TreadwellError
from treadwell.timing import benches
from treadwell.timing.benches import agreement, occupancy, step, times
from treadwell.timing.episode import FROZEN, frozen, stepped
from treadwell.timing.frames import read_frames, write_frames
from treadwell.timing.room import room


@pytest.mark.slow
def test_rays_followed_together_make_the_same_map_as_each_by_itself() -> None:
    """At 88x72 and at 320x240, on the frames of the bench; occupancy alone and the floors."""
    for camera, count in (("88x72", 20), ("320x240", 3)):
        frames = room(camera, count)
        shared = occupancy(frames)["modes"]["shared"]
        assert shared["agreement"] == {"occupied": 1.0, "free": 1.0, "freed": 0}
        modes = step(frames)["modes"]
        assert [found["used"] for found in modes.values()] == 3 * [count]
        assert modes["shared"]["agreement"] == {"cells": 1.0}
        assert modes["projected"]["agreement"]["cells"] > 0.97


@pytest.mark.slow
@pytest.mark.parametrize(
    ("camera", "count", "occupied"),
    [("88x72", 40, 0.94), pytest.param("320x240", 40, 0.98, marks=pytest.mark.long)],
)
def test_the_projected_map_agrees_with_the_exact_one_and_frees_nothing_more(
    camera: str, count: int, occupied: float
) -> None:
    """Of 98 % that are wanted of the occupied ones, a small picture falls short."""
    found = occupancy(room(camera, count))["modes"]["projected"]["agreement"]
    assert found["occupied"] >= occupied
    assert found["free"] >= 0.95
    assert found["freed"] == 0


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


@pytest.mark.slow
def test_json_holds_times_ratio_and_agreement(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["bench", "occupancy", "step", "--frames", "2", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["schema"] == "treadwell.bench/1"
    assert [(row["bench"], row["frames"]) for row in document["benches"]] == [
        ("occupancy", "room 88x72"),
        ("step", "room 88x72"),
        ("occupancy", "room 320x240"),
        ("step", "room 320x240"),
    ]
    for row in document["benches"]:
        assert list(row["modes"]) == ["exact", "shared", "projected"]
        for found in row["modes"].values():
            assert 0.0 < found["p50"] <= found["p95"] <= found["worst"]
            assert 0.0 <= found["bindings_share"] < 1.0
            assert found["ratio"] > 0.0
            assert found["agreement"]


def test_plain_mujoco_steps_the_frozen_physics_to_the_same_state_bit_for_bit() -> None:
    reference = frozen()
    seconds, end = stepped(reference)
    assert seconds > 0.0
    assert np.array_equal(end, reference.end)
    assert len(reference.torques) == 5000
    assert FROZEN.stat().st_size < 1 << 20


def test_a_frozen_model_that_mujoco_does_not_read_is_said(tmp_path: Path) -> None:
    np.savez(tmp_path / "old.npz", model=np.zeros(8, np.uint8))
    with pytest.raises(TreadwellError, match=r"old\.npz: MuJoCo .* does not read"):
        frozen(tmp_path / "old.npz")


@pytest.mark.long
def test_an_episode_is_timed_against_the_frozen_physics(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert execute(["bench", "episode", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["benches"] == []
    found = document["episode"]
    expected = found["ms_a_simulated_second"] / found["frozen_ms"]
    assert found["ratio"] == pytest.approx(expected, rel=0.01)
    assert found["ratio"] > 1.0


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


def test_a_picture_and_its_points_alone_make_the_same_map() -> None:
    """Without projection a picture is but its points; with it, points alone are followed."""
    frames = room("88x72", 3)
    for name in ("every_ray", "shared", "projected"):
        settings = json.dumps({"clearing": name})
        by_points, by_picture, followed = (
            OccupancyGrid((120, 120, 30), (-2.0, -2.4, -0.02), settings=each)
            for each in (settings, settings, "{}")
        )
        for index, (x, y, z) in enumerate(frames.position):
            points = frames.points(index)
            by_points.insert(points, (x, y, z))
            followed.insert(points, (x, y, z))
            picture = frames.picture(index)
            by_picture.insert_picture(picture, frames.camera(index), frames.focal, frames.centre)
        same = np.array_equal(by_points.probability(), by_picture.probability())
        assert same == (name != "projected")
        assert np.array_equal(by_points.probability(), followed.probability())


def test_a_picture_that_is_none_is_refused() -> None:
    grid = OccupancyGrid((4, 4, 4), (0.0, 0.0, 0.0))
    points, camera = np.zeros((2, 2, 3)), np.eye(4)
    for focal, centre in (((0.0, 1.0), (0.0, 0.0)), ((1.0, 1.0), (np.inf, 0.0))):
        with pytest.raises(ValueError, match="focal must be > 0"):
            grid.insert_picture(points, camera, focal, centre)
    with pytest.raises(ValueError, match=r"\(h, w, 3\)"):
        grid.insert_picture(np.zeros((2, 3, 2)), camera, (1.0, 1.0), (0.0, 0.0))
    with pytest.raises(ValueError, match="row by row"):
        grid.insert_picture(np.zeros((3, 2, 2)).T, camera, (1.0, 1.0), (0.0, 0.0))
    with pytest.raises(ValueError, match=r"finite \(4, 4\)"):
        grid.insert_picture(points, np.full((4, 4), np.nan), (1.0, 1.0), (0.0, 0.0))


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


def test_a_map_far_from_the_origin_is_the_same() -> None:
    frames, kinds, heights = room("88x72", 8), [], []
    for x, y, z in ((0.0, 0.0, 0.0), (500_000.0, 5_000_000.0, 100.0)):
        segmenter, model = benches._chains(frames)["exact"]
        for index in range(8):
            seen, pose, camera = benches._standing(frames, index)
            planes = segmenter.segment(seen, camera)
            assert model.insert(planes, (pose[0] + x, pose[1] + y, pose[2] + z, pose[3]))
        kinds.append(model.view().kind)
        heights.append(model.view().height - z)
    assert np.array_equal(*kinds)
    assert np.allclose(*heights, atol=1e-4, equal_nan=True)
