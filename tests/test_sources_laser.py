"""Claims about logs of laser scanners: CARMEN's, and g2o's with scans at their vertices."""

import gzip
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from source_builders import data, needs_data, read

from treadwell.errors import InputError
from treadwell.sources.frame import moved
from treadwell.sources.source import open_source

OLD = "FLASER 3 1.0 2.0 81.91 5 6 0.0 5.1 6 0.0 976053557.5 host 0.5"


def scan(
    ranges: Sequence[float] = (1.0, 2.0, 81.83, 0.0),
    laser: str = "1 2 0.0",
    robot: str = "1 2 0.0",
    end: str = "0 0 0 0 0 976053558.25 host 1.5",
) -> str:
    readings = " ".join(str(value) for value in ranges)
    step = f"{np.pi / 2:.6f}"
    head = f"ROBOTLASER1 0 -1.570796 3.141593 {step} 50.0 0.1 0 {len(ranges)} {readings}"
    return f"{head}  2 7 8 {laser} {robot} {end}"


def log(path: Path, *lines: str) -> Path:
    path.write_text("# a log\n" + "".join(f"{line}\n" for line in lines))
    return path


@needs_data
def test_the_intel_log_is_read_at_its_corrected_poses() -> None:
    source, frames = read(data("laser2d/intel-lab.log.gz"))
    assert source.kind == "laser log"
    assert source.frames == len(frames) == 2672
    assert not source.unused
    assert frames[0].layout == "scan"
    assert frames[0].time == pytest.approx(976053557.767368)
    points = np.concatenate(
        [
            moved(frame.world_from_sensor, frame.points)
            for frame in frames
            if frame.points is not None
        ]
    )
    assert len(points) == 2672 * 180
    points = points[np.isfinite(points[:, 0])]
    assert not points[:, 2].any()
    # The building is 29 m square; walls that were seen often fill few of its cells.
    inside = (np.abs(points[:, :2]) < 25.0).all(axis=1)
    assert inside.mean() > 0.99
    cells = np.unique(np.floor(points[inside, :2] / 0.1), axis=0)
    assert len(cells) < len(points) / 15


def test_an_old_scan_goes_from_right_to_left(tmp_path: Path) -> None:
    _, (frame,) = read(log(tmp_path / "a.log", "PARAM a b", "ODOM 1 2 3", OLD))
    assert frame.points is not None
    assert frame.time == 976053557.5
    np.testing.assert_allclose(frame.points[:2], [[0, -1, 0], [2, 0, 0]], atol=1e-6)
    assert np.isnan(frame.points[2]).all()
    np.testing.assert_array_equal(frame.world_from_sensor[:3, 3], [5, 6, 0])


@pytest.mark.parametrize(("count", "last"), [(180, 179.0), (181, 180.0), (361, 180.0)])
def test_the_step_of_an_old_scan_follows_from_its_count(
    tmp_path: Path, count: int, last: float
) -> None:
    line = f"FLASER {count} {'1.0 ' * count}0 0 0 0 0 0 1.0 host 1.0"
    _, (frame,) = read(log(tmp_path / "a.log", line))
    assert frame.points is not None
    angle = np.degrees(np.arctan2(frame.points[-1, 1], frame.points[-1, 0]))
    assert angle + 90.0 == pytest.approx(last, abs=1e-3)


def test_a_scan_has_its_angles_and_farthest_range_in_it(tmp_path: Path) -> None:
    source, (frame,) = read(log(tmp_path / "a.log", scan(laser="3 4 1.570796")))
    assert frame.points is not None
    assert frame.time == 976053558.25
    np.testing.assert_allclose(frame.points[:2], [[0, -1, 0], [2, 0, 0]], atol=1e-5)
    assert np.isnan(frame.points[2:]).all()
    world = moved(frame.world_from_sensor, frame.points)
    np.testing.assert_allclose(world[:2], [[4, 4, 0], [3, 6, 0]], atol=1e-5)
    assert not source.notes


@pytest.mark.parametrize("word", ["VERTEX2", "VERTEX_SE2"])
def test_a_graphs_vertex_places_the_scan_behind_it(tmp_path: Path, word: str) -> None:
    lines = [f"{word} 0 10 20 0", scan(laser="1.5 2 0"), "EDGE2 0 1 1 0 0 1 0 0 1 0 1"]
    lines += [f"{word} 1 11 20 1.570796", scan(laser="1.5 2 0")]
    source, frames = read(log(tmp_path / "a.g2o", *lines))
    places = [frame.world_from_sensor[:2, 3].tolist() for frame in frames]
    np.testing.assert_allclose(places, [[10.5, 20], [11, 20.5]], atol=1e-5)
    assert source.notes == ["scans are placed at the graph's vertices before them"]


def test_scans_without_a_time_are_numbered_and_that_is_said(tmp_path: Path) -> None:
    source, frames = read(log(tmp_path / "a.log", scan(end=""), scan(end="0 0 0 0 0")))
    assert [frame.time for frame in frames] == [1.0, 2.0]
    assert len(source.notes) == 1


def test_what_is_no_whole_scan_is_counted(tmp_path: Path) -> None:
    whole = scan()
    lines = [
        whole,
        whole[: len(whole) // 3],
        whole.replace(" 4 1.0", " 1e9 1.0"),
        whole.replace(" 4 1.0", " -4 1.0"),
        whole.replace("-1.570796", "nan"),
        scan(laser="nan 0 0"),
        scan(ranges=(0.0, 90.0)),
        scan(ranges=()),
        OLD.replace("3 1.0", "30 1.0"),
        "FLASER x",
        "VERTEX2 0 nan 0 0",
        whole,
        "VERTEX2 1 0",
        whole,
    ]
    source, frames = read(log(tmp_path / "a.log", *lines))
    assert len(frames) == 1
    assert source.frames == 12
    assert source.unused == {"line that is no whole scan": 7, "pose not finite": 3, "no point": 1}


def test_a_log_without_scans_or_cut_short_is_refused_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has not one scan"):
        open_source(log(tmp_path / "a.log", "VERTEX2 0 1 2 3", "EDGE2 0 1 1 0 0"))
    path = tmp_path / "b.log.gz"
    path.write_bytes(gzip.compress("\n".join([scan()] * 999).encode())[:-30])
    with pytest.raises(InputError, match=r"b\.log\.gz: cannot be read"):
        open_source(path)
