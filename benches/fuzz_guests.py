"""Good models of bodies, messages, and what stands beside recordings, and what reads each."""

import io
import json
import shutil
from pathlib import Path
from unittest.mock import patch

import numpy as np
from PIL import Image

import treadwell.mjcf.build
from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.recording.mesh_file import SurfaceMesh, Texture, read_mesh, write_mesh
from treadwell.robot.report import report_on
from treadwell.robot.template import write_template
from treadwell.serving.framing import pack, read_message
from treadwell.serving.protocol import HELLO, VERSION
from treadwell.serving.served import ServedRobot
from treadwell.sources.landmark_log import open_landmark_log
from treadwell.sources.source import open_source

CAMERA = "width = 16\nheight = 12\nfx = 20.0\nfy = 20.0\ncx = 7.5\ncy = 5.5\ndepth_scale = 1000\n"
POSES = "1.0 0 0 0 0 0 0 1\n1.5 0.1 0 0 0 0 0.1 0.995\n"
ODOMETRY = "# time v w\n0.0 0.1 0.0\n1.0 0.2 0.3\n2.0 0.1 -0.1\n3.0 0.0 0.0\n"
MEASUREMENTS = "# time code r phi\n0.5 63 2.0 0.1\n0.5 25 3.1 -0.2\n1.5 63 1.9 0.2\n2.5 25 3 0\n"
BARCODES = "1 5\n2 14\n3 41\n4 32\n5 23\n6 63\n7 25\n"
WISHES = {
    "goal": {"position": [2.0, 0.0], "radius": 0.2},
    "start": {"position": [0.0, 0.1], "yaw": 0.1},
    "navigation": {"world_model": "fog", "planner": "a_star", "fog": {"cell": 0.04}},
}
"""What a client says to a server."""
_SERVED: list[ServedRobot] = []


def read_model(path: Path) -> None:
    """Draft a robot for a model of a body, and report on both.

    What MuJoCo builds is built here: a crash ends one worker, and counts as contained.
    """
    folder = path.parent / "robot"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copyfile(path, folder / path.name)
    with patch.object(treadwell.mjcf.build, "limited", lambda task, arguments, _: task(*arguments)):
        write_template(folder)
        json.dumps(report_on(folder), allow_nan=False)


def read_wire(path: Path) -> None:
    """Take what a client sends first, and make the core that it asks for."""
    if not _SERVED:
        _SERVED.append(ServedRobot("qrio"))
    first = read_message(io.BytesIO(path.read_bytes()).read)
    if first is None:
        raise InputError("nothing came")
    _SERVED[0].core(first)


def _put(path: Path, files: dict[str, bytes | str], name: str) -> Path:
    """Return a new folder of good files, one of them changed."""
    folder = path.parent / f"of_{path.stem}"
    shutil.rmtree(folder, ignore_errors=True)
    for place, content in files.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        (folder / place).write_bytes(content if isinstance(content, bytes) else content.encode())
    shutil.copyfile(path, folder / name)
    return folder


def _read_all(source: Path) -> None:
    for frame in open_source(source):
        assert np.isfinite(frame.world_from_sensor).all()


def _picture(dtype: type[np.generic]) -> bytes:
    depth = 2000.0 + 10.0 * np.arange(192).reshape(12, 16)
    file = io.BytesIO()
    Image.fromarray(depth.astype(dtype)).save(file, "PNG")
    return file.getvalue()


def read_camera_table(path: Path) -> None:
    """Read a depth image by a camera's table."""
    files = {"poses.tum": POSES, "depth/1.0.png": _picture(np.uint16)}
    _read_all(_put(path, {**files, "camera.toml": CAMERA}, "camera.toml"))


def read_poses(path: Path) -> None:
    """Read a depth image by its poses."""
    files = {"camera.toml": CAMERA, "depth/1.0.png": _picture(np.uint16)}
    _read_all(_put(path, {**files, "poses.tum": POSES}, "poses.tum"))


def read_height_picture(path: Path) -> None:
    """Read a picture of heights."""
    table = "cell = 0.1\nheight = 2.0\n"
    _read_all(_put(path, {"heights.toml": table}, "heights.png") / "heights.png")


def read_landmarks(path: Path) -> None:
    """Read a folder of ranges and bearings, as a map is made of it."""
    files = {"Odometry.dat": ODOMETRY, "Measurement.dat": MEASUREMENTS, "Barcodes.dat": BARCODES}
    open_landmark_log(_put(path, dict(files), "Measurement.dat"))


GUESTS = {
    "model": ("body.xml", read_model),
    "wire": ("hello.bin", read_wire),
    "camera table": ("camera_table.toml", read_camera_table),
    "poses": ("poses.tum", read_poses),
    "heights": ("height_picture.png", read_height_picture),
    "landmarks": ("landmarks.dat", read_landmarks),
    "mesh": ("mesh.npz", read_mesh),
}
"""Kind -> its file's name, and what reads it."""


def guests(folder: Path) -> None:
    """Write the good files."""
    shutil.copyfile(data_folder("models") / "qrio" / "qrio.xml", folder / "body.xml")
    hello = {"type": HELLO, "protocol": VERSION, "robot": "qrio", **WISHES}
    (folder / "hello.bin").write_bytes(pack(hello))
    (folder / "camera_table.toml").write_text(CAMERA, encoding="utf-8")
    (folder / "poses.tum").write_text(POSES, encoding="utf-8")
    (folder / "height_picture.png").write_bytes(_picture(np.uint8))
    (folder / "landmarks.dat").write_text(MEASUREMENTS, encoding="utf-8")
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.5]], np.float32)
    texture = Texture(np.full((4, 6, 3), 90, np.uint8), np.full((3, 2), 0.5, np.float32))
    triangles = np.array([[0, 1, 2]], np.uint32)
    write_mesh(folder / "mesh.npz", SurfaceMesh(corners, triangles, texture))
