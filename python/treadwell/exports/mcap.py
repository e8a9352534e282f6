"""`run.mcap`: a run for Foxglove, in its own open schemas (protobuf).

Frames: `map`, below it `robot` (believed), `robot_true` and `camera`. Topics: `/tf`, `/estimate`
and `/truth` (poses), `/camera/depth` (metres, 32FC1) with `/camera/calibration`, `/camera/points`,
`/map` (the final floor map), `/behaviour` (a line at every change of state). A message's time is
its arrival.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from treadwell.errors import InputError
from treadwell.exports.map_server import seen_part
from treadwell.exports.recorded_points import SeenPoints, seen_points
from treadwell.extras import install_hint
from treadwell.files import whole_file
from treadwell.judging.result import read_result
from treadwell.map_memory import RememberedMap
from treadwell.observation import Observation
from treadwell.recording.cut_off import cut_run, is_cut_off, ways
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.log_file import BrokenLogError
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import read_map
from treadwell.recording.observation_log import NAME as OBSERVATIONS
from treadwell.recording.observation_log import read_observations
from treadwell.recording.recorded_camera import RecordedCamera, recorded_camera
from treadwell.recording.trajectory import quaternion

NAME: Final = "run.mcap"
_SECOND: Final = 1_000_000_000
_POINT_BYTES: Final = 12
_CELL: Final = np.dtype([("height", "<f4"), ("kind", "u1"), ("seen", "<u2")])


class Told(NamedTuple):
    """A message: when, on which topic, and what."""

    time_ns: int
    topic: str
    message: Any


def export_mcap(source: Path, out: Path) -> Sequence[Path]:
    """Write the file.

    Raises:
        InputError: the run lacks a trajectory, what is there is broken, or the extra is missing.
        OSError: a file cannot be written.
    """
    schemas = _schemas()
    path = out / NAME
    told = sorted(_messages(source, schemas), key=lambda each: (each.time_ns, each.topic))
    with whole_file(path) as temporary:
        _write(temporary, told)
    return [path]


def _schemas() -> Any:  # noqa: ANN401 - a module
    """Return Foxglove's message types."""
    try:
        from foxglove import messages
    except ImportError:
        raise InputError(
            f"--to mcap: needs the extra `foxglove`: {install_hint('foxglove')}"
        ) from None
    return messages


def _write(path: Path, told: list[Told]) -> None:
    from mcap.writer import CompressionType, Writer

    with path.open("wb") as file:
        writer = Writer(file, chunk_size=1 << 20, compression=CompressionType.ZSTD)
        writer.start(profile="", library="treadwell")
        channels: dict[str, int] = {}
        for each in told:
            if each.topic not in channels:
                schema = type(each.message).get_schema()
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[each.topic] = writer.register_channel(each.topic, "protobuf", number)
            writer.add_message(
                channels[each.topic], each.time_ns, each.message.encode(), each.time_ns
            )
        writer.finish()  # type: ignore[no-untyped-call]


def _messages(source: Path, schemas: Any) -> Iterator[Told]:  # noqa: ANN401
    told = cut_run(source) or read_result(source / "result.json")
    estimate, truth = ways(source)
    for topic, child, rows in (("/estimate", "robot", estimate), ("/truth", "robot_true", truth)):
        yield from _way(schemas, topic, child, rows)
    for entry in told.behaviour:
        when = _time(schemas, _ns(entry.time))
        line = schemas.Log(
            timestamp=when, level=schemas.LogLevel.Info, name="behaviour", message=entry.state
        )
        yield Told(_ns(entry.time), "/behaviour", line)
    if (source / MAP).is_file():
        surface = read_map(source / MAP).surface
        last = _ns(estimate[-1, 0]) if len(estimate) else 0
        if surface.kind.any():
            yield Told(last, "/map", _grid(schemas, seen_part(surface, source), last))
    if (source / RECORDING).is_file():
        for frame in seen_points(source):
            yield from _seen(schemas, frame)
    if (source / OBSERVATIONS).is_file():
        yield from _depth(schemas, source / OBSERVATIONS)


def _way(schemas: Any, topic: str, child: str, rows: NDArray[np.float64]) -> Iterator[Told]:  # noqa: ANN401
    for row in rows:
        time_ns = _ns(row[0])
        pose = _pose(schemas, row[1:4], row[4:8])
        made = schemas.PoseInFrame(timestamp=_time(schemas, time_ns), frame_id="map", pose=pose)
        yield Told(time_ns, topic, made)
        yield Told(time_ns, "/tf", _transform(schemas, time_ns, child, row[1:8]))


def _observations(path: Path) -> Iterator[Observation]:
    """Yield a run's observations, of one that was cut off those up to there."""
    try:
        yield from read_observations(path)
    except BrokenLogError:
        if not is_cut_off(path.parent):
            raise


def _depth(schemas: Any, path: Path) -> Iterator[Told]:  # noqa: ANN401
    camera = recorded_camera(path)
    for observation in _observations(path):
        if observation.depth is not None:
            time_ns, depth = observation.depth.arrival_ns, observation.depth.depth
            yield Told(time_ns, "/camera/calibration", _calibration(schemas, time_ns, camera))
            yield Told(time_ns, "/camera/depth", _image(schemas, time_ns, depth))


def _calibration(schemas: Any, time_ns: int, camera: RecordedCamera) -> Any:  # noqa: ANN401
    focal, (column, row) = camera.focal, camera.centre
    return schemas.CameraCalibration(
        timestamp=_time(schemas, time_ns),
        frame_id="camera",
        width=camera.width,
        height=camera.height,
        distortion_model="",
        D=[],
        K=[focal, 0.0, column, 0.0, focal, row, 0.0, 0.0, 1.0],
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=[focal, 0.0, column, 0.0, 0.0, focal, row, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def _seen(schemas: Any, frame: SeenPoints) -> Iterator[Told]:  # noqa: ANN401
    pose = frame.map_from_camera
    row = np.array([*pose[:3, 3], *quaternion(pose[:3, :3])])
    yield Told(frame.time_ns, "/tf", _transform(schemas, frame.time_ns, "camera", row))
    points = frame.points[np.isfinite(frame.points).all(axis=1)].astype("<f4")
    kind = schemas.PackedElementFieldNumericType.Float32
    cloud = schemas.PointCloud(
        timestamp=_time(schemas, frame.time_ns),
        frame_id="map",
        pose=_pose(schemas, np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0])),
        point_stride=_POINT_BYTES,
        fields=[
            schemas.PackedElementField(name=name, offset=4 * i, type=kind)
            for i, name in enumerate("xyz")
        ],
        data=points.tobytes(),
    )
    yield Told(frame.time_ns, "/camera/points", cloud)


def _image(schemas: Any, time_ns: int, depth: NDArray[np.float32]) -> Any:  # noqa: ANN401
    height, width = depth.shape
    return schemas.RawImage(
        timestamp=_time(schemas, time_ns),
        frame_id="camera",
        width=width,
        height=height,
        encoding="32FC1",
        step=4 * width,
        data=np.ascontiguousarray(depth, "<f4").tobytes(),
    )


def _grid(schemas: Any, surface: RememberedMap, time_ns: int) -> Any:  # noqa: ANN401
    rows = np.zeros(surface.kind.shape, _CELL)
    rows["height"], rows["kind"] = surface.height, surface.kind
    rows["seen"] = surface.sightings
    kinds = schemas.PackedElementFieldNumericType
    named = (("height", kinds.Float32), ("kind", kinds.Uint8), ("seen", kinds.Uint16))
    offsets = {name: field[1] for name, field in (_CELL.fields or {}).items()}
    x, y = surface.origin
    return schemas.Grid(
        timestamp=_time(schemas, time_ns),
        frame_id="map",
        pose=_pose(schemas, np.array([x, y, 0.0]), np.array([0.0, 0.0, 0.0, 1.0])),
        column_count=surface.kind.shape[1],
        cell_size=schemas.Vector2(x=surface.cell, y=surface.cell),
        row_stride=_CELL.itemsize * surface.kind.shape[1],
        cell_stride=_CELL.itemsize,
        fields=[
            schemas.PackedElementField(name=name, offset=offsets[name], type=kind)
            for name, kind in named
        ],
        data=rows.tobytes(),
    )


def _transform(schemas: Any, time_ns: int, child: str, row: NDArray[np.float64]) -> Any:  # noqa: ANN401
    x, y, z, qx, qy, qz, qw = row.tolist()
    one = schemas.FrameTransform(
        timestamp=_time(schemas, time_ns),
        parent_frame_id="map",
        child_frame_id=child,
        translation=schemas.Vector3(x=x, y=y, z=z),
        rotation=schemas.Quaternion(x=qx, y=qy, z=qz, w=qw),
    )
    return schemas.FrameTransforms(transforms=[one])


def _pose(schemas: Any, place: NDArray[np.float64], turn: NDArray[np.float64]) -> Any:  # noqa: ANN401
    x, y, z = place.tolist()
    qx, qy, qz, qw = turn.tolist()
    return schemas.Pose(
        position=schemas.Vector3(x=x, y=y, z=z),
        orientation=schemas.Quaternion(x=qx, y=qy, z=qz, w=qw),
    )


def _time(schemas: Any, time_ns: int) -> Any:  # noqa: ANN401
    return schemas.Timestamp(sec=time_ns // _SECOND, nsec=time_ns % _SECOND)


def _ns(seconds: float) -> int:
    return round(float(seconds) * _SECOND)
