"""A map of the user's own from an OctoMap file: read as OctoMap reads it, told to the robot."""

import json
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import octomap
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadwell
from treadwell._core import Octree
from treadwell.cli.app import execute
from treadwell.core_settings import navigation_settings
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario

SCENARIO = """
schema = 1
name = "known"
time_limit = 0.4
[start]
position = [0.0, 0.0]
[goal]
position = [1.2, 0.0]
[navigation]
localizer = "monte_carlo"
[navigation.static_map]
file = "FILE"
[[course]]
kind = "wall"
from = [2.0, -1.0]
to = [2.0, 1.0]
height = 0.6
thickness = 0.1
"""


def scenario(folder: Path, file: str, more: str = "") -> Path:
    """Write the scenario with a map's name in it, and more of its table."""
    path = folder / "known.toml"
    path.write_text(SCENARIO.replace('"FILE"', f'"{file}"\n{more}'))
    return path


def house(path: Path) -> Octree:
    """Write the map of a floor and a wall, and return it."""
    tree = Octree(0.05)
    x, y = (
        at.ravel() for at in np.meshgrid(np.arange(-0.975, 3, 0.05), np.arange(-1.5, 1.5, 0.05))
    )
    tree.occupy(np.column_stack([x, y + 0.025, np.full_like(x, -0.025)]))
    y, z = (
        at.ravel() for at in np.meshgrid(np.arange(-0.975, 1, 0.05), np.arange(0.025, 0.6, 0.05))
    )
    tree.occupy(np.column_stack([np.full_like(y, 2.025), y, z]))
    tree.write(str(path))
    return tree


def test_a_scenario_runs_in_a_map_from_a_file(tmp_path: Path) -> None:
    tree = house(tmp_path / "house.bt")
    path = scenario(tmp_path, "house.bt")
    episode = treadwell.Episode(str(path))
    told = episode.static_map
    assert told is not None
    assert np.array_equal(told.occupied()[0], tree.occupied()[0])
    assert told.resolution == 0.05
    run = treadwell.run(str(path), out=tmp_path / "run", record=False)
    assert run.result.outcome == "timed_out"


def test_the_core_is_not_told_the_file(tmp_path: Path) -> None:
    house(tmp_path / "house.bt")
    made = load_scenario(scenario(tmp_path, "house.bt", 'surfaces = "inside"'))
    tables = navigation_settings(made.navigation, load_robot("qrio").file.navigation)
    assert tables["static_map"] == {"surfaces": "inside"}


@pytest.mark.parametrize(
    ("file", "more", "said"),
    [
        ("missing.bt", "", 'navigation.static_map.file: found "missing.bt"; there is no such file'),
        ("house.png", "", 'navigation.static_map.file: found "house.png"; must end in .bt or .ot'),
        ("../house.bt", "", "must lie in the scenario file's folder"),
        ("house.bt", "resolution = 0.04", "and a resolution; a map from a file has its own"),
        ("house.bt", "size = 3", "navigation.static_map.size: unknown key"),
        ("house.bt", 'surfaces = "face"', "surfaces"),
        ("broken.bt", "", "navigation.static_map.file: "),
        ("other.bt", "", "an octree begins with"),
        ("empty.bt", "", "solid somewhere"),
        ("far.bt", "", "spans at most 1000000000 voxels"),
    ],
)
def test_a_map_that_cannot_be_used_is_one_clear_message(
    file: str, more: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "inner"
    folder.mkdir()
    house(folder / "house.bt")
    house(tmp_path / "house.bt")
    (folder / "house.png").write_bytes((folder / "house.bt").read_bytes())
    (folder / "broken.bt").write_bytes((folder / "house.bt").read_bytes()[:-7])
    (folder / "other.bt").write_bytes(b"glTF and no octree")
    Octree(0.05).write(str(folder / "empty.bt"))
    far = Octree(0.05)
    far.occupy(np.array([[0.0, 0.0, 0.0], [1000.0, 1000.0, 1000.0]]))
    far.write(str(folder / "far.bt"))
    path = scenario(folder, file, more)
    status = execute(["run", str(path), "--out", str(tmp_path / "run"), "--no-record"])
    error = capsys.readouterr().err
    assert status == 2
    assert said in error
    assert file in error or "static_map" in error
    assert len(error.strip().splitlines()) <= 3
    assert "Traceback" not in error


def test_what_a_run_saw_is_the_map_of_the_next(tmp_path: Path) -> None:
    house(tmp_path / "house.bt")
    path = scenario(tmp_path, "house.bt")
    run = treadwell.run(str(path), out=tmp_path / "run", overrides=["time_limit=4"]).folder
    assert not execute(["export", str(run), "--to", "octomap", "--out", str(tmp_path / "seen")])
    seen = Octree.read(str(tmp_path / "seen" / "map.ot"))
    assert len(seen.occupied()[0]) > 100
    assert len(seen.free()[0]) > 100
    (tmp_path / "again.ot").write_bytes((tmp_path / "seen" / "map.ot").read_bytes())
    episode = treadwell.Episode(str(scenario(tmp_path, "again.ot")))
    assert episode.static_map is not None
    assert np.array_equal(episode.static_map.occupied()[0], seen.occupied()[0])
    step = next(iter(episode))
    assert np.isfinite(step.estimate.pose).all()


def coloured() -> octomap.ColorOcTree:
    """Return OctoMap's own tree with colours: a floor with a hole, free space over it."""
    tree = octomap.ColorOcTree(0.1)
    for x in range(8):
        for y in range(5):
            if (x, y) != (3, 2):
                at = np.array([0.1 * x + 0.05, 0.1 * y + 0.05, 0.05])
                tree.updateNode(at, True)
                tree.search(at).setColor(30 * x, 40 * y, 9)
            tree.updateNode(np.array([0.1 * x + 0.05, 0.1 * y + 0.05, 0.15]), False)
    tree.updateInnerOccupancy()
    return tree


@pytest.mark.parametrize("suffix", [".bt", ".ot"])
def test_a_tree_with_colours_is_read_as_octomap_reads_it(suffix: str, tmp_path: Path) -> None:
    theirs = coloured()
    path = tmp_path / f"coloured{suffix}"
    path.write_bytes(theirs.writeBinary() if suffix == ".bt" else theirs.write())
    ours = Octree.read(str(path))
    assert ours.nodes == theirs.size()
    count = 0
    for leaf in theirs.begin_leafs():
        count += 1
        at = np.array([leaf.getCoordinate()])
        found = float(ours.log_odds(at)[0])
        assert (found >= 0.0) == bool(theirs.isNodeOccupied(leaf))
        if suffix == ".ot":
            occupied = leaf.getOccupancy()
            assert found == pytest.approx(np.log(occupied / (1.0 - occupied)), abs=1e-4)
    assert count == len(ours.occupied()[0]) + len(ours.free()[0])


def small(suffix: str) -> bytes:
    """Return a map's file, made by OctoMap."""
    tree = octomap.OcTree(0.1)
    for k in range(12):
        tree.updateNode(np.array([0.1 * k, 0.05 * k, 0.3]), k % 3 > 0)
    tree.updateInnerOccupancy()
    return bytes(tree.writeBinary() if suffix == ".bt" else tree.write())


FILES = [small(".bt"), small(".ot"), coloured().writeBinary(), coloured().write()]


def refusal(path: Path) -> str | None:
    """Return why a map is not read, None where it is."""
    try:
        Octree.read(str(path))
    except InputError as error:
        return str(error)
    return None


@settings(max_examples=300, deadline=2000)
@given(
    which=st.integers(0, len(FILES) - 1),
    places=st.lists(st.tuples(st.floats(0.0, 0.9999), st.integers(0, 255)), max_size=8),
    end=st.floats(0.0, 1.0),
    tail=st.binary(max_size=20),
)
def test_changed_bytes_are_read_or_refused_by_name(
    tmp_path_factory: pytest.TempPathFactory,
    which: int,
    places: list[tuple[float, int]],
    end: float,
    tail: bytes,
) -> None:
    content = bytearray(FILES[which])
    for place, value in places:
        content[int(place * len(content))] = value
    path = tmp_path_factory.getbasetemp() / "changed.ot"
    path.write_bytes(bytes(content[: int(end * len(content)) + 1]) + tail)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    said = refusal(path)
    assert said is None or ("changed.ot: " in said and "\n" not in said)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # kB


def test_a_sparse_map_of_a_thousand_million_voxels_is_held_in_two_gigabytes(tmp_path: Path) -> None:
    tree = Octree(0.05)
    ends = np.array([[-24.9, -24.9, -24.9], [24.9, 24.9, 24.9]])
    x, y = (at.ravel() for at in np.meshgrid(np.arange(-3, 3, 0.05), np.arange(-3, 3, 0.05)))
    tree.occupy(np.vstack([ends, np.column_stack([x, y, np.full_like(x, -0.02)])]))
    path = tmp_path / "wide.bt"
    tree.write(str(path))
    code = f"""
import json, resource, numpy as np
from treadwell.mapping import Camera, MonteCarlo
camera = Camera(width=80, height=60, fx=70.0, fy=70.0, cx=39.5, cy=29.5)
start = np.eye(4)
start[:3, :3] = [[0, -0.5, 0.866025404], [-1, 0, 0], [0, -0.866025404, -0.5]]
start[2, 3] = 0.5
where = MonteCarlo({str(path)!r}, camera, start=start)
rows = (np.arange(60) - 29.5) / 70.0
depth = np.repeat((0.5 / (0.5 + 0.866025404 * rows))[:, None], 80, axis=1)
depth[(depth < 0.3) | (depth > 4.0)] = np.nan
pose, spread = where.update(depth, np.eye(4))
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(json.dumps([pose.tolist(), list(spread), peak]))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    pose, spread, peak = json.loads(done.stdout)
    assert peak < 2_000_000  # kB
    assert abs(pose[2][3] - 0.5) < 0.05
    assert spread[0] < 0.1
