"""Claims about maps of recorded range data: `treadwell map`."""

import json
import subprocess
import sys
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from episode_builders import shown_as
from numpy.typing import NDArray
from source_builders import data, needs_data

from treadwell.cli.app import execute
from treadwell.components import COMPONENTS
from treadwell.errors import InputError
from treadwell.exports.export import export
from treadwell.map_making.making import MadeMap, make_map
from treadwell.map_making.placing import placing
from treadwell.map_making.request import read_request
from treadwell.map_making.sizing import sizing
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.recording.map_file import read_map
from treadwell.sources.frame import RangeFrame

WIDTH, HEIGHT, FX, FY, CX, CY = 96, 72, 80.0, 84.0, 45.0, 37.5
CAMERA = f"width={WIDTH}\nheight={HEIGHT}\nfx={FX}\nfy={FY}\ncx={CX}\ncy={CY}\ndepth_scale=1000\n"
EYE_M, BOX = 0.5, ((0.9, 1.1), (-0.15, 0.15), 0.2)
"""A camera's height over the floor z = 0, on which a box lies: along x, along y, its height."""


def camera_pose(pitch: float = 0.6) -> NDArray[np.float64]:
    """World from a camera that looks along x and down by `pitch`."""
    forward = np.array([np.cos(pitch), 0.0, -np.sin(pitch)])
    right = np.array([0.0, -1.0, 0.0])
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    pose[2, 3] = EYE_M
    return pose


def depth_of_the_box() -> NDArray[np.float32]:
    """What the camera sees, m along its axis; NaN beyond 4 m."""
    pose = camera_pose()
    rows, cols = np.indices((HEIGHT, WIDTH))
    rays = np.stack([(cols - CX) / FX, (rows - CY) / FY, np.ones_like(cols, float)], -1)
    along = rays @ pose[:3, :3].T
    with np.errstate(divide="ignore", invalid="ignore"):
        floor = np.where(along[..., 2] < 0, -EYE_M / along[..., 2], np.inf)
        low, high = np.array([[BOX[0][0], BOX[1][0], -1.0], [BOX[0][1], BOX[1][1], BOX[2]]])
        near, far = (np.stack([low, high])[:, None, None] - pose[:3, 3]) / along
        enter = np.minimum(near, far).max(axis=-1)
        leave = np.maximum(near, far).min(axis=-1)
    box = np.where((enter < leave) & (enter > 0), enter, np.inf)
    depth = np.minimum(floor, box)
    return np.where(depth < 4.0, depth, np.nan).astype(np.float32)


def quaternion(turn: NDArray[np.float64]) -> list[float]:
    w = np.sqrt(max(0.0, 1 + np.trace(turn))) / 2
    x, y, z = (turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1])
    return [x / (4 * w), y / (4 * w), z / (4 * w), w]


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    """A folder of four pictures of the box, taken from one place."""
    folder = tmp_path / "pictures"
    (folder / "depth").mkdir(parents=True)
    (folder / "camera.toml").write_text(CAMERA)
    turn = " ".join(f"{value:.9f}" for value in quaternion(camera_pose()[:3, :3]))
    lines = [f"{time} 0 0 {EYE_M} {turn}\n" for time in range(4)]
    (folder / "poses.tum").write_text("".join(lines))
    for time in range(4):
        np.save(folder / "depth" / f"{time}.npy", depth_of_the_box())
    return folder


def mapped(source: Path, out: Path, *settings: str, world_model: str | None = None) -> MadeMap:
    request = read_request(source, world_model=world_model, settings=settings)
    return make_map(request, out=out, record=False)


def cells(made: MadeMap, x: tuple[float, float], y: tuple[float, float]) -> NDArray[np.bool_]:
    at = made.map.centres()
    inside = (at[..., 0] > x[0]) & (at[..., 0] < x[1]) & (at[..., 1] > y[0]) & (at[..., 1] < y[1])
    assert inside.any()
    return inside


@pytest.mark.parametrize(
    "world_model", ["elevation", "extended_elevation", "multi_level", "points"]
)
def test_models_of_heights_have_floor_and_box_where_they_are(
    pictures: Path, tmp_path: Path, world_model: str
) -> None:
    made = mapped(pictures, tmp_path / "map", world_model=world_model)
    floor = cells(made, (0.5, 0.8), (-0.1, 0.1))
    assert (made.map.kind[floor] == FLOOR).all()
    np.testing.assert_allclose(made.map.height[floor], 0.0, atol=0.005)
    top = cells(made, (0.95, 1.05), (-0.1, 0.1))
    np.testing.assert_allclose(made.map.height[top], BOX[2], atol=0.01)
    rim = cells(made, (0.88, 0.93), (-0.1, 0.1))
    assert (made.map.kind[rim] == OBSTACLE).any()


def test_fog_finds_floors_in_pictures_of_a_camera_with_its_axis_off_the_middle(
    pictures: Path, tmp_path: Path
) -> None:
    made = mapped(pictures, tmp_path / "map")
    assert made.result.world_model == "fog"
    floor = cells(made, (0.5, 0.8), (-0.1, 0.1))
    assert (made.map.kind[floor] == FLOOR).mean() > 0.9
    assert np.nanmax(np.abs(made.map.height[floor])) < 0.01
    box = cells(made, (0.92, 1.08), (-0.12, 0.12))
    assert not (np.abs(made.map.height[box]) < 0.1).any()


def test_the_folder_holds_map_picture_way_and_result(pictures: Path, tmp_path: Path) -> None:
    out = tmp_path / "map"
    assert execute(["map", str(pictures), "--out", str(out), "--world-model", "elevation"]) == 0
    names = {path.name for path in out.iterdir()}
    assert names == {"map.npz", "map.png", "recording.rrd", "result.json", "trajectory.tum"}
    assert shown_as(out / "recording.rrd") == ("treadwell_map", pictures.name)
    result = json.loads((out / "result.json").read_text())
    assert result["schema"] == "treadwell.map/1"
    assert (result["frames"], result["frames_used"], result["unused"]) == (4, 4, {})
    stored = read_map(out / "map.npz").surface
    counts = [int((stored.kind == kind).sum()) for kind in (FLOOR, OBSTACLE)]
    assert counts == [result["cells"]["floor"], result["cells"]["obstacle"]]
    assert result["timing_ms"]["map"]["count"] == 4
    for form in ("map_server", "octomap", "ply"):
        assert export(out, form, tmp_path / form)


def test_coordinates_of_millions_of_metres_keep_their_millimetres(tmp_path: Path) -> None:
    step = np.arange(0.0, 4.0, 0.02)
    x, y = (axis.ravel() for axis in np.meshgrid(step, step))
    z = 250.0 + 0.05 * (x > 2.0)
    cloud = np.column_stack([x + 512_700.0, y + 5_403_700.0, z])
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(cloud)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    path = tmp_path / "far.ply"
    path.write_bytes(head.encode() + cloud.astype("<f8").tobytes())
    made = mapped(path, tmp_path / "map")
    assert made.result.world_model == "elevation"
    for side, height in (((0.5, 1.9), 250.0), ((2.1, 3.5), 250.05)):
        x_range = (512_700.0 + side[0], 512_700.0 + side[1])
        here = cells(made, x_range, (5_403_701.0, 5_403_703.0))
        np.testing.assert_allclose(made.map.height[here], height, atol=0.002)


OF_PICTURES = {"fog", "octree"}


def landscape(folder: Path) -> Path:
    """Write a cloud of which the points lie 0.3 m apart."""
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(-12.0, 12.0, 0.3)]))
    points = np.column_stack([x, y, 0.0 * x])
    path = folder / "landscape.ply"
    axes = "\n".join(f"property float {axis}" for axis in "xyz")
    header = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n{axes}\nend_header"
    np.savetxt(path, points, header=header, comments="")
    return path


@pytest.mark.parametrize("world_model", sorted({*COMPONENTS["world_model"]} - OF_PICTURES))
def test_the_cells_of_every_world_model_are_as_large_as_points_lie_apart(
    tmp_path: Path, world_model: str
) -> None:
    made = mapped(landscape(tmp_path), tmp_path / "map", world_model=world_model)
    assert made.map.cell >= 0.3


@pytest.mark.parametrize(
    ("own", "voxel"), [({}, 0.25), ({"fusion": {"voxel": 0.2, "smoothing": 1}}, 0.2)]
)
def test_the_voxels_of_a_mesh_grow_with_the_cells_and_the_users_own_stay(
    own: dict[str, Any], voxel: float
) -> None:
    """Voxels of 2 cm between points 30 cm apart took a hundred times as long, for no detail."""
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(-12.0, 12.0, 0.3)]))
    points = np.column_stack([x, y, 0.0 * x]).astype(np.float32)
    frame = RangeFrame(0.0, np.eye(4), None, None, points, "cloud", origin_known=False)
    given = {"mesh": deepcopy(own)}
    found = sizing("mesh", given, (frame, placing("z", frame.world_from_sensor, 0.04)), "auto")
    assert found.cell == pytest.approx(0.5)
    assert found.parameters["mesh"]["fusion"]["voxel"] == pytest.approx(voxel)
    assert ("navigation.mesh.fusion.voxel" in found.assumed) is not bool(own)
    assert given == {"mesh": own}


def test_a_table_of_a_mesh_that_is_no_table_is_told_by_its_name(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"navigation\.mesh\.fusion: expected a table"):
        mapped(landscape(tmp_path), tmp_path / "map", "mesh.fusion=3", world_model="mesh")


PEAK_OF = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


@pytest.mark.long
def test_a_cloud_of_ten_million_points_takes_two_gigabytes_at_most(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.linspace(-50, 50, 4000), np.linspace(-50, 50, 2500))
    points = np.stack([x, y, 0.3 * np.sin(x / 5)], axis=-1).astype("<f4").reshape(-1, 3)
    fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1"
    size = f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}"
    header = f"VERSION .7\n{fields}\n{size}\nDATA binary\n"
    (tmp_path / "many.pcd").write_bytes(header.encode() + points.tobytes())
    arguments = ["map", str(tmp_path / "many.pcd"), "--world-model", "elevation", "--no-record"]
    command = [sys.executable, "-m", "treadwell.cli.app", *arguments, "--set", "elevation.cell=0.2"]
    # Started by a small process: the peak of a process begins with that of the one that forked it.
    told = [sys.executable, "-c", PEAK_OF, *command, "--out", str(tmp_path / "out")]
    done = subprocess.run(told, capture_output=True, text=True, check=True)
    assert int(done.stdout.splitlines()[-1]) < 2_000_000  # kB
    cells = json.loads((tmp_path / "out" / "result.json").read_text())["cells"]
    assert cells["floor"] > 0.99 * (100 / 0.2) ** 2


@pytest.mark.parametrize(("cell", "voxel"), [(0.08, None), (0.05, 0.05)])
def test_voxels_stay_as_they_are_where_cells_are_whole_numbers_of_them(
    pictures: Path, tmp_path: Path, cell: float, voxel: float | None
) -> None:
    made = mapped(pictures, tmp_path / "map", f"fog.cell={cell}", world_model="octree")
    assert made.result.assumed.get("navigation.octree.resolution") == voxel


def test_the_axis_that_points_up_is_told_and_turned(
    pictures: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same pictures in a world of which y points down, as a camera's does."""
    turn = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
    pose = camera_pose()
    at = turn @ pose[:3, 3]
    numbers = [*at, *quaternion(turn @ pose[:3, :3])]
    line = " ".join(f"{value:.9f}" for value in numbers)
    (pictures / "poses.tum").write_text("".join(f"{time} {line}\n" for time in range(4)))
    wrong = mapped(pictures, tmp_path / "wrong", world_model="elevation")
    assert any("--set map.up=-y" in note for note in wrong.result.notes)
    out = tmp_path / "by_command"
    assert execute(["map", str(pictures), "--out", str(out), "--no-record"]) == 0
    told = capsys.readouterr().err
    assert "warning:   the pictures were taken with the world's -y up" in told
    right = mapped(pictures, tmp_path / "right", "map.up=-y", world_model="elevation")
    assert not right.result.notes
    floor = right.map.height[right.map.kind == FLOOR]
    assert abs(float(np.median(floor))) < 0.01


@pytest.mark.parametrize("world_model", ["fog", "elevation"])
def test_a_floor_that_leans_is_told_with_the_direction_that_makes_it_level(
    pictures: Path, tmp_path: Path, world_model: str
) -> None:
    """The same pictures in a world that is turned by 12.8 degrees about x."""
    angle = np.radians(12.8)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    pose = camera_pose()
    numbers = [*(turn @ pose[:3, 3]), *quaternion(turn @ pose[:3, :3])]
    line = " ".join(f"{value:.9f}" for value in numbers)
    (pictures / "poses.tum").write_text("".join(f"{time} {line}\n" for time in range(4)))
    wrong = mapped(pictures, tmp_path / "wrong", world_model=world_model)
    (note,) = [note for note in wrong.result.notes if "leans" in note]
    assert "leans by 12.8 degrees" in note
    setting = note.partition("--set '")[2].rstrip("'")
    right = mapped(pictures, tmp_path / "right", setting, world_model=world_model)
    assert not right.result.notes
    heights = right.map.height[right.map.kind == FLOOR]
    assert len(heights) > 100
    assert float(np.percentile(heights, 95) - np.percentile(heights, 5)) < 0.02


@pytest.mark.parametrize("up", ["x", "-x", "y", "-y", "z", "-z"])
def test_a_turn_brings_its_axis_up_and_turns_nothing_inside_out(up: str) -> None:
    turn = placing(up, np.eye(4), 1.0).turn  # type: ignore[arg-type]
    axis = np.zeros(3)
    axis["xyz".index(up[-1])] = -1.0 if up[0] == "-" else 1.0
    np.testing.assert_allclose(turn @ axis, [0.0, 0.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_a_signal_ends_a_map_with_the_frames_that_it_has(pictures: Path, tmp_path: Path) -> None:
    class Impatient:
        def update(self, frame: int, frames: int, used: int) -> None:
            assert used <= frame <= frames
            if frame == 2:
                raise KeyboardInterrupt

    request = read_request(pictures, world_model="elevation")
    made = make_map(request, out=tmp_path / "map", record=False, progress=Impatient())
    assert made.result.interrupted
    assert made.result.frames_used == 2
    assert (tmp_path / "map" / "map.png").is_file()


@pytest.mark.parametrize(
    ("settings", "world_model", "said"),
    [
        (("elevatoin.cell=0.1",), None, "elevation"),
        (("elevation.cell=-1",), "elevation", "navigation.elevation.cell"),
        (("map.up=w",), None, "^--set map.up: found"),
        (("map.up=[0,0,0]",), None, "map.up: .*must not be"),
        (("map.upp=z",), None, r"^--set map.upp: .*allowed: pose_within, up, .*mean 'up'"),
        (("segmentr=x",), None, "mean 'segmenter'"),
        (("navigation.planer=x",), None, "^--set navigation.planer: .*mean 'planner'"),
        ((), "elevatoin", "elevation"),
        ((), "mine:Model", "built in"),
        ((), "lines", "made of scans of a laser"),
        (("plan_view.lines=1",), "elevation", "must be followed by a key"),
    ],
)
def test_bad_requests_are_refused_by_name_and_leave_nothing(
    pictures: Path, tmp_path: Path, settings: tuple[str, ...], world_model: str | None, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        mapped(pictures, tmp_path / "map", *settings, world_model=world_model)
    assert not (tmp_path / "map").exists()


def test_without_one_frame_that_can_be_used_there_is_no_folder(
    pictures: Path, tmp_path: Path
) -> None:
    for path in (pictures / "depth").iterdir():
        np.save(path, np.full((HEIGHT, WIDTH), np.nan, np.float32))
    with pytest.raises(InputError, match="no frame can be used"):
        mapped(pictures, tmp_path / "map")
    assert not (tmp_path / "map").exists()


@pytest.mark.parametrize("world_model", sorted(OF_PICTURES))
def test_a_cloud_is_no_use_to_a_model_that_finds_floors_in_pictures(
    tmp_path: Path, world_model: str
) -> None:
    path = landscape(tmp_path)
    with pytest.raises(InputError, match="finds its floors in pictures"):
        mapped(path, tmp_path / "map", world_model=world_model)


@needs_data
@pytest.mark.parametrize(
    ("name", "model", "least"),
    [
        ("rgbd_room", "elevation", 3000),
        ("isprs_ground_filter/samp11-utm.pcd.gz", "elevation", 3000),
        ("real_terrain_clouds/terrain_med.pcd.gz", "elevation", 5000),
        ("laser2d/intel-lab.log.gz", "occupancy_2d", 200_000),
    ],
)
def test_data_of_others_gives_a_map_by_one_command(
    tmp_path: Path, name: str, model: str, least: int
) -> None:
    chosen = None if model == "occupancy_2d" else model
    made = mapped(data(name), tmp_path / "map", world_model=chosen)
    known = made.result.cells.floor + made.result.cells.obstacle
    assert made.result.world_model == model
    assert known > least
