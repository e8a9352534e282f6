"""Claims about `treadwell map --localizer scan_match`: a laser's scans placed by what they see."""

import json
from pathlib import Path

import numpy as np
import pytest
from source_builders import pcd
from test_map_plan import line, ranges

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.map_making.making import MadeMap, make_map
from treadwell.map_making.request import read_request

SCANS = 60


def truth(number: int) -> tuple[float, float, float]:
    """Where a scan was taken: around in the room, twice."""
    angle = 4 * np.pi * number / SCANS
    return 0.5 + 0.5 * np.cos(angle), 0.4 * np.sin(angle), angle + 1.2


def odometry(seed: int = 0) -> list[tuple[float, float, float]]:
    """The same by odometry that errs by 2 degrees and some centimetres a step."""
    numbers = np.random.default_rng(seed)
    x, y, yaw = truth(0)
    made = [(x, y, yaw)]
    for number in range(1, SCANS):
        (before_x, before_y, before), (after_x, after_y, after) = truth(number - 1), truth(number)
        way = np.exp(-1j * before) * complex(after_x - before_x, after_y - before_y)
        way += complex(*(0.01 * numbers.standard_normal(2)))
        at = complex(x, y) + np.exp(1j * yaw) * way
        yaw += after - before + 0.035 * numbers.standard_normal()
        x, y = at.real, at.imag
        made.append((x, y, yaw))
    return made


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A log of a room whose poses are odometry; among its scans some that are cut off or empty."""
    path = tmp_path / "room.log"
    scans = []
    for number, (x, y, yaw) in enumerate(odometry()):
        seen = ranges(*truth(number))
        if number == 20:
            seen = seen[:90]
        if number == 30:
            seen[40:80] = [0.0, float("inf"), float("nan"), 81.83] * 10
        scans.append(line(seen, f"{x} {y} {yaw}", 100.0 - number))
    path.write_text("".join(scans))
    return path


def mapped(log: Path, out: Path, *settings: str) -> MadeMap:
    request = read_request(log, localizer="scan_match", settings=settings)
    return make_map(request, out=out, record=False)


def errors(way: np.ndarray) -> np.ndarray:
    """How far a way's places are from the true ones, m."""
    return np.hypot(*(way - np.array([truth(number)[:2] for number in range(SCANS)])).T)


def test_scans_are_placed_where_they_were_taken(log: Path, tmp_path: Path) -> None:
    out = tmp_path / "map"
    command = ["map", str(log), "--localizer", "scan_match", "--no-record", "--out", str(out)]
    assert execute(command) == 0
    way = np.loadtxt(out / "trajectory.tum")[:, 1:3]
    before = errors(np.array(odometry())[:, :2])
    assert before.max() > 0.1
    # In the log's order, whatever its times.
    assert errors(way).max() < 0.03
    result = json.loads((out / "result.json").read_text())
    assert result["localizer"] == "scan_match"
    assert result["world_model"] == "occupancy_2d"
    matching = result["matching"]
    assert matching["unmatched"] == 0
    assert matching["local_maps"] >= 3
    assert matching["moved"] == pytest.approx(
        np.hypot(*(way - np.array(odometry())[:, :2]).T).mean()
    )


def test_the_map_is_that_of_the_corrected_poses(log: Path, tmp_path: Path) -> None:
    made = mapped(log, tmp_path / "map")
    plain = make_map(read_request(log), out=tmp_path / "plain", record=False)
    assert plain.result.localizer == "truth"
    assert plain.result.matching is None
    # A wall that is seen from wrong places is thick.
    assert made.result.cells.obstacle < 0.7 * plain.result.cells.obstacle


def test_loops_are_left_open_on_request(log: Path, tmp_path: Path) -> None:
    made = mapped(log, tmp_path / "map", "plan_view.loops.close=false")
    assert made.result.matching is not None
    assert made.result.matching.loops_closed == 0


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("plan_view.scan_matcher.cell=0.0", "cell"),
        ("plan_view.loops.reach=[1.0, 0.1]", "reach"),
        ("plan_view.loops.wrong=1", "wrong"),
        ("map.up=-y", "map.up"),
    ],
)
def test_a_setting_that_cannot_be_used_is_refused_by_key(
    log: Path, tmp_path: Path, setting: str, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        mapped(log, tmp_path / "map", setting)


def test_what_is_no_laser_and_no_localizer_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], log: Path
) -> None:
    cloud = tmp_path / "cloud.pcd"
    cloud.write_bytes(pcd())
    landmarks = tmp_path / "landmarks"
    landmarks.mkdir()
    for name in ("Odometry", "Measurement", "Barcodes"):
        (landmarks / f"{name}.dat").write_text("1 2 3 4\n")
    for source, name, said in (
        (cloud, "scan_match", "scans of a laser"),
        (landmarks, "scan_match", "ranges and bearings"),
        (log, "odometry", "must be truth"),
    ):
        assert execute(["map", str(source), "--localizer", name]) == 2
        told = capsys.readouterr().err
        assert said in told
        assert "--localizer" in told
        assert len(told.strip().splitlines()) == 1, told
