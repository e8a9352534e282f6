"""Good files of every kind that treadwell reads, and what reads each: for `fuzz_files.py`."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from fuzz_guests import CAMERA, GUESTS, guests, read_model
from PIL import Image

from treadwell._core import Octree
from treadwell.comparing.sides import candidates
from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.exports.export import export
from treadwell.judging.result import read_result
from treadwell.mjcf.build import build_files
from treadwell.mjcf.xml import check_xml
from treadwell.physics.recorded_audit import load_audit
from treadwell.recording.file import whole_length
from treadwell.recording.observation_log import read_answers, read_observations, read_truth
from treadwell.recording.trajectory import read_trajectory
from treadwell.replaying.source import open_source
from treadwell.reporting.sweep_data import read_sweep
from treadwell.robot.reading import read_robot_file
from treadwell.scenario.loading import load_scenario
from treadwell.sources.source import open_source as open_recording
from treadwell.sweeps.folder import read_asked
from treadwell.sweeps.journal import Journal
from treadwell.sweeps.row import row_of
from treadwell.sweeps.suite import find_suite

WORLD = b"""<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody>
<geom name="a" type="box" size=".2 .3 .02" pos="1 0 .02"/><replicate count="3" offset="1 0 0">
<body pos="2 1 0"><geom type="cylinder" size=".1 .2"/></body></replicate>
<geom type="mesh" mesh="m"/>
</worldbody></mujoco>"""
OBJ = b"v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
LASER = b"""VERTEX2 0 1.0 2.0 0.5
ROBOTLASER1 0 -1.57 3.14 1.57 50.0 0.1 0 3 1.0 2.0 81.83 0 1 2 0.5 1 2 0.5 0 0 0 0 0 5.5 h 0.5
FLASER 3 1.0 2.0 3.0 5 6 0.0 5.1 6 0.0 976053557.5 host 0.5
"""
SHARED = ("good.mcap", "run", "sweep")
"""What readers find beside the changed file."""
EXPORTS = ("octomap", "map_server", "ply", "tum")


def _scenario(path: Path) -> None:
    load_scenario(path).configuration()


def _world(path: Path) -> None:
    check_xml(path, path.parent, "x")
    build_files(str(path), "x")


def _mesh(path: Path) -> None:
    build_files(str(path), "x")


def _log(path: Path) -> None:
    """Read a log; one that is taken for whole must say what the good one said."""
    good = path.parent / "good.mcap"
    if _said(path) != _said(good):
        raise AssertionError("taken for whole, but says something else")


def _said(path: Path) -> list[Any]:
    shutil.copyfile(path, path.parent / "observations.mcap")
    open_source(path.parent)
    observed = [(o.time_ns, o.joint_positions.tobytes()) for o in read_observations(path)]
    return [observed, list(read_answers(path)), list(read_truth(path))]


def read_log(path: Path) -> None:
    """Read a log, whatever it says."""
    _said(path)


def _placed(path: Path, folder: str) -> Path:
    """Put a file in its place in a good folder; return the folder."""
    shutil.copyfile(path, path.parent / folder / path.name)
    return path.parent / folder


def _journal(path: Path) -> None:
    read_sweep(_placed(path, "sweep"))
    journal = Journal(path)
    try:
        rows = [row_of(row) for row in journal.rows]
        assert all(isinstance(row.seed, int) for row in rows)
    except (TypeError, ValueError) as error:  # as `SweepFolder` takes it
        raise InputError(str(error)) from None
    finally:
        journal.close()


def _asked(path: Path) -> None:
    read_sweep(_placed(path, "sweep"))
    read_asked(path)


def _results(path: Path) -> None:
    folder = _placed(path, "sweep")
    read_sweep(folder)
    candidates([folder])


def _map(path: Path) -> None:
    folder = _placed(path, "run")
    for to in EXPORTS:
        export(folder, to, path.parent / "exported")


def _source(path: Path) -> None:
    """Read what a map can be made of, whichever form it has."""
    for frame in open_recording(path):
        assert np.isfinite(frame.world_from_sensor).all()


def _bag(path: Path) -> None:
    for frame in open_recording(path, topics=["/camera/points"]):
        assert np.isfinite(frame.world_from_sensor).all()


def _depths(path: Path) -> None:
    """Read a folder of one depth image."""
    folder = path.parent / "depths"
    (folder / "depth").mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, folder / "depth" / f"1.0{path.suffix}")
    (folder / "camera.toml").write_text(CAMERA, encoding="utf-8")
    (folder / "poses.tum").write_text("1.0 0 0 0 0 0 0 1\n", encoding="utf-8")
    _source(folder)
    (folder / "depth" / f"1.0{path.suffix}").unlink()


def _physics(path: Path) -> None:
    load_audit(_placed(path, "run"))


Reader = Callable[[Path], Any]
READERS: dict[str, tuple[str, Reader]] = {
    "scenario": ("x.toml", _scenario),
    "robot": ("robot.toml", read_robot_file),
    "world": ("x.xml", _world),
    "obj": ("x.obj", _mesh),
    "stl": ("x.stl", _mesh),
    "log": ("x.mcap", _log),
    "result": ("result.json", read_result),
    "trajectory": ("trajectory.tum", read_trajectory),
    "recording": ("x.rrd", whole_length),
    "tree": ("x.ot", lambda path: Octree.read(str(path))),
    "binary tree": ("x.bt", lambda path: Octree.read(str(path))),
    "journal": ("journal.jsonl", _journal),
    "sweep.json": ("sweep.json", _asked),
    "results.json": ("results.json", _results),
    "suite": ("suite.toml", lambda path: find_suite(str(path))),
    "map": ("map.npz", _map),
    "physics": ("physics.npz", _physics),
    "pcd": ("x.pcd", _source),
    "ply": ("cloud.ply", _source),
    "laser log": ("x.log", _source),
    "bag": ("run.mcap", _bag),
    "depth image": ("depth.png", _depths),
    "depth array": ("depth.npy", _depths),
    **GUESTS,
}
"""Kind -> its file's name, and what reads it."""
BUILT = (_world, _mesh, read_model)
"""What the program does in a child process of its own."""


def seeds(folder: Path) -> None:
    """Write the good files."""
    import treadwell
    from treadwell.cli.app import execute

    shipped = data_folder("scenarios")
    run = treadwell.run("slalom", overrides=("time_limit=0.3",), out=folder / "run").folder
    words = ["sweep", "open_floor", "--episodes", "2", "--workers", "1", "--set", "time_limit=0.3"]
    execute([*words, "--out", str(folder / "sweep")])
    tree = Octree(0.1)
    tree.occupy(np.random.default_rng(0).uniform(-1, 1, (200, 3)))
    shutil.copyfile(shipped / "visitor.toml", folder / "x.toml")
    shutil.copyfile(data_folder("models") / "qrio" / "robot.toml", folder / "robot.toml")
    shutil.copyfile(run / "observations.mcap", folder / "x.mcap")
    shutil.copyfile(run / "observations.mcap", folder / "good.mcap")
    for name in ("result.json", "trajectory.tum", "map.npz", "physics.npz"):
        shutil.copyfile(run / name, folder / name)
    for name in ("journal.jsonl", "sweep.json", "results.json"):
        shutil.copyfile(folder / "sweep" / name, folder / name)
    shutil.copyfile(next((shipped / "suites").glob("*.toml")), folder / "suite.toml")
    (folder / "x.rrd").write_bytes((run / "recording.rrd").read_bytes()[:50_000])
    (folder / "x.xml").write_bytes(WORLD)
    (folder / "x.obj").write_bytes(OBJ)
    faces = np.random.default_rng(0).uniform(-1, 1, (20, 12)).astype("<f4")
    body = b"".join(face.tobytes() + b"\0\0" for face in faces)
    (folder / "x.stl").write_bytes(bytes(80) + (20).to_bytes(4, "little") + body)
    tree.write(str(folder / "x.ot"))
    tree.write(str(folder / "x.bt"))
    _recordings(folder, run)
    guests(folder)


def _recordings(folder: Path, run: Path) -> None:
    """Write what a map can be made of."""
    export(run, "ply", folder)
    export(run, "mcap", folder)
    points = np.random.default_rng(0).uniform(-1, 1, (50, 3)).astype("<f4")
    head = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 50\nHEIGHT 1\n"
    head += "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 50\nDATA binary\n"
    (folder / "x.pcd").write_bytes(head.encode() + points.tobytes())
    (folder / "x.log").write_bytes(LASER)
    depth = 2.0 + 0.01 * np.arange(192).reshape(12, 16)
    Image.fromarray((1000 * depth).astype(np.uint16)).save(folder / "depth.png")
    np.save(folder / "depth.npy", depth.astype(np.float32))


def share(good: Path, here: Path) -> None:
    """Bring what readers find beside the changed file."""
    for name in SHARED:
        if (good / name).is_dir():
            shutil.copytree(good / name, here / name)
        else:
            shutil.copyfile(good / name, here / name)
