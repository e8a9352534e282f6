"""Claims about recorded trajectories: whole at each time, and as long a file as the way is."""

from pathlib import Path

import numpy as np
import rerun as rr
from episode_builders import trace, world
from rerun.chunk import RrdReader

from treadwell.poses import pose_matrix
from treadwell.recording.frame_log import FrameLog
from treadwell.recording.tracks import Tracks

FRAME = 80_000_000


def drawn(path: Path) -> dict[str, list[tuple[int, list[list[list[float]]]]]]:
    """Return the lines of each entity, by time."""
    found: dict[str, list[tuple[int, list[list[list[float]]]]]] = {}
    for chunk in RrdReader(path).stream().to_chunks():
        if chunk.is_static:
            continue
        table = chunk.to_record_batch()
        times = table.column("time").cast("int64").to_pylist()
        rows = table.column("LineStrips3D:strips").to_pylist()
        found.setdefault(str(chunk.entity_path), []).extend(zip(times, rows, strict=True))
    return found


def test_the_pieces_together_are_the_way_at_each_time(tmp_path: Path) -> None:
    stream = rr.RecordingStream("test", send_properties=False)
    stream.save(tmp_path / "t.rrd")
    rows, made = FrameLog(stream), world()
    tracks, ends = Tracks(rows), []
    for i in range(200):
        rows.begin(i * FRAME)
        pose = pose_matrix(0.04 * i, 0.0, 0.0, 0.0)
        tracks.log(trace(made, i * FRAME, truth_from_robot=pose))
        ends.append(pose[0, 3])
    rows.send()
    stream.disconnect()
    lines = {name: rows for name, rows in drawn(tmp_path / "t.rrd").items() if "truth" in name}
    assert len(lines) == 1 + 3
    for i in (1, 62, 63, 64, 65, 126, 127, 199):
        seen: list[float] = []
        for changes in lines.values():
            before = [strips for time, strips in changes if time <= i * FRAME]
            seen += [place[0] for strip in (before[-1] if before else []) for place in strip]
        assert np.allclose(sorted(set(np.round(seen, 3))), np.round(ends[: i + 1], 3))
    points = sum(len(strip) for rows in lines.values() for _, strips in rows for strip in strips)
    assert points < 200 * 64
