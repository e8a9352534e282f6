"""Claims about bags of ROS: depth images, clouds and scans of every kind of bag, and bad ones."""

import bz2
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Final

import bag_builders as bags
import lz4.frame
import numpy as np
import pytest
from bag_builders import MOUNT, SECOND, Told, depth_bag, way, write_bag
from PIL import Image
from source_builders import CAMERA, COLOURS, HEIGHT, POINTS, WIDTH, camera_text, picture, read

from treadwell.errors import InputError
from treadwell.sources.bag_file import _unpacked_bz2, _unpacked_lz4, open_bag_file
from treadwell.sources.frame import moved
from treadwell.sources.ros_messages import stamp_of
from treadwell.sources.source import open_source
from treadwell.sources.transforms import Transforms


@pytest.mark.parametrize("kind", bags.KINDS)
def test_depth_images_are_read_from_every_kind_of_bag(tmp_path: Path, kind: str) -> None:
    source, frames = read(write_bag(tmp_path, kind, depth_bag()))
    said = {"ros2 mcap": "ros2 bag", "db3": "ros2 bag"}.get(kind, kind)
    assert (source.kind, source.frames, len(frames)) == (said, 3, 3)
    assert not source.unused
    assert source.notes == ["poses are in the frame 'map'"]
    frame = frames[1]
    assert frame.camera is not None
    assert {name: getattr(frame.camera, name) for name in CAMERA} == CAMERA
    assert frame.depth is not None
    expected = np.where(picture() > 0, picture(), np.nan)
    np.testing.assert_allclose(frame.depth, expected, rtol=1e-6)
    assert frame.time == pytest.approx(2.003)
    np.testing.assert_allclose(frame.world_from_sensor[:3, 3], [2.5, 0.0, 1.0])
    np.testing.assert_allclose(frame.world_from_sensor[:3, 0], [0.0, 1.0, 0.0], atol=1e-9)
    again = list(source)
    assert len(again) == 3


@pytest.mark.parametrize("kind", ["mcap", "ros1 bag"])
def test_clouds_and_scans_are_read_with_colours(tmp_path: Path, kind: str) -> None:
    path = write_bag(tmp_path / "a", kind, [*way(), bags.cloud(2 * SECOND)])
    _, (frame,) = read(path)
    assert frame.points is not None
    assert frame.layout == "cloud"
    assert frame.origin_known
    np.testing.assert_allclose(frame.points, POINTS)
    np.testing.assert_array_equal(frame.colour, COLOURS)
    scan = bags.scan(2 * SECOND, (1.0, np.inf, 2.0, 0.05, 30.0))
    _, (frame,) = read(write_bag(tmp_path / "b", kind, [*way(), scan]))
    assert frame.points is not None
    assert frame.layout == "scan"
    np.testing.assert_allclose(frame.points[[0, 2]], [[0, -1, 0], [0, 2, 0]], atol=1e-6)
    assert np.isnan(frame.points[[1, 3, 4]]).all()


@pytest.mark.parametrize("kind", ["<f8", ">f4", "<i2"])
def test_a_clouds_columns_may_be_of_any_type_and_order(tmp_path: Path, kind: str) -> None:
    points = np.round(np.nan_to_num(POINTS)) if kind == "<i2" else POINTS
    path = write_bag(tmp_path, "mcap", [*way(), bags.cloud(2 * SECOND, points, kind)])
    _, (frame,) = read(path)
    assert frame.points is not None
    seen = points.any(axis=1) & np.isfinite(points[:, 0])
    np.testing.assert_allclose(frame.points[seen], points[seen])
    np.testing.assert_array_equal(frame.colour, COLOURS)


@pytest.mark.parametrize(
    ("numbers", "encoding"),
    [
        (np.round(1000 * picture()).astype("<u2"), "16UC1"),
        (np.round(1000 * picture()).astype(">u2"), "mono16"),
        (picture().astype(">f4"), "32FC1"),
        (picture(), "64FC1"),
    ],
)
def test_a_depth_image_may_be_of_any_encoding_and_order(
    tmp_path: Path, numbers: np.ndarray, encoding: str
) -> None:
    image = bags.image(2 * SECOND, numbers, encoding, padding=5)
    _, (frame,) = read(write_bag(tmp_path, "mcap", [bags.info(), *way(), image]))
    assert frame.depth is not None
    np.testing.assert_allclose(frame.depth[2:], picture()[2:], rtol=1e-5)


def test_millimetres_in_floats_are_noticed(tmp_path: Path) -> None:
    image = bags.image(2 * SECOND, (1000 * picture()).astype("<f4"))
    source, (frame,) = read(write_bag(tmp_path, "mcap", [bags.info(), *way(), image]))
    assert frame.depth is not None
    np.testing.assert_allclose(frame.depth[2:], picture()[2:], rtol=1e-5)
    assert any("millimetres" in note for note in source.notes)


def test_odometry_places_what_no_transform_does(tmp_path: Path) -> None:
    row = (3.0, 4.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    told = [bags.odometry("odom", "base", 2 * SECOND, row), bags.cloud(2 * SECOND)]
    told.append(bags.transform("base", "camera", 0, MOUNT, "/tf_static"))
    source, (frame,) = read(write_bag(tmp_path, "ros1 bag", told))
    np.testing.assert_allclose(frame.world_from_sensor[:3, 3], [3.5, 4.0, 1.0])
    assert "poses are in the frame 'odom'" in source.notes


def test_a_cloud_in_the_worlds_frame_has_no_known_origin(tmp_path: Path) -> None:
    away = POINTS + np.array([5_000_000.0, 400_000.0, 10.0])
    told = [*way(), bags.cloud(2 * SECOND, away, "<f8", frame="/map")]
    source, (frame,) = read(write_bag(tmp_path, "mcap", told))
    assert not frame.origin_known
    assert frame.points is not None
    np.testing.assert_allclose(moved(frame.world_from_sensor, frame.points), away)
    assert any("not known" in note for note in source.notes)


def test_what_makes_a_message_unusable_is_counted_by_reason(tmp_path: Path) -> None:
    told = [
        *way(),
        bags.cloud(2 * SECOND),
        bags.cloud(9 * SECOND),
        bags.cloud(2 * SECOND + 1, frame="elsewhere"),
        bags.cloud(2 * SECOND + 2, POINTS[2:3]),
        bags.cloud(2 * SECOND + 3, POINTS[:0]),
        bags.transform("map", "lost", 2 * SECOND, (np.nan, 0, 0, 0, 0, 0, 1)),
        bags.cloud(2 * SECOND + 4, frame="lost"),
        bags.transform("ring", "round", 2 * SECOND, (1, 0, 0, 0, 0, 0, 1)),
        bags.transform("round", "ring", 2 * SECOND, (1, 0, 0, 0, 0, 0, 1)),
        bags.cloud(2 * SECOND + 5, frame="round"),
    ]
    source, frames = read(write_bag(tmp_path, "mcap", told))
    assert len(frames) == 1
    assert source.unused == {
        "no pose within 20 ms": 1,
        "no transform from the sensor's frame": 1,
        "no point": 2,
        "pose not finite": 1,
        "transforms that go in a circle": 1,
    }
    assert any("'elsewhere'" in note for note in source.notes)
    told = [bags.info(), *way(), bags.image(2 * SECOND, np.ones((2, 3), "<f4"))]
    source, frames = read(write_bag(tmp_path / "b", "mcap", told))
    assert source.unused == {"image that is not 8x6": 1}


def test_a_mount_that_is_told_now_and_then_holds_in_between(tmp_path: Path) -> None:
    mounts = [bags.transform("base", "camera", t * SECOND, MOUNT) for t in (1, 2, 3)]
    told = [bags.info(), *way()[1:], *mounts, bags.image(SECOND * 5 // 2)]
    _, frames = read(write_bag(tmp_path, "mcap", told))
    assert len(frames) == 1


def test_a_frame_of_two_parents_keeps_the_first_and_that_is_said(tmp_path: Path) -> None:
    other = bags.transform("other", "base", 2 * SECOND, (9, 9, 9, 0, 0, 0, 1))
    source, (frame,) = read(write_bag(tmp_path, "mcap", [*way(), other, bags.cloud(2 * SECOND)]))
    np.testing.assert_allclose(frame.world_from_sensor[:3, 3], [2.5, 0.0, 1.0])
    assert any("'base' has two parents" in note for note in source.notes)


def test_a_file_may_take_the_place_of_the_cameras_info(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "a", "mcap", [*way(), bags.image(2 * SECOND)])
    with pytest.raises(InputError, match=r"/camera/depth/camera_info.*--camera"):
        open_source(path)
    camera = tmp_path / "camera.toml"
    camera.write_text(camera_text(fx=77.0))
    _, (frame,) = read(path, camera=camera)
    assert frame.camera is not None
    assert frame.camera.fx == 77.0
    path = write_bag(tmp_path / "b", "mcap", [*way(), bags.cloud(2 * SECOND)])
    with pytest.raises(InputError, match="/points has no use for it"):
        open_source(path, camera=camera)


@pytest.mark.parametrize("changed", [{"fx": 0.0}, {"cx": np.nan}, {"width": 0}])
def test_a_cameras_info_that_is_none_is_refused(tmp_path: Path, changed: dict[str, float]) -> None:
    told = [*way(), bags.info(**changed), bags.image(2 * SECOND)]
    with pytest.raises(InputError, match="is of no pinhole camera"):
        open_source(write_bag(tmp_path, "mcap", told))


def test_a_bent_lens_is_said(tmp_path: Path) -> None:
    told = [*way(), bags.info(d=0.1), bags.image(2 * SECOND)]
    source, _ = read(write_bag(tmp_path, "mcap", told))
    assert any("distorted" in note for note in source.notes)


def test_topics_are_chosen_by_name_and_never_guessed(tmp_path: Path) -> None:
    colour = np.zeros((HEIGHT, 3 * WIDTH), np.uint8)
    told = [*depth_bag(), bags.image(2 * SECOND, colour, "rgb8", "/camera/rgb")]
    assert len(read(write_bag(tmp_path / "a", "mcap", told))[1]) == 3
    told += [bags.cloud(2 * SECOND), bags.scan(2 * SECOND, [1.0])]
    path = write_bag(tmp_path / "b", "mcap", told)
    with pytest.raises(InputError) as caught:
        open_source(path)
    listed = "/camera/depth/image_raw (depth image), /points (cloud), /scan (laser scan)"
    assert listed in str(caught.value)
    with pytest.raises(InputError, match="--topic: found /other; "):
        open_source(path, topics=["/other"])
    assert read(path, topics=["/scan"])[0].frames == 1
    source, frames = read(path, topics=["/scan", "/camera/depth/image_raw"])
    assert source.frames == len(frames) == 4


LACKING: Final[dict[str, tuple[list[Told], str]]] = {
    "range data": (way(), "has no range data"),
    "transforms": ([bags.cloud(SECOND)], "has neither tf nor odometry"),
}


@pytest.mark.parametrize("kind", bags.KINDS)
@pytest.mark.parametrize("what", LACKING)
def test_a_bag_without_what_a_map_needs_is_refused(tmp_path: Path, kind: str, what: str) -> None:
    told, message = LACKING[what]
    with pytest.raises(InputError, match=message):
        open_source(write_bag(tmp_path, kind, told))


def outcome(path: Path, topics: Sequence[str] = ()) -> tuple[int, str]:
    """How many frames a bag gives, and what is said of it."""
    try:
        source, frames = read(path, topics=topics)
    except InputError as error:
        return 0, str(error)
    return len(frames), "\n".join(source.notes)


@pytest.mark.parametrize("kind", ["mcap", "ros1 bag", "db3"])
def test_a_bag_that_breaks_off_gives_what_is_whole_or_one_line(tmp_path: Path, kind: str) -> None:
    path = write_bag(tmp_path, kind, depth_bag())
    whole = path.read_bytes()
    for share in (0.0, 0.001, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999):
        path.write_bytes(whole[: int(share * len(whole))])
        given, message = outcome(path)
        assert given <= 3
        assert given == 3 or str(path) in message
        assert len(message.splitlines()) < 3


@pytest.mark.parametrize("kind", ["mcap", "ros1 bag", "db3"])
def test_bytes_that_are_wrong_are_one_line_or_unused(tmp_path: Path, kind: str) -> None:
    path = write_bag(tmp_path, kind, [*depth_bag(), bags.cloud(2 * SECOND)])
    whole, random = path.read_bytes(), np.random.default_rng(4)
    for _ in range(60):
        broken = bytearray(whole)
        for place in random.integers(0, len(whole), 5):
            broken[place] = int(random.integers(256))
        path.write_bytes(broken)
        given, message = outcome(path, ["/points"])
        assert given <= 1
        assert len(message) < 2000


def test_a_chunk_that_unpacks_to_gigabytes_is_refused() -> None:
    packer = bz2.BZ2Compressor()
    packed = b"".join(packer.compress(bytes(1 << 20)) for _ in range(80)) + packer.flush()
    with pytest.raises(ValueError, match="a chunk of more than"):
        _unpacked_bz2(packed)
    with pytest.raises(ValueError, match="a chunk of more than"):
        _unpacked_lz4(lz4.frame.compress(bytes(80 << 20)))
    assert _unpacked_bz2(bz2.compress(b"hello")) == b"hello"


def test_nothing_of_a_bags_folder_is_waited_for(tmp_path: Path) -> None:
    folder = write_bag(tmp_path, "ros2 bag", depth_bag())
    (file,) = folder.glob("*.db3")
    file.unlink()
    file.symlink_to("/dev/zero")
    with pytest.raises(InputError, match="it is no file"):
        open_source(folder)


def compressed(topic: str) -> bags.Told:
    """The picture at 2 s as image_transport packs it."""
    packed = BytesIO()
    numbers = np.round(1000 * picture()).astype(np.uint16)
    Image.fromarray(numbers).save(packed, "PNG")
    kind = "sensor_msgs/msg/CompressedImage"
    _, _, _, plain = bags.image(2 * SECOND)

    def make(store: bags.Typestore) -> object:
        return store.types[kind](
            header=plain(store).header,
            format="16UC1; compressedDepth png",
            data=np.frombuffer(bytes(12) + packed.getvalue(), np.uint8),
        )

    return topic, kind, 2 * SECOND, make


def test_a_compressed_depth_image_is_read(tmp_path: Path) -> None:
    topic = "/camera/depth/image_raw/compressedDepth"
    told = [bags.info(), *way(), compressed(topic)]
    _, (frame,) = read(write_bag(tmp_path, "ros1 bag", told))
    assert frame.depth is not None
    np.testing.assert_allclose(frame.depth[2:], picture()[2:], rtol=1e-5)


@pytest.mark.parametrize(
    ("infos", "told"),
    [
        ((), r"no camera info \(/cam/camera_info or /cam/depth/camera_info\); name a camera"),
        (("/left/camera_info",), r"; elsewhere there is /left/camera_info; name a camera"),
        (("/cam/a", "/cam/b"), r"several camera infos beside it, .* \(/cam/a, /cam/b\)"),
    ],
)
def test_a_compressed_image_without_a_camera_says_where_it_was_looked_for(
    tmp_path: Path, infos: tuple[str, ...], told: str
) -> None:
    topic = "/cam/depth/compressedDepth"
    bag = [*(bags.info(topic=name) for name in infos), *way(), compressed(topic)]
    with pytest.raises(InputError, match=told):
        open_source(write_bag(tmp_path, "ros1 bag", bag))


def test_the_camera_of_a_compressed_image_may_be_below_its_topic(tmp_path: Path) -> None:
    """Some drivers take the image's own name for a folder."""
    topic = "/cam/depth/compressedDepth"
    told = [bags.info(topic="/cam/depth/camera_info"), *way(), compressed(topic)]
    _, (frame,) = read(write_bag(tmp_path, "ros1 bag", told))
    assert frame.camera is not None


def test_a_message_without_a_stamp_has_the_time_of_its_recording(tmp_path: Path) -> None:
    _, _, _, make = bags.scan(0, [1.0])
    assert stamp_of(make(bags.ROS2), 5 * SECOND) == 5.0
    assert open_bag_file(tmp_path / "a.txt") is None


def test_transforms_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("treadwell.sources.transforms.MOST_TRANSFORMS", 3)
    transforms = Transforms()
    row = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    for number in range(3):
        transforms.add("a", "b", number, row, fixed=False)
    with pytest.raises(InputError, match="more than 3 transforms"):
        transforms.add("a", "b", 4.0, row, fixed=False)
