"""Claims about maps of the plane that a laser sweeps: `treadwell map` of logs (004, 36.2)."""

import json
from pathlib import Path

import numpy as np
import pytest
from source_builders import data, needs_data

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.experiments.indoor.mapped import draw_topology
from treadwell.map_making.making import MadeMap, make_map
from treadwell.map_making.request import read_request
from treadwell.map_memory import FLOOR, OBSTACLE, UNKNOWN

ROOM = ((-1.0, -1.5), (2.0, 1.5))
"""Lower and upper corner of the room that is scanned, m."""
BEAMS = 180


def ranges(x: float, y: float, yaw: float, first: int = 0) -> list[float]:
    """What a laser measures that looks half around."""
    angle = yaw - 0.5 * np.pi + np.pi / BEAMS * np.arange(first, BEAMS)
    way = np.stack([np.cos(angle), np.sin(angle)])
    low, high = (np.array(corner)[:, None] - [[x], [y]] for corner in ROOM)
    with np.errstate(divide="ignore"):
        return list(np.where(way > 0, high / way, low / way).min(axis=0))


def line(readings: list[float], pose: str, time: float = 1.0) -> str:
    words = " ".join(f"{value:.4f}" for value in readings)
    head = f"ROBOTLASER1 0 {-np.pi / 2:.7f} {np.pi:.7f} {np.pi / BEAMS:.9f} 50.0 0.1 0"
    return f"{head} {len(readings)} {words} 0 {pose} {pose} 0 0 0 0 0 {time} host 1.0\n"


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A log of a room, seen from eight places."""
    path = tmp_path / "room.log"
    scans = []
    for number in range(8):
        x, y, yaw = 0.13 * number - 0.2, 0.07 * number - 0.3, 0.8 * number
        scans.append(line(ranges(x, y, yaw), f"{x} {y} {yaw}", 1.0 + number))
    path.write_text("".join(scans))
    return path


def mapped(log: Path, out: Path, *settings: str, world_model: str | None = None) -> MadeMap:
    request = read_request(log, world_model=world_model, settings=settings)
    return make_map(request, out=out, record=False)


def test_a_log_is_mapped_as_free_occupied_and_unknown_cells(log: Path, tmp_path: Path) -> None:
    made = mapped(log, tmp_path / "map")
    assert made.result.world_model == "occupancy_2d"
    assert made.result.lines is None
    at = made.map.centres()
    (left, bottom), (right, top) = ROOM
    inner = np.minimum.reduce(
        [at[..., 0] - left, right - at[..., 0], at[..., 1] - bottom, top - at[..., 1]]
    )
    assert (made.map.kind[inner > 0.06] == FLOOR).mean() > 0.99
    assert (made.map.kind[np.abs(inner) < 0.025] == OBSTACLE).mean() > 0.9
    assert (made.map.kind[inner < -0.08] == UNKNOWN).all()
    with np.load(tmp_path / "map" / "map.npz") as stored:
        assert stored["probability"].shape == made.map.kind.shape
        assert np.isnan(stored["probability"][made.map.sightings == 0]).any()


def test_a_log_is_mapped_as_the_lines_of_its_walls(log: Path, tmp_path: Path) -> None:
    out = tmp_path / "map"
    assert execute(["map", str(log), "--world-model", "lines", "--out", str(out)]) == 0
    found = json.loads((out / "result.json").read_text())["lines"]
    assert found["count"] == 4
    assert found["held"] >= 0.9
    walls = sorted(
        round(one["distance"] * float(np.sign(np.cos(one["normal"]) + np.sin(one["normal"]))), 1)
        for one in found["each"]
    )
    assert walls == [-1.5, -1.0, 1.5, 2.0]
    with np.load(out / "map.npz") as stored:
        assert stored["lines"].shape == (sum(len(one["stretches"]) for one in found["each"]), 4)
    assert (out / "map.png").stat().st_size > 10_000


def test_scans_that_are_laid_onto_the_lines_have_walls_where_they_are(tmp_path: Path) -> None:
    numbers = np.random.default_rng(0)
    scans = []
    for number in range(20):
        x, y, yaw = 0.05 * number - 0.4, 0.03 * number - 0.3, 0.8 * number
        off = numbers.normal(0.0, [0.015, 0.015, 0.005])
        given = f"{x + off[0]} {y + off[1]} {yaw + off[2]}"
        scans.append(line(ranges(x, y, yaw), given, 1.0 + number))
    log = tmp_path / "off.log"
    log.write_text("".join(scans))
    held = []
    for number, align in enumerate(((), ("plan_view.alignment.rounds=3",))):
        settings = ("plan_view.lines.held=1", "plan_view.lines.most_lines=4", *align)
        out = tmp_path / str(number)
        found = mapped(log, out, *settings, "plan_view.lines.sigma=0.01", world_model="lines")
        assert found.result.lines is not None
        held.append(found.result.lines.held)
    assert held[1] > held[0] + 0.1


def test_lines_far_from_the_origin_are_where_their_points_are(tmp_path: Path) -> None:
    path = tmp_path / "far.log"
    poses = [(512_000.0, 5_403_000.0, 0.8 * number) for number in range(8)]
    scans = [line(ranges(0.0, 0.0, yaw), f"{x} {y} {yaw}") for x, y, yaw in poses]
    path.write_text("".join(scans))
    found = mapped(path, tmp_path / "map", world_model="lines").result.lines
    assert found is not None
    assert found.count == 4
    ends = np.array([stretch for one in found.each for stretch in one.stretches])
    ends = ends.reshape(-1, 2) - [512_000.0, 5_403_000.0]
    assert (np.abs(ends) < 2.1).all()


def test_scans_of_changing_size_and_ranges_that_are_none_are_mapped_as_far_as_they_say_anything(
    tmp_path: Path,
) -> None:
    path = tmp_path / "bad.log"
    bad = [float("inf"), 0.0, -1.0, float("nan"), 81.83]
    scans = [line(ranges(0.0, 0.0, 0.0)[:size] + bad, "0 0 0", 9.0 - size) for size in (1, 90, 3)]
    path.write_text("".join([*scans, line(bad, "0 0 0"), "ROBOTLASER1 0 1 2\n"]))
    for world_model in ("occupancy_2d", "lines", "points"):
        result = mapped(path, tmp_path / world_model, world_model=world_model).result
        assert (result.frames, result.frames_used) == (5, 3)
        assert result.unused == {"line that is no whole scan": 1, "no point": 1}


def test_a_log_with_one_beam_is_a_map_with_one_line_and_no_place(tmp_path: Path) -> None:
    path = tmp_path / "one.log"
    path.write_text(line([1.0] + [0.0] * (BEAMS - 1), "0 0 0"))
    lines = mapped(path, tmp_path / "lines", world_model="lines").result.lines
    places = mapped(path, tmp_path / "places", world_model="topology").result.places
    assert lines is not None
    assert places is not None
    assert (lines.count, places.count, places.rooms) == (1, 0, 0)


def test_scans_before_the_first_pose_and_logs_without_any_scan_are_told(
    log: Path, tmp_path: Path
) -> None:
    late = tmp_path / "late.log"
    late.write_text("ROBOTLASER1 0 -1.57 3.14 0.0175 50 0.1 0 2 1.0 1.0 0\n" + log.read_text())
    result = mapped(late, tmp_path / "late").result
    assert result.unused == {"line that is no whole scan": 1}
    edges = tmp_path / "edges.g2o"
    edges.write_text("EDGE2 0 1 0.1 0 0 0 0 0 0 0 0\n")
    with pytest.raises(InputError, match="has not one scan"):
        mapped(edges, tmp_path / "edges")


@pytest.mark.parametrize(
    ("settings", "world_model", "said"),
    [
        ((), "fog", "one of occupancy_2d, lines, topology, points"),
        (("occupancy_2d.free=0.7",), None, "navigation.occupancy_2d.free must be < prior"),
        (("plan_view.lines.sigma=0",), "lines", "plan_view.lines.sigma must be > 0"),
        (("plan_view.line.sigma=1",), "lines", "only plan_view.lines.KEY"),
        (("plan_view.alignment.steps=0",), "lines", "plan_view.alignment.steps"),
        (("occupancy_2d.most_cells=100",), None, "most_cells"),
    ],
)
def test_bad_requests_are_refused_by_name(
    log: Path, tmp_path: Path, settings: tuple[str, ...], world_model: str | None, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        mapped(log, tmp_path / "map", *settings, world_model=world_model)


@needs_data
@pytest.mark.long
def test_the_intel_log_is_a_hundred_and_twenty_lines_at_most(tmp_path: Path) -> None:
    log = data("laser2d/intel-lab.log.gz")
    found = mapped(log, tmp_path / "map", world_model="lines").result.lines
    assert found is not None
    assert found.held >= 0.9
    assert found.count <= 120  # the chapter's Fig. 36.5 has 94 of other points


def test_a_log_is_mapped_as_places_ways_and_rooms(log: Path, tmp_path: Path) -> None:
    made = mapped(log, tmp_path / "map", world_model="topology")
    places = made.result.places
    assert places is not None
    assert (places.count, places.rooms, places.doorways) == (len(places.each), 1, [])
    for way in places.ways:
        assert max(way.places) < places.count
        assert way.length > 0.0
        assert way.clearance >= 0.2 - 1e-9
    centre = np.mean(ROOM, axis=0)
    widest = max(places.each, key=lambda place: place.clearance)
    assert np.hypot(*(widest.position - centre)) < 0.3
    assert 1.2 < widest.clearance < 1.6
    with np.load(tmp_path / "map" / "map.npz") as arrays:
        assert arrays["room"].shape == arrays["kind"].shape
        assert set(np.unique(arrays["ways"][:, 0])) == set(range(len(places.ways)))
    assert (tmp_path / "map" / "map.png").stat().st_size > 10_000


def test_the_picture_of_an_experiment_is_the_maps(log: Path, tmp_path: Path) -> None:
    told = draw_topology(tmp_path / "places.png", log)
    assert told.endswith("rooms: 1")
    assert (tmp_path / "places.png").stat().st_size > 10_000


def test_settings_of_places_are_checked(log: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"plan_view\.topology\.widens.*>= 1"):
        mapped(log, tmp_path / "map", "plan_view.topology.widens=0.5", world_model="topology")
