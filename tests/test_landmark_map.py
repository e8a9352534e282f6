"""Claims about maps of landmarks: logs of ranges and bearings, and what comes of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from source_builders import data, needs_data

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.map_making.made import MadeMap
from treadwell.map_making.making import make_map
from treadwell.map_making.request import read_request
from treadwell.recording.map_file import read_map
from treadwell.sources.landmark_log import open_landmark_log

PLACES = {6: (2.0, 1.0), 7: (3.0, -1.5), 8: (0.5, 2.5)}
BARCODES = "# Subject Barcode\n1 5\n6 63\n7 25\n8 45\n"


def seen_from(x: float, y: float, yaw: float, subject: int) -> tuple[float, float]:
    east, north = PLACES[subject][0] - x, PLACES[subject][1] - y
    return float(np.hypot(east, north)), float(np.arctan2(north, east) - yaw)


def folder(
    path: Path, odometry: str = "", measurements: str = "", barcodes: str = BARCODES
) -> Path:
    """A robot that goes 4 m straight ahead among three landmarks, and sees another robot."""
    path.mkdir()
    code = {6: 63, 7: 25, 8: 45}
    if not odometry:
        odometry = "# Time v w\n" + "".join(f"{100 + 0.5 * i} 0.2 0.0\n" for i in range(41))
    if not measurements:
        rows = ["# Time barcode range bearing"]
        for i in range(40):
            for subject in PLACES:
                distance, bearing = seen_from(0.1 * i, 0.0, 0.0, subject)
                rows.append(f"{100 + 0.5 * i} {code[subject]} {distance:.4f} {bearing:.4f}")
            rows.append(f"{100 + 0.5 * i} 5 1.0 0.1")
        measurements = "\n".join(rows) + "\n"
    (path / "Odometry.dat").write_text(odometry)
    (path / "Measurement.dat").write_text(measurements)
    (path / "Barcodes.dat").write_text(barcodes)
    return path


def mapped(source: Path, out: Path, *settings: str, record: bool = False) -> MadeMap:
    return make_map(read_request(source, settings=settings), out=out, record=record)


def places(made: MadeMap) -> dict[int | None, tuple[float, float]]:
    assert made.result.landmarks is not None
    return {one.name: (one.x, one.y) for one in made.result.landmarks}


def test_landmarks_are_mapped_where_they_are(tmp_path: Path) -> None:
    made = mapped(folder(tmp_path / "log"), tmp_path / "map", record=True)
    result = made.result
    assert (result.world_model, result.source.kind) == ("landmarks", "landmark log")
    assert (result.frames, result.frames_used) == (160, 120)
    assert result.unused == {"another robot was seen": 40}
    found = places(made)
    assert found.keys() == PLACES.keys()
    for name, place in PLACES.items():
        np.testing.assert_allclose(found[name], place, atol=0.1)
    for name in ("map.npz", "map.png", "recording.rrd", "result.json", "trajectory.tum"):
        assert (made.folder / name).is_file(), name
    assert read_map(made.folder / "map.npz").surface.kind.size == 0
    with np.load(made.folder / "map.npz") as file:
        np.testing.assert_array_equal(file["landmarks"][:, 6], [6, 7, 8])
    way = np.loadtxt(made.folder / "trajectory.tum")
    np.testing.assert_allclose(way[-1, 1:3], [3.9, 0.0], atol=0.15)


def test_names_can_be_withheld(tmp_path: Path) -> None:
    made = mapped(folder(tmp_path / "log"), tmp_path / "map", "landmarks.readings.named=false")
    assert made.result.landmarks is not None
    assert {one.name for one in made.result.landmarks} == {None}
    near = np.array([(one.x, one.y) for one in made.result.landmarks])
    for place in PLACES.values():
        assert np.hypot(*(near - place).T).min() < 0.15


def test_the_command_makes_the_map_and_says_what_is_in_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source, out = folder(tmp_path / "log"), tmp_path / "map"
    assert execute(["map", str(source), "--no-record", "--json", "--out", str(out)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [one["name"] for one in told["landmarks"]] == [6, 7, 8]
    assert told == json.loads((out / "result.json").read_text())


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("Odometry.dat", "1 0.1 0.0\n0.5 0.1 0.0\n", "Odometry.dat: line 2: time goes back"),
        ("Odometry.dat", "1 0.1\n", "Odometry.dat: line 1: must be 3 finite numbers"),
        ("Odometry.dat", "1 nan 0.0\n", "Odometry.dat: line 1: must be 3 finite numbers"),
        ("Odometry.dat", "# nothing\n", "Odometry.dat: has not one row"),
        ("Measurement.dat", "1 63 2.0 0\n0 63 2.0 0\n", "Measurement.dat: line 2: time goes back"),
        ("Measurement.dat", "1 63 inf 0\n", "Measurement.dat: line 1: must be 4 finite numbers"),
        ("Measurement.dat", "1 63 1e300 0\n", "Measurement.dat: line 1: no number may be above"),
        (
            "Measurement.dat",
            "1 63 2.0 0\n1e6 63 2.0 0\n",
            "line 2: more than 100000 s after the one",
        ),
        ("Measurement.dat", "1e6 63 2.0 0\n", "ends more than 100000 s after Odometry.dat"),
        ("Odometry.dat", "1e13 0 0\n", "Odometry.dat: line 1: no time may be above"),
        ("Measurement.dat", "1 63 0 0\n", "no reading can be used .range not above 0: 1"),
        ("Measurement.dat", "1 9 2.0 0\n", "no reading can be used .barcode of no subject: 1"),
        ("Measurement.dat", "1 5 2.0 0\n", "no reading can be used .another robot was seen: 1"),
        ("Measurement.dat", "# none\n", "no reading can be used"),
        ("Barcodes.dat", "6 6.5\n", "Barcodes.dat: found 6 6.5; must be two whole numbers"),
        ("Barcodes.dat", "six 63\n", "Barcodes.dat: line 1: must be 2 finite numbers"),
    ],
)
def test_a_broken_log_is_refused_by_file_and_line(
    tmp_path: Path, file: str, text: str, said: str
) -> None:
    source = folder(tmp_path / "log")
    (source / file).write_text(text)
    with pytest.raises(InputError, match=said):
        mapped(source, tmp_path / "map")
    assert not (tmp_path / "map").exists()


def test_a_robot_that_is_far_away_and_stands_is_drawn(tmp_path: Path) -> None:
    measurements = "90000 63 1 1\n90000 25 1 1\n90000.5 63 1e-9 1\n"
    source = folder(tmp_path / "log", "0 1e6 1e6\n90000 0 0\n", measurements)
    made = mapped(source, tmp_path / "map")
    assert made.result.landmarks is not None
    assert all(np.isfinite([one.x, one.y, *one.covariance]).all() for one in made.result.landmarks)
    assert (made.folder / "map.png").is_file()


@pytest.mark.parametrize(
    ("settings", "world_model", "said"),
    [
        ((), "fog", "--world-model: found fog; of ranges and bearings"),
        (("landmarks.readings.gate=2",), None, "landmarks.readings.gate"),
        (("landmarks.readings.gat=0.5",), None, "gat"),
        (("landmarks.reading.gate=0.5",), None, "only landmarks.readings.KEY and"),
        (("landmarks=3",), None, "only landmarks.readings.KEY and"),
        (("map.robots=-1",), None, "robots"),
    ],
)
def test_bad_requests_are_refused_by_name(
    tmp_path: Path, settings: tuple[str, ...], world_model: str | None, said: str
) -> None:
    source = folder(tmp_path / "log")
    with pytest.raises(InputError, match=said):
        make_map(
            read_request(source, world_model=world_model, settings=settings), out=tmp_path / "map"
        )
    assert not (tmp_path / "map").exists()


def test_landmarks_are_made_of_ranges_and_bearings_alone(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text(
        "FLASER 3 1.0 2.0 81.91 5 6 0.0 5.1 6 0.0 976053557.5 host 0.5\n"
    )
    request = read_request(tmp_path / "a.log", world_model="landmarks")
    with pytest.raises(InputError, match=r"--world-model: found landmarks; .* has no ranges"):
        make_map(request, out=tmp_path / "map")


def test_surveyed_places_tell_how_good_a_map_is(tmp_path: Path) -> None:
    source = folder(tmp_path / "log")
    # Turned by a right angle and shifted; the third is 3 cm off.
    rows = [f"{name} {10 - y} {x + (name == 8) * 0.03} 0 0" for name, (x, y) in PLACES.items()]
    (source / "Landmark_Groundtruth.dat").write_text("\n".join(rows))
    error = mapped(source, tmp_path / "map").result.landmark_error
    assert error is not None
    assert 0.0 < error < 0.05
    nameless = mapped(source, tmp_path / "nameless", "landmarks.readings.named=false")
    assert nameless.result.landmark_error is None
    (source / "Landmark_Groundtruth.dat").write_text("6 1 2\n")
    with pytest.raises(InputError, match=r"Groundtruth\.dat: line 1: must be 5 finite numbers"):
        mapped(source, tmp_path / "broken")


@needs_data
def test_the_landmarks_of_a_recorded_way_are_within_ten_centimetres(tmp_path: Path) -> None:
    source = data("landmarks_mrclam")
    assert open_landmark_log(source).unused == {"another robot was seen": 1053}
    made = mapped(source, tmp_path / "map")
    assert places(made).keys() == set(range(6, 21))
    assert made.result.landmark_error is not None
    assert made.result.landmark_error <= 0.10
    assert any("turns to the left are 0.6" in note for note in made.result.notes)


@given(
    name=st.sampled_from(["Odometry.dat", "Measurement.dat", "Barcodes.dat"]),
    text=st.text(alphabet="0123456789.-+einaf \n#", max_size=80),
)
@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_whatever_stands_in_a_log_it_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, name: str, text: str
) -> None:
    source = folder(tmp_path_factory.mktemp("logs") / "log")
    (source / name).write_text(text)
    try:
        log = open_landmark_log(source)
    except InputError:
        return
    assert sum(len(look.names) for look in log.looks) + sum(log.unused.values()) == log.frames
