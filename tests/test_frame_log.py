"""Claims about the frames' rows: in the file they are as if each had been logged by itself."""

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from episode_builders import BOX, STEP, trace, world
from rerun.chunk import RrdReader
from test_recording import entities, recorder

from treadwell.recording.file import NAME
from treadwell.recording.frame_log import FrameLog

FRAME = 80_000_000
POINTS = [np.ones((2, 3), np.float32), np.zeros((0, 3), np.float32), np.eye(3, dtype=np.float32)]
COLOURS = [np.full((len(points), 3), 7, np.uint8) for points in POINTS]


def opened(path: Path) -> rr.RecordingStream:
    stream = rr.RecordingStream("test", send_properties=False)
    stream.save(path)
    return stream


def rows(path: Path) -> dict[tuple[str, str, int], object]:
    """Return every value by entity, column and time."""
    found: dict[tuple[str, str, int], object] = {}
    for chunk in RrdReader(path).stream().to_chunks():
        table = chunk.to_record_batch()
        times = table.column("time").cast("int64").to_pylist()
        for name in set(table.schema.names) - {"rerun.controls.RowId", "time", "log_time"}:
            for at, value in zip(times, table.column(name).to_pylist(), strict=True):
                if value is not None:
                    found[str(chunk.entity_path), name, at] = value
        assert all(table.column("log_time").is_valid())
    return found


def test_rows_are_in_the_file_as_if_each_had_been_logged_by_itself(tmp_path: Path) -> None:
    one, other = opened(tmp_path / "one.rrd"), opened(tmp_path / "other.rrd")
    log = FrameLog(one)
    for i, (points, colours) in enumerate(zip(POINTS, COLOURS, strict=True)):
        lines = [np.array([[0.0, 0.0, i], [1.0, 0.0, i]])] * i
        log.begin(i * FRAME)
        log.log("points", rr.Points3D, positions=points, colors=colours, radii=[0.1])
        log.log("lines", rr.LineStrips3D, strips=lines, colors=[(1, 2, 3)])
        other.set_time("time", duration=1e-9 * i * FRAME)
        other.log("points", rr.Points3D(points, colors=colours, radii=[0.1]))
        other.log("lines", rr.LineStrips3D(lines, colors=[(1, 2, 3)]))
        if i != 0:
            log.send()
    for stream in (one, other):
        stream.disconnect()
    found = rows(tmp_path / "one.rrd")
    assert len(found) == 3 * (3 + 2)
    assert found == rows(tmp_path / "other.rrd")


def test_a_row_for_each_frame_is_as_if_each_had_been_logged_by_itself(tmp_path: Path) -> None:
    one, other = opened(tmp_path / "one.rrd"), opened(tmp_path / "other.rrd")
    log, places = FrameLog(one), np.random.default_rng(1).random((3, 4, 3))
    for i, each in enumerate(places):
        log.begin(i * FRAME)
        other.set_time("time", duration=1e-9 * i * FRAME)
        other.log("points", rr.Points3D(each))
    log.log_all("points", rr.Points3D, positions=places)
    log.send()
    for stream in (one, other):
        stream.disconnect()
    assert len(rows(tmp_path / "one.rrd")) == 3
    assert rows(tmp_path / "one.rrd") == rows(tmp_path / "other.rrd")


def test_a_style_is_said_once_and_fields_that_come_later_are_rows_of_their_own(
    tmp_path: Path,
) -> None:
    stream = opened(tmp_path / "one.rrd")
    log = FrameLog(stream)
    for i in range(3):
        log.begin(i * FRAME)
        log.style("points", rr.Points3D, radii=[0.1 + i])
        log.log("points", rr.Points3D, positions=np.ones((1, 3)))
        if i == 1:
            log.log("points", rr.Points3D, labels=["one"])
    log.send()
    stream.disconnect()
    chunks = [
        chunk
        for chunk in RrdReader(tmp_path / "one.rrd").stream().to_chunks()
        if str(chunk.entity_path) == "/points"
    ]
    (style,) = [chunk for chunk in chunks if chunk.is_static]
    column = style.to_record_batch().column("Points3D:radii").to_pylist()
    assert column == [[pytest.approx(0.1)]]
    assert sorted(chunk.num_rows for chunk in chunks if not chunk.is_static) == [1, 3]


@pytest.mark.parametrize("pace_s", [0.001, 0.1])
def test_a_slow_runs_frames_do_not_wait_until_there_is_a_dozen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pace_s: float
) -> None:
    made = world(STEP + BOX.replace("0.5, 0.0", "0.6, 0.6"))
    clock = iter(range(10**18, 2 * 10**18, round(1e9 * pace_s)))
    writer: Any = recorder(tmp_path, made)
    monkeypatch.setattr(time, "time_ns", lambda: next(clock))
    for i in range(6):
        writer.frame(trace(made, i * FRAME))
    writer._stream.flush()
    assert ("/map/floor" in entities(tmp_path / NAME)) == (pace_s > 0.05)
    writer.close()
    assert "/map/floor" in entities(tmp_path / NAME)
