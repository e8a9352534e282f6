"""Pictures by rays show what is there, and a film has the run's moments in their order."""

import gc
import math
import os
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from PIL import Image, ImageSequence
from run_folders import plain_run, recorded_run

import treadwell
from treadwell.cli.app import execute
from treadwell.errors import InputError, RecordingError
from treadwell.film import film as films
from treadwell.film.film import FRAMES_A_SECOND, goal_of, scene_of, state_at, write_film
from treadwell.film.follower import follow
from treadwell.film.plan_panel import PlanPanel
from treadwell.film.poses import RecordedPoses
from treadwell.film.ray_camera import Disc, Eye, RayCamera
from treadwell.judging.result import read_result
from treadwell.recording.map_file import read_map

EYE = Eye(np.array([-1.5, 0.0, 0.6]), np.array([0.0, 0.0, 0.1]))
ROOM = """
<mujoco><worldbody>
  <geom type="plane" size="0 0 1"/>
  <geom type="box" size="0.1 0.1 0.1" pos="0 {y} 0.1" rgba="1 0 0 1"/>
  <geom type="box" size="0.3 0.3 0.3" pos="0 0 0.3" rgba="0 0 1 1" group="4"/>
</worldbody></mujoco>
"""


def picture(y: float = 0.0, goal: Disc | None = None) -> np.ndarray:
    model = mujoco.MjModel.from_xml_string(ROOM.format(y=y))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return RayCamera(model, (160, 120), goal).picture(data, EYE)


def red(image: np.ndarray) -> np.ndarray:
    """Return the columns in which something is red."""
    r, g, b = image.astype(int).transpose(2, 0, 1)
    return np.nonzero(((r > 90) & (g < 60) & (b < 60)).any(axis=0))[0]


def test_a_box_is_seen_where_it_is_in_its_colour() -> None:
    middle, left = red(picture()), red(picture(0.3))
    assert middle.size > 10
    assert abs(middle.mean() - 79.5) < 1.0
    assert left.max() < middle.min()  # y is to the left


def test_what_only_collides_is_not_seen() -> None:
    r, _, b = picture().astype(int).transpose(2, 0, 1)
    assert not ((b > 120) & (r < 60)).any()


def test_a_shadow_is_darker_than_the_floor_beside_it() -> None:
    without, having = picture(50.0).mean(axis=2), picture().mean(axis=2)
    assert (without - having > 40).sum() > 20


def test_the_goal_is_marked() -> None:
    plain, marked = picture(), picture(goal=Disc(-0.5, 0.0, 0.2))
    changed = (plain != marked).any(axis=2)
    assert changed.sum() > 50
    assert (marked[changed][:, 1] > marked[changed][:, 2]).all()  # greener than blue


def test_the_same_state_gives_the_same_picture() -> None:
    np.testing.assert_array_equal(picture(), picture())


def test_poses_are_those_of_the_audit_in_any_order() -> None:
    poses = RecordedPoses(plain_run())
    with np.load(plain_run() / "physics.npz") as file:
        qpos = file["qpos"]
    assert poses.count == len(qpos) == 100
    for row in (99, 0, 40):
        np.testing.assert_array_equal(poses.set(row).qpos, qpos[row])
        np.testing.assert_allclose(poses.data.xpos[poses.root()], qpos[row][:3])
    assert poses.robot_bodies()[poses.root()]
    assert not poses.robot_bodies()[0]


def test_what_events_move_is_moved_back_again(tmp_path: Path) -> None:
    add = (
        'event=[{at=0.2, do="add", element={kind="box", name="visitor", position=[0.6, 0.5],'
        "size=[0.1, 0.1, 0.4]}}]"
    )
    settings = ("time_limit=0.5", add)
    treadwell.run("slalom", overrides=settings, out=tmp_path / "run", record=False)
    poses = RecordedPoses(tmp_path / "run")
    heights = [float(poses.set(row).mocap_pos[:, 2].min()) for row in (0, 45, 10, 49)]
    assert heights[0] == heights[2] < -10.0
    assert heights[1] == heights[3] > -1.0


def test_the_robot_is_in_the_middle_of_the_picture_and_not_hidden() -> None:
    poses = RecordedPoses(plain_run())
    follower = follow(poses)
    for row in (0, poses.count - 1):
        eye, data = follower.eye(row), poses.set(row)
        ahead = eye.rotation()[:, 2]
        towards = data.xpos[poses.root()] - eye.position
        assert towards @ ahead / np.linalg.norm(towards) > math.cos(math.radians(12))
        geom = np.array([-1], np.int32)
        towards = data.xpos[poses.root()] - eye.position
        groups = np.array([1, 1, 1, 0, 0, 0], np.uint8)
        mujoco.mj_ray(poses.model, data, eye.position, towards, groups, 1, -1, geom)
        assert poses.robot_bodies()[poses.model.geom_bodyid[geom[0]]]


def test_the_panel_shows_the_way_so_far() -> None:
    surface = read_map(recorded_run() / "map.npz").surface
    truth = np.column_stack([np.arange(5.0), np.linspace(0.1, 0.9, 5), np.zeros(5), np.zeros(5)])
    panel = PlanPanel((96, 80), surface, truth, truth, (1.0, 0.0, 0.1))
    early, late = panel.at(0.5, 0.0), panel.at(4.0, 0.0)
    assert early.shape == (80, 96, 3)
    columns = [
        np.nonzero((each != panel.at(-1.0, 0.0)).any(axis=(0, 2)))[0] for each in (early, late)
    ]
    assert columns[1].max() > columns[0].max() + 10


@pytest.mark.slow
def test_a_gif_has_the_run_s_moments(tmp_path: Path) -> None:
    path = tmp_path / "run.gif"
    told: list[tuple[int, int]] = []
    faster = write_film(plain_run(), path, lambda done, total: told.append((done, total)))
    assert faster == 1.0
    assert told[-1] == (11, 11)
    with Image.open(path) as picture_file:
        frames = [np.asarray(f.convert("RGB"), int) for f in ImageSequence.Iterator(picture_file)]
        assert picture_file.info["duration"] == 1000 // FRAMES_A_SECOND
    assert len(frames) == 11
    assert all((a != b).any() for a, b in pairwise(frames))
    assert frames[0].shape == (320, 720, 3)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_mp4_opens_and_shows_the_same(tmp_path: Path) -> None:
    path = tmp_path / "run.mp4"
    assert execute(["report", str(plain_run()), "--video", str(path), "--out", str(tmp_path)]) == 0
    frames = imageio_ffmpeg.read_frames(str(path))
    about = next(frames)
    assert about["size"] == (720, 320)
    assert about["fps"] == FRAMES_A_SECOND
    count = sum(1 for _ in frames)
    del frames
    gc.collect()  # its reader leaves pipes to the collector: here, and not in another test
    assert count == 11
    assert "data:video/mp4;base64," in (tmp_path / "report.html").read_text()


def test_a_long_run_is_shown_faster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(films, "LONGEST_S", 0.3)
    counts: list[int] = []
    assert write_film(plain_run(), tmp_path / "run.gif", lambda _, n: counts.append(n)) == 4.0
    assert counts[0] == 4


def test_a_film_that_is_not_made_leaves_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "run.gif"
    path.write_bytes(b"before")

    def stop(_done: int, _total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_film(plain_run(), path, stop)
    assert path.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [path]


def test_an_audit_that_unpacks_to_more_than_its_file_is_refused(tmp_path: Path) -> None:
    copy = Path(shutil.copytree(plain_run(), tmp_path / "run"))
    with np.load(copy / "physics.npz") as file:
        arrays = dict(file)
    np.savez_compressed(copy / "physics.npz", **arrays, geom_size=np.zeros(10**7))
    with pytest.raises(InputError, match=r"physics\.npz: is missing or broken: is not as a run"):
        scene_of(copy)
    np.savez(copy / "physics.npz", **arrays | {"state0": arrays["state0"] + 1j})
    with pytest.raises(InputError, match=r"physics\.npz: does not fit"):
        scene_of(copy)


@pytest.mark.parametrize("name", ["run.avi", "run", "run.mp4.txt"])
def test_another_ending_is_bad_input(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=r"\.mp4 or \.gif"):
        write_film(plain_run(), tmp_path / name)


def test_a_place_that_cannot_be_written_is_an_error_of_the_recording(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="cannot be written"):
        write_film(plain_run(), tmp_path / "file" / "run.gif")


def test_a_run_without_its_audit_has_no_film(tmp_path: Path) -> None:
    copy = Path(shutil.copytree(plain_run(), tmp_path / "run"))
    (copy / "physics.npz").unlink()
    with pytest.raises(InputError, match=r"physics\.npz"):
        scene_of(copy)
    assert execute(["report", str(copy), "--video", str(tmp_path / "x.gif")]) == 2
    assert not (tmp_path / "x.gif").exists()
    assert execute(["report", str(copy), str(copy), "--video", str(tmp_path / "x.gif")]) == 2


def test_states_and_goal_are_the_results() -> None:
    result = read_result(recorded_run() / "result.json")
    first = result.behaviour[0]
    assert state_at(result.behaviour, first.time) == first.state
    assert state_at(result.behaviour, -1.0) == ""
    goal = result.configuration["goal"]["position"]
    assert goal_of(result.configuration, recorded_run())[:2] == tuple(goal)
    with pytest.raises(InputError, match="goal"):
        goal_of({"goal": 3}, recorded_run())


def test_without_the_extra_the_message_names_it(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['imageio_ffmpeg'] = None\n"
        "from treadwell.cli.app import execute\n"
        f"sys.exit(execute(['report', {str(plain_run())!r}, '--video', "
        f"{str(tmp_path / 'x.mp4')!r}]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, env=os.environ
    )
    assert done.returncode == 2
    assert "the extra `video`: pip install '" in done.stderr
    assert ".gif needs nothing" in done.stderr
