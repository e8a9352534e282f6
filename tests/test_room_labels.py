"""Claims about planes, components and labels in drawn rooms that nothing was learned of."""

from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest
from PIL import Image
from source_builders import ply

from treadwell._core import SceneLabels
from treadwell.errors import InputError
from treadwell.experiments.indoor.labels import LabelScore, recall_precision, score
from treadwell.experiments.indoor.rooms import DrawnRooms
from treadwell.map_making.label_picture import PICTURE, draw_labels
from treadwell.map_making.making import make_map
from treadwell.map_making.request import read_request
from treadwell.map_making.room_labels import NAMES, RGB, RoomLabels, pooled

SEEDS = range(4)
"""Labels were learned of houses from 100 on."""


@cache
def nao() -> LabelScore:
    return score(SEEDS, "nao", 5)


def test_nine_of_ten_surfaces_are_groups_at_four_fifths_overlap_by_structured_light() -> None:
    found = nao().regions
    assert found.true >= 50
    assert found.correct / found.true >= 0.9, found


def test_by_small_stereo_pictures_more_than_half_of_the_surfaces_are_groups() -> None:
    found = score(range(3), "qrio", 6).regions  # 90 % is not reached: docs/results
    assert found.true >= 30
    assert found.correct / found.true >= 0.55, found


def test_labels_of_rooms_that_nobody_tuned_on_are_right() -> None:
    confusion = nao().confusion
    recall, precision = recall_precision(confusion)
    told = dict(zip(NAMES, zip(recall.round(3), precision.round(3), strict=True), strict=True))
    assert np.trace(confusion) / confusion.sum() >= 0.95, told
    for name in ("floor", "step", "wall"):
        assert min(told[name]) >= 0.9, told
    assert told["furniture"][0] >= 0.6, told


def test_neighbours_take_away_half_of_the_errors_that_stand_alone_and_add_none() -> None:
    before, after = nao().isolated
    assert before >= 50
    assert 2 * after <= before, (before, after)
    alone, smoothed = nao().alone, nao().points
    assert np.trace(smoothed) >= np.trace(alone)


def test_labels_say_nothing_where_nothing_is_seen_and_refuse_what_is_bad() -> None:
    rooms = DrawnRooms(1, "qrio")
    look = next(iter(rooms.looks(1)))
    seer = RoomLabels(160)
    assert not seer.insert(np.full_like(look.depth, np.nan), rooms.camera, look.world_from_camera)
    assert len(seer.points()[0]) == 0
    assert seer.insert(look.depth, rooms.camera, look.world_from_camera)
    groups, labels = seer.core.groups, seer.core.labels
    assert groups.shape == labels.shape == look.depth.shape
    assert ((labels == 255) == (groups == 0)).all()
    assert len(seer.core.features) == groups.max()
    assert SceneLabels.names() == list(NAMES)
    with pytest.raises(InputError, match=r"classification\.grouping\.patch must be"):
        RoomLabels(160, {"grouping": {"patch": 1}})
    with pytest.raises(InputError, match="example 0 has label 6, the last is 5"):
        RoomLabels(160, examples=(np.zeros((1, 2)), [6]))


def test_blocks_of_pixels_that_were_not_seen_as_a_whole_were_not_seen() -> None:
    depth = np.array([[1.0, 1.0, 2.0, np.nan], [1.0, 1.2, 2.0, 2.0]], np.float32)
    found = pooled(depth, 2)
    assert found.shape == (1, 2)
    assert found[0, 0] == pytest.approx(1.0)
    assert np.isnan(found[0, 1])


def test_labels_are_drawn_in_their_colours_with_a_legend(tmp_path: Path) -> None:
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.4], [2.0, 1.0, 0.9]], np.float32)
    draw_labels(tmp_path / PICTURE, "three", places, np.array([0, 3, 5], np.uint8))
    with Image.open(tmp_path / PICTURE) as picture:
        colours = {tuple(colour) for colour in np.array(picture.convert("RGB")).reshape(-1, 3)}
    assert {tuple(RGB[label]) for label in (0, 1, 3, 5)} <= colours


def pictures(folder: Path) -> Path:
    """A folder of what a camera sees in rooms."""
    rooms = DrawnRooms(2, "nao")
    (folder / "depth").mkdir(parents=True)
    camera = rooms.camera
    names = ("width", "height", "fx", "fy", "cx", "cy")
    lines = [f"{name} = {getattr(camera, name)}\n" for name in names]
    (folder / "camera.toml").write_text("".join(lines))
    poses = []
    for time, look in enumerate(rooms.looks(4)):
        np.save(folder / "depth" / f"{time}.npy", look.depth)
        turn = np.zeros(4)
        mujoco.mju_mat2Quat(turn, look.world_from_camera[:3, :3].ravel())
        place = look.world_from_camera[:3, 3]
        poses.append(" ".join(f"{value:.9f}" for value in (time, *place, *turn[1:], turn[0])))
    (folder / "poses.tum").write_text("\n".join(poses) + "\n")
    return folder


def test_a_map_of_pictures_has_labels_where_they_are_asked_for(tmp_path: Path) -> None:
    source = pictures(tmp_path / "pictures")
    for asked in (False, True):
        settings = [f"map.labels={str(asked).lower()}"]
        made = make_map(read_request(source, settings=settings), out=tmp_path / str(asked))
        assert (made.folder / PICTURE).exists() == asked
        with np.load(made.folder / "map.npz") as arrays:
            assert ("labels" in arrays) == asked
        recorded = (made.folder / "recording.rrd").read_bytes()
        assert (b"world/map/labels" in recorded) == asked
    with np.load(made.folder / "map.npz") as arrays:
        places, labels = arrays["label_places"], arrays["labels"]
    assert len(places) == len(labels) > 500
    floor = places[labels == NAMES.index("floor")]
    assert len(floor) > 100
    assert np.abs(floor[:, 2]).max() < 0.15
    assert (labels[places[:, 2] > 0.3] == NAMES.index("wall")).mean() > 0.5


def test_labels_of_what_is_no_picture_and_bad_settings_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "cloud.ply"
    path.write_bytes(ply())
    request = read_request(path, settings=["map.labels=true"])
    with pytest.raises(InputError, match=r"map\.labels: labels are of depth images"):
        make_map(request, out=tmp_path / "map")
    settings = ["map.labels=true", "classification.shapes.tail=2"]
    request = read_request(pictures(tmp_path / "pictures"), settings=settings)
    with pytest.raises(InputError, match=r"classification\.shapes\.tail must be"):
        make_map(request, out=tmp_path / "map")
