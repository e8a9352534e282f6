"""Claims about the recorded map: what the viewer shows at a time is the map of that time."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from episode_builders import World, trace, world
from numpy.typing import NDArray
from rerun.chunk import RrdReader

from treadwell.recording.frame_log import FrameLog
from treadwell.recording.map_shapes import MapShapes
from treadwell.trace import Trace

FRAME = 300_000_000


@pytest.fixture(scope="module")
def made() -> World:
    return world()


def written(folder: Path, traces: list[Trace]) -> list[tuple[str, int, dict[str, Any]]]:
    """Return entity, time and components of each row."""
    stream = rr.RecordingStream("test", send_properties=False)
    stream.save(folder / "t.rrd")
    rows = FrameLog(stream)
    shapes = MapShapes(rows, 0.0, 0.1)
    for each in traces:
        rows.begin(each.time_ns)
        shapes.log(each)
    rows.send()
    stream.disconnect()
    found = []
    for chunk in RrdReader(folder / "t.rrd").stream().to_chunks():
        if chunk.is_static or str(chunk.entity_path).startswith("/__"):
            continue
        for row in chunk.to_record_batch().to_pylist():
            found.append((str(chunk.entity_path), row.pop("time").value, row))
    return found


def boxes(rows: list[tuple[str, int, dict[str, Any]]], under: str, until: int) -> list[list[float]]:
    """Return the centres that are shown at a time."""
    last: dict[str, tuple[int, list[list[float]]]] = {}
    for entity, time, row in rows:
        if entity.startswith(under) and time <= until:
            last[entity] = max(last.get(entity, (-1, [])), (time, row["Boxes3D:centers"]))
    return sorted(centre for _, centres in last.values() for centre in centres)


def in_order(places: NDArray[Any]) -> NDArray[Any]:
    """Return rows sorted by x, then y."""
    ordered: NDArray[Any] = places[np.lexsort(places.T[1::-1].round(3))]
    return ordered


def window(random: np.random.Generator) -> dict[str, object]:
    kind = random.choice(3, (70, 80), p=(0.4, 0.4, 0.2)).astype(np.uint8)
    height = random.random(kind.shape).astype(np.float32)
    height[kind == 0] = np.nan
    return {"view_kind": kind, "view_height": height, "view_cell": 0.04}


def test_the_boxes_shown_are_the_floor_and_obstacles_of_the_time(
    tmp_path: Path, made: World
) -> None:
    random = np.random.default_rng(1)
    traces = []
    for i in range(4):
        origin = (-1.6 + 0.12 * i, -1.4 - 0.04 * i)
        traces.append(trace(made, i * FRAME, view_origin=origin, **window(random)))
    rows = written(tmp_path, traces)
    for one in traces:
        row, col = np.nonzero(one.view_kind == 1)
        x = one.view_origin[0] + (col + 0.5) * one.view_cell
        y = one.view_origin[1] + (row + 0.5) * one.view_cell
        expected = np.column_stack([x, y, one.view_height[row, col]])
        shown = boxes(rows, "/world/floor/", one.time_ns)
        order = np.lexsort(expected.T[::-1].round(4))
        assert np.allclose(
            np.array(shown)[np.lexsort(np.array(shown).T[::-1].round(4))],
            expected[order],
            atol=1e-4,
        )
        assert len(boxes(rows, "/world/obstacles/", one.time_ns)) == (one.view_kind == 2).sum()


def test_what_stays_as_it_is_is_not_written_again(tmp_path: Path, made: World) -> None:
    seen = window(np.random.default_rng(1))
    rows = written(tmp_path, [trace(made, i * FRAME, **seen) for i in range(5)])
    again = {entity for entity, time, _ in rows if time > 0}
    assert again == {"/map/floor/robot"}


def test_where_the_robot_climbs_all_columns_are_drawn_from_where_it_stands(
    tmp_path: Path, made: World
) -> None:
    kind = np.zeros((70, 80), np.uint8)
    kind[5, 5] = kind[60, 70] = 2
    seen = {"view_kind": kind, "view_height": np.full(kind.shape, 0.3, np.float32)}
    traces = []
    for i, z in enumerate((0.0, 0.004, 0.1)):
        pose = np.eye(4)
        pose[2, 3] = z
        traces.append(trace(made, i * FRAME, map_from_robot=pose, **seen))
    rows = written(tmp_path, traces)
    columns = [(time, row) for entity, time, row in rows if "obstacles" in entity]
    assert sorted(time // FRAME for time, _ in columns) == [0, 0, 2, 2]
    for time, row in columns:
        (centre,), (half,) = row["Boxes3D:centers"], row["Boxes3D:half_sizes"]
        assert centre[2] + half[2] == pytest.approx(0.3)
        assert centre[2] - half[2] == pytest.approx(0.1 if time else 0.0, abs=1e-6)
