"""Claims about MCAP files with Foxglove's own messages, our exports among them."""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest
from mcap.writer import Writer
from run_folders import recorded_run
from source_builders import POINTS, picture, read

from treadwell.errors import InputError
from treadwell.exports.export import export
from treadwell.sources.foxglove_messages import KINDS, decode
from treadwell.sources.frame import UnusableError, moved

schemas = pytest.importorskip("foxglove.messages")
SECOND: Final = 1_000_000_000


def stamp(time_ns: int) -> Any:  # noqa: ANN401
    return schemas.Timestamp(sec=time_ns // SECOND, nsec=time_ns % SECOND)


def pose(x: float, y: float, z: float) -> Any:  # noqa: ANN401
    return schemas.Pose(
        position=schemas.Vector3(x=x, y=y, z=z),
        orientation=schemas.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0),
    )


def transform(time_ns: int, x: float) -> Any:  # noqa: ANN401
    return schemas.FrameTransform(
        timestamp=stamp(time_ns),
        parent_frame_id="map",
        child_frame_id="camera",
        translation=schemas.Vector3(x=x, y=0.0, z=0.0),
        rotation=schemas.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0),
    )


def image(time_ns: int) -> Any:  # noqa: ANN401
    depth = picture().astype("<f4")
    return schemas.RawImage(
        timestamp=stamp(time_ns),
        frame_id="camera",
        width=depth.shape[1],
        height=depth.shape[0],
        encoding="32FC1",
        step=4 * depth.shape[1],
        data=depth.tobytes(),
    )


def calibration(time_ns: int) -> Any:  # noqa: ANN401
    return schemas.CameraCalibration(
        timestamp=stamp(time_ns),
        frame_id="camera",
        width=8,
        height=6,
        distortion_model="",
        D=[],
        K=[9.0, 0.0, 3.25, 0.0, 9.5, 2.75, 0.0, 0.0, 1.0],
        R=[],
        P=[],
    )


def cloud(time_ns: int, own: Any, frame: str = "camera") -> Any:  # noqa: ANN401
    kinds = schemas.PackedElementFieldNumericType
    return schemas.PointCloud(
        timestamp=stamp(time_ns),
        frame_id=frame,
        pose=own,
        point_stride=24,
        fields=[
            schemas.PackedElementField(name=name, offset=8 * i, type=kinds.Float64)
            for i, name in enumerate("xyz")
        ],
        data=POINTS.astype("<f8").tobytes(),
    )


def write(path: Path, told: Iterable[tuple[str, int, Any]]) -> Path:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="", library="made")
        channels: dict[str, int] = {}
        for topic, time_ns, message in told:
            if topic not in channels:
                schema = type(message).get_schema()
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[topic] = writer.register_channel(topic, "protobuf", number)
            writer.add_message(channels[topic], time_ns, message.encode(), time_ns)
        writer.finish()
    return path


def test_images_with_their_calibration_are_read(tmp_path: Path) -> None:
    told = [("/camera/depth/camera_info", 0, calibration(SECOND))]
    told += [("/tf", t, transform(t, 1e-9 * t)) for t in (SECOND, 2 * SECOND)]
    told += [("/camera/depth/image", t, image(t)) for t in (SECOND, 2 * SECOND)]
    source, frames = read(write(tmp_path / "a.mcap", told))
    assert not source.unused
    assert [frame.world_from_sensor[0, 3] for frame in frames] == [1.0, 2.0]
    assert frames[0].camera is not None
    assert (frames[0].camera.fy, frames[0].camera.cx) == (9.5, 3.25)
    assert frames[0].depth is not None
    np.testing.assert_allclose(frames[0].depth[2:], picture()[2:], rtol=1e-6)


def test_a_cloud_may_have_its_own_pose(tmp_path: Path) -> None:
    together = schemas.FrameTransforms(transforms=[transform(SECOND, 1.0)])
    told = [("/tf", SECOND, together), ("/points", SECOND, cloud(SECOND, pose(0.0, 0.0, 2.0)))]
    _, (frame,) = read(write(tmp_path / "a.mcap", told))
    assert frame.points is not None
    assert frame.origin_known
    np.testing.assert_array_equal(frame.world_from_sensor[:3, 3], [1.0, 0.0, 2.0])
    np.testing.assert_allclose(frame.points, POINTS)
    told[1] = ("/points", SECOND, cloud(SECOND, pose(0.0, 0.0, 0.0), "map"))
    _, (frame,) = read(write(tmp_path / "b.mcap", told))
    assert frame.points is not None
    assert not frame.origin_known
    np.testing.assert_allclose(moved(frame.world_from_sensor, frame.points), POINTS)


def test_a_laser_scan_is_read(tmp_path: Path) -> None:
    scan = schemas.LaserScan(
        timestamp=stamp(SECOND),
        frame_id="camera",
        pose=pose(0.0, 0.0, 0.0),
        start_angle=-np.pi / 2,
        end_angle=np.pi / 2,
        ranges=[1.0, float("inf"), 2.0],
        intensities=[],
    )
    told = [("/tf", SECOND, transform(SECOND, 1.0)), ("/scan", SECOND, scan)]
    _, (frame,) = read(write(tmp_path / "a.mcap", told))
    assert frame.points is not None
    np.testing.assert_allclose(frame.points[[0, 2]], [[0, -1, 0], [0, 2, 0]], atol=1e-6)
    assert np.isnan(frame.points[1]).all()


def test_our_own_export_is_read_by_its_images_or_its_points(tmp_path: Path) -> None:
    (path,) = export(recorded_run(), "mcap", tmp_path / "out")
    with pytest.raises(InputError, match=r"/camera/depth \(depth image\), /camera/points"):
        read(path)
    _, own = read(recorded_run())
    source, frames = read(path, topics=["/camera/points"])
    assert len(frames) - len(own) in (0, 1)  # the last one again, at the end
    assert not source.unused
    assert own[0].camera is not None
    source, frames = read(path, topics=["/camera/depth"])
    assert len(frames) == len(own)
    assert frames[0].camera is not None
    for name in ("width", "height", "fx", "fy", "cx", "cy"):
        assert getattr(frames[0].camera, name) == getattr(own[0].camera, name)
    for frame, mine in zip(frames, own, strict=True):
        np.testing.assert_allclose(frame.world_from_sensor, mine.world_from_sensor, atol=1e-6)
        assert frame.depth is not None
        assert mine.depth is not None
        np.testing.assert_array_equal(frame.depth, mine.depth)


@pytest.mark.parametrize("name", KINDS)
def test_bytes_that_are_wrong_make_a_message_unusable(name: str) -> None:
    random = np.random.default_rng(2)
    made = [image(SECOND), calibration(SECOND), cloud(SECOND, pose(1.0, 0.0, 0.0))]
    made.append(transform(SECOND, 1.0))
    for message in made:
        whole = message.encode()
        for _ in range(200):
            broken = bytearray(whole[: random.integers(len(whole) + 1)])
            for place in random.integers(0, max(len(broken), 1), 2):
                if broken:
                    broken[place] = int(random.integers(256))
            with suppress(UnusableError):
                decode(bytes(broken), name)
