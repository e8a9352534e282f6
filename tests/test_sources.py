"""Claims about what a stranger's recording may be, and what is none."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from hostile_files import NO_FILE
from PIL import Image
from run_folders import plain_run, recorded_run
from source_builders import data, needs_data, read

import treadwell
from treadwell.errors import InputError
from treadwell.recording.observation_log import read_observations, read_truth
from treadwell.sources.run import RunSource
from treadwell.sources.source import open_source

NAMES: Final = (
    "a.pcd",
    "a.ply",
    "a.pcd.gz",
    "a.png",
    "a.log.gz",
    "a.mcap",
    "a.bag",
    "a.db3",
    "a.txt",
)


def test_a_runs_images_come_with_the_poses_that_the_robot_believed() -> None:
    source, frames = read(recorded_run())
    assert source.kind == "run"
    seen = [o.depth for o in read_observations(recorded_run() / "observations.mcap") if o.depth]
    assert len(frames) == len(seen) > 20
    assert source.frames - len(frames) in (0, 1)
    assert not source.unused
    for frame, image in zip(frames, seen, strict=True):
        assert frame.depth is not None
        np.testing.assert_array_equal(frame.depth, image.depth)
        assert frame.time == pytest.approx(1e-9 * image.exposure_ns)
        assert 0.3 < frame.world_from_sensor[2, 3] < 0.7
        assert frame.world_from_sensor[2, 2] < 0.1  # it does not look up
    camera = frames[0].camera
    assert camera is not None
    assert (camera.width, camera.height, camera.cx, camera.cy) == (88, 72, 43.5, 35.5)


def test_a_runs_points_lie_on_the_floor_that_it_stands_on() -> None:
    _, frames = read(recorded_run())
    frame = frames[0]
    assert frame.depth is not None
    assert frame.camera is not None
    rows, columns = np.mgrid[: frame.camera.height, : frame.camera.width]
    rays = np.stack(
        [
            (columns - frame.camera.cx) / frame.camera.fx,
            (rows - frame.camera.cy) / frame.camera.fy,
            np.ones(rows.shape),
        ],
        axis=-1,
    )
    points = (rays * frame.depth[..., None]).reshape(-1, 3)
    heights = (points @ frame.world_from_sensor[:3, :3].T + frame.world_from_sensor[:3, 3])[:, 2]
    floor = heights[np.abs(heights) < 0.1]
    assert len(floor) > 500
    assert abs(np.median(floor)) < 0.01


@pytest.mark.slow
def test_a_late_cameras_image_has_the_pose_of_its_exposure(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    settings = ("time_limit=10", "sensors.latency=0.2")
    treadwell.run("turns", seed=2, overrides=settings, out=folder)
    truth = list(read_truth(folder / "observations.mcap"))
    yaw = [np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) for *_, x, y, z, w in truth]
    source = open_source(folder)
    assert isinstance(source, RunSource)
    off = []
    for frame in source:
        arrived = source.poses[round(1e9 * frame.time) + 200_000_000]
        ahead = [pose[:2, 2] for pose in (frame.world_from_sensor, arrived)]
        off.append([np.arctan2(y, x) - yaw[round(100 * frame.time)] for x, y in ahead])
    here, late = np.abs(np.unwrap(off, axis=0)).mean(axis=0)
    assert here < 0.7 * late


def test_a_run_that_was_not_recorded_says_so() -> None:
    with pytest.raises(InputError, match="the run was made without a recording"):
        open_source(plain_run())


def test_a_runs_log_stands_for_its_folder() -> None:
    assert open_source(recorded_run() / "observations.mcap").kind == "run"


@needs_data
@pytest.mark.parametrize("name", ["straight_stairs_1m_1m_60cm", "terrain"])
def test_a_real_picture_of_heights_is_a_cloud_of_its_cells(tmp_path: Path, name: str) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(data(f"elevation_png/{name}.png").read_bytes())
    path.with_suffix(".toml").write_text("cell = 0.02\nheight = 0.6\n")
    source, (frame,) = read(path)
    assert source.kind == "height image"
    assert frame.points is not None
    world = frame.points + frame.world_from_sensor[:3, 3]
    assert 0.0 <= np.nanmin(world[:, 2]) <= np.nanmax(world[:, 2]) <= 0.6001


def test_a_picture_of_heights_has_x_to_the_right_and_y_up(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    Image.fromarray(np.array([[0, 65535, 0], [0, 0, 32768]], np.uint16)).save(path)
    path.with_suffix(".toml").write_text("cell = 0.5\nheight = 2.0\n")
    _, (frame,) = read(path)
    assert frame.points is not None
    assert not frame.origin_known
    world = frame.points + frame.world_from_sensor[:3, 3]
    np.testing.assert_allclose(world[:, 0], [0.25, 0.75, 1.25] * 2)
    np.testing.assert_allclose(world[:, 1], [0.75] * 3 + [0.25] * 3)
    np.testing.assert_allclose(world[:, 2], [0.0, 2.0, 0.0, 0.0, 0.0, 1.0], atol=1e-4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, r"a\.toml: missing; .* cell .* height"),
        ("cell = 0.1\n", "height: missing"),
        ("cell = nan\nheight = 1.0\n", "cell: found nan"),
        ("cell = 0.1\nheight = 1.0\nscale = 2\n", "scale: unknown key; allowed: cell, height"),
    ],
)
def test_a_picture_without_its_scale_is_refused(
    tmp_path: Path, text: str | None, message: str
) -> None:
    path = tmp_path / "a.png"
    Image.fromarray(np.ones((4, 4), np.uint8)).save(path)
    if text is not None:
        path.with_suffix(".toml").write_text(text)
    with pytest.raises(InputError, match=message):
        open_source(path)


def test_a_picture_with_colours_or_of_nothing_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    path.with_suffix(".toml").write_text("cell = 0.1\nheight = 1.0\n")
    Image.fromarray(np.array([[[1, 2, 9]]], np.uint8)).save(path)
    with pytest.raises(InputError, match="has colours"):
        read(path)
    Image.fromarray(np.zeros((2, 2, 4), np.uint8)).save(path)
    with pytest.raises(InputError, match="all of it is transparent"):
        read(path)


@needs_data
def test_logs_of_landmarks_are_known_and_have_no_frames() -> None:
    with pytest.raises(InputError, match="has no frames, but ranges and bearings to landmarks"):
        open_source(data("landmarks_mrclam"))


def test_what_is_none_of_these_is_told_what_is(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("hello")
    for path in (tmp_path, tmp_path / "a.txt"):
        with pytest.raises(InputError, match=r"camera\.toml.*TUM.*clouds.*one cloud.*height"):
            open_source(path)
    with pytest.raises(InputError, match="No such file"):
        open_source(tmp_path / "nowhere")


def test_topics_are_of_bags_alone(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--topic"):
        open_source(tmp_path, topics=["/points"])


def test_what_has_no_use_for_a_camera_refuses_one(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"--camera: found .*; a run has no use for it"):
        open_source(recorded_run(), camera=tmp_path)
    for wrong in (-0.1, float("nan"), float("inf")):
        with pytest.raises(InputError, match="must be 0 s or more"):
            open_source(recorded_run(), pose_within=wrong)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", NO_FILE)
def test_nothing_is_waited_for_or_read_without_end(tmp_path: Path, name: str, kind: str) -> None:
    path = tmp_path / name
    NO_FILE[kind](path)
    with pytest.raises(InputError) as caught:
        read(path)
    assert len(str(caught.value)) < 1500


PIPES: Final[dict[str, Callable[[Path], None]]] = {
    "pipe": os.mkfifo,
    "endless": lambda path: path.symlink_to("/dev/zero"),
}


@pytest.mark.parametrize("kind", PIPES)
@pytest.mark.parametrize("name", ["camera.toml", "poses.tum", "depth", "depth.txt"])
def test_nothing_of_a_folder_is_waited_for(tmp_path: Path, name: str, kind: str) -> None:
    for other in ("camera.toml", "poses.tum", "groundtruth.txt"):
        (tmp_path / other).write_text("1.0 0 0 0 0 0 0 1\n" if other != "camera.toml" else "")
    (tmp_path / name).unlink(missing_ok=True)
    PIPES[kind](tmp_path / name)
    with pytest.raises(InputError):
        read(tmp_path)
