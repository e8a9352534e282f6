"""A depth camera of the user's own in a map of the user's own: tracked, found, refused by name."""

from pathlib import Path

import made_rooms
import numpy as np
import pytest
from made_rooms import (
    CENTRE,
    FOCAL,
    HEIGHT,
    WIDTH,
    Floats,
    Frame,
    camera_pose,
    depth_picture,
    measured_map,
    odometry,
    sequence,
)
from plain_field import PlainField

from treadwell._core import Octree
from treadwell.errors import InputError
from treadwell.exports.octomap import filled
from treadwell.mapping import MonteCarlo, Spread
from treadwell.mapping.camera import Camera

CAMERA = Camera(width=WIDTH, height=HEIGHT, fx=FOCAL, fy=FOCAL, cx=CENTRE[0], cy=CENTRE[1])
FRAMES = 120


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("room") / "room.bt"
    measured_map(0.04, count=60).write(str(path))
    return path


@pytest.fixture(scope="module")
def seen() -> list[Frame]:
    return sequence(FRAMES, 5)


def followed(where: MonteCarlo, seen: list[Frame]) -> tuple[Floats, Floats]:
    """Return how far each pose is off, and how far ahead along the view, m."""
    steps = odometry([frame.pose for frame in seen], 5)
    off = np.array(
        [
            where.update(frame.depth, step)[0][:3, 3] - frame.pose[:3, 3]
            for frame, step in zip(seen, steps, strict=True)
        ]
    )
    views = np.array([frame.pose[:3, 2] for frame in seen])
    return np.linalg.norm(off, axis=1), (off * views).sum(axis=1)


@pytest.mark.parametrize("range_model", ["ray_cast", "likelihood_field"])
def test_a_carried_camera_is_tracked_without_a_bias(
    range_model: str, room: Path, seen: list[Frame]
) -> None:
    given = {"range_model": range_model}
    where = MonteCarlo(room, CAMERA, start=seen[0].pose, overrides=given)
    off, ahead = followed(where, seen)
    assert off.mean() < 0.025
    assert abs(ahead.mean()) < 0.008


def test_rays_to_faces_come_short(room: Path, seen: list[Frame]) -> None:
    given = {"static_map": {"surfaces": "faces"}}
    where = MonteCarlo(room, CAMERA, start=seen[0].pose, overrides=given)
    assert followed(where, seen)[1].mean() < -0.02


def test_the_field_is_as_good_as_a_plain_one(room: Path, seen: list[Frame]) -> None:
    given = {"range_model": "likelihood_field"}
    where = MonteCarlo(str(room), CAMERA, start=seen[0].pose, overrides=given)
    centres = filled(np.column_stack(Octree.read(str(room)).occupied()), 0.04)
    plain = PlainField(centres, 0.04, seen[0].pose, 5)
    steps = odometry([frame.pose for frame in seen], 5)
    theirs = [
        plain.update(frame.depth, step)[:3, 3] - frame.pose[:3, 3]
        for frame, step in zip(seen, steps, strict=True)
    ]
    # By the mean of many ways both are alike; one way by one seed differs by millimetres.
    ours = followed(where, seen)[0].mean()
    assert ours < np.linalg.norm(theirs, axis=1).mean() + 0.005


def test_a_camera_is_found_that_looks_around(room: Path) -> None:
    where = MonteCarlo(room, CAMERA, seed=1)
    poses = [camera_pose(np.array([2.2, 1.7, 1.2]), 0.1 * turn, 0.45, 0.02) for turn in range(100)]
    draws, blocks = np.random.default_rng(8), made_rooms.room()
    steps = odometry(poses, 8)
    for pose, step in zip(poses, steps, strict=True):
        found, spread = where.update(depth_picture(blocks, pose, draws), step)
    assert np.linalg.norm(found[:3, 3] - pose[:3, 3]) < 0.1
    assert not spread.lost
    assert spread.place < 0.1


def test_the_same_again_is_the_same_to_the_bit(room: Path, seen: list[Frame]) -> None:
    def poses(seed: int, pictures: list[np.ndarray]) -> Floats:
        where = MonteCarlo(room, CAMERA, start=seen[0].pose, seed=seed)
        steps = odometry([frame.pose for frame in seen], 5)
        return np.array([where.update(*both)[0] for both in zip(pictures, steps, strict=False)])

    pictures = [frame.depth for frame in seen[:8]]
    first = poses(3, pictures)
    assert np.array_equal(first, poses(3, pictures))
    assert not np.array_equal(first, poses(4, pictures))
    # Any type and stride; 0 is nothing seen, too.
    wide = [
        np.asfortranarray(np.nan_to_num(picture, nan=0.0).astype(">f8")) for picture in pictures
    ]
    assert np.array_equal(first, poses(3, wide))


def test_while_nothing_tells_where_it_may_be_the_pose_is_no_number(room: Path) -> None:
    where = MonteCarlo(room, CAMERA)
    pose, spread = where.update(np.zeros((HEIGHT, WIDTH)), np.eye(4))
    assert np.isnan(pose).all()
    assert spread == Spread(np.inf, np.inf, lost=True)


def test_what_cannot_be_used_is_named(room: Path, tmp_path: Path) -> None:
    where = MonteCarlo(room, CAMERA, start=np.eye(4))
    blank = np.zeros((HEIGHT, WIDTH), np.float16)
    with pytest.raises(InputError, match=r"depth must be floats .*; got float64 \(2, 2\)"):
        where.update(np.zeros((2, 2)), np.eye(4))
    with pytest.raises(InputError, match=r"depth must be floats .*; got bool"):
        where.update(np.zeros((HEIGHT, WIDTH), bool), np.eye(4))
    for kind in (np.uint16, np.float32):
        with pytest.raises(InputError, match="divide by its units a metre, 1000 for millimetres"):
            where.update(np.full((HEIGHT, WIDTH), 1500, kind), np.eye(4))
    for bad in (
        np.eye(3),
        np.full((4, 4), np.nan),
        2.0 * np.eye(4),
        np.diag([1.0, 1.0, -1.0, 1.0]),
    ):
        with pytest.raises(InputError, match="previous_from_current: "):
            where.update(blank, bad)
    with pytest.raises(InputError, match="start: "):
        MonteCarlo(room, CAMERA, start=np.zeros((4, 4)))
    with pytest.raises(InputError, match="seed: found -1"):
        MonteCarlo(room, CAMERA, seed=-1)
    with pytest.raises(InputError, match="unknown field `beam`"):
        MonteCarlo(room, CAMERA, overrides={"beam": 60})
    with pytest.raises(InputError, match=r"navigation\.monte_carlo\.beams must be"):
        MonteCarlo(room, CAMERA, overrides={"beams": 0})
    with pytest.raises(InputError, match=r"missing\.bt"):
        MonteCarlo(tmp_path / "missing.bt", CAMERA)
    (tmp_path / "broken.bt").write_bytes(room.read_bytes()[:-3])
    with pytest.raises(InputError, match=r"broken\.bt: byte \d+: the file ends within the tree"):
        MonteCarlo(tmp_path / "broken.bt", CAMERA)
