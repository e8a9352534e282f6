"""Made recordings of every form that a map can be made of, and where the real ones are."""

import os
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from treadwell.sources.frame import RangeFrame
from treadwell.sources.source import POSE_WITHIN_S, Source, open_source

DATA = os.environ.get("TREADWELL_DATA")
needs_data = pytest.mark.skipif(DATA is None, reason="TREADWELL_DATA does not say where data are")

WIDTH, HEIGHT = 8, 6
CAMERA = {"width": WIDTH, "height": HEIGHT, "fx": 9.0, "fy": 9.5, "cx": 3.25, "cy": 2.75}
IDENTITY = "0 0 0 0 0 0 1"


def data(name: str) -> Path:
    assert DATA is not None
    path = Path(DATA) / name
    if not path.exists():
        pytest.skip(f"TREADWELL_DATA has no {name}")
    return path


def read(
    path: Path,
    camera: Path | None = None,
    topics: Sequence[str] = (),
    pose_within: float = POSE_WITHIN_S,
) -> tuple[Source, list[RangeFrame]]:
    """A source, and all that it yields."""
    source = open_source(path, camera=camera, topics=topics, pose_within=pose_within)
    return source, list(source)


def camera_text(**changed: object) -> str:
    table: dict[str, object] = {**CAMERA, "depth_scale": 1000, **changed}
    return "".join(f"{key} = {value}\n" for key, value in table.items() if value is not None)


def picture(level: float = 2.0) -> NDArray[np.float64]:
    """Depths in metres, one of them not seen."""
    depth = level + 0.01 * np.arange(WIDTH * HEIGHT).reshape(HEIGHT, WIDTH)
    depth[1, 2] = 0.0
    return depth


def write_png(path: Path, numbers: NDArray[Any]) -> None:
    Image.fromarray(numbers.astype(np.uint16)).save(path)


def depth_folder(
    folder: Path,
    times: Sequence[str] = ("1.0", "2.0", "3.0"),
    poses: Sequence[str] = (f"1.0 {IDENTITY}", f"2.0 {IDENTITY}", f"3.0 {IDENTITY}"),
    **camera: object,
) -> Path:
    (folder / "depth").mkdir(parents=True)
    (folder / "camera.toml").write_text(camera_text(**camera))
    (folder / "poses.tum").write_text("# time pose\n" + "".join(f"{line}\n" for line in poses))
    for time in times:
        write_png(folder / "depth" / f"{time}.png", np.round(1000 * picture()))
    return folder


POINTS = np.array([[1.0, 2.0, 0.5], [-3.0, 0.25, 0.125], [np.nan] * 3, [4.0, -1.0, 2.0]])
COLOURS = np.array([[1, 2, 3], [255, 128, 0], [0, 0, 0], [9, 8, 7]], np.uint8)


def pcd(
    data: str = "binary",
    kind: str = "F",
    size: int = 4,
    points: NDArray[np.float64] = POINTS,
    viewpoint: str = "0 0 0 1 0 0 0",
    count: int | None = None,
) -> bytes:
    """A cloud with an intensity before its points, and colours behind them."""
    count = len(points) if count is None else count
    head = f"# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z rgb\nSIZE 2 {size} {size} {size} 4\n"
    head += f"TYPE U {kind} {kind} {kind} U\nCOUNT 1 1 1 1 1\nWIDTH {count}\nHEIGHT 1\n"
    head += f"VIEWPOINT {viewpoint}\nPOINTS {count}\nDATA {data}\n"
    rgb = np.zeros(len(points), "<u4")
    colours = np.resize(COLOURS, (len(points), 3)).astype("<u4")
    rgb[:] = colours[:, 0] << 16 | colours[:, 1] << 8 | colours[:, 2]
    types = [("i", "<u2"), *((name, f"<{kind.lower()}{size}") for name in "xyz"), ("rgb", "<u4")]
    rows = np.zeros(len(points), types)
    rows["i"], rows["rgb"] = 7, rgb
    for number, name in enumerate("xyz"):
        rows[name] = points[:, number]
    if data == "ascii":
        lines = [" ".join(str(value) for value in row) for row in rows.tolist()]
        return (head + "\n".join(lines) + "\n").encode()
    if data == "binary":
        return head.encode() + rows.tobytes()
    import lzf

    columns = b"".join(np.ascontiguousarray(rows[name]).tobytes() for name, _ in types)
    packed = lzf.compress(columns, 2 * len(columns) + 100)
    return head.encode() + struct.pack("<II", len(packed), len(columns)) + packed


def ply(
    order: str = "binary_little_endian", kind: str = "float", count: int | None = None
) -> bytes:
    """A cloud with a confidence before its points, colours and a face behind them."""
    mark = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[order]
    count = len(POINTS) if count is None else count
    head = f"ply\nformat {order} 1.0\ncomment made\nelement vertex {count}\nproperty uchar c\n"
    head += "".join(f"property {kind} {name}\n" for name in "xyz")
    head += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    number = {"float": "f4", "double": "f8", "int": "i4"}[kind]
    types = [("c", "u1"), *((name, mark + number) for name in "xyz")]
    rows = np.zeros(len(POINTS), [*types, ("rgb", "u1", 3)])
    rows["rgb"] = COLOURS
    for i, name in enumerate("xyz"):
        rows[name] = POINTS[:, i] if kind != "int" else np.nan_to_num(POINTS[:, i])
    if not mark:
        lines = [" ".join(str(v) for v in [*row[:4], *row[4]]) for row in rows.tolist()]
        return (head + "\n".join(lines) + "\n3 0 1 3\n").encode()
    return head.encode() + rows.tobytes() + struct.pack(f"{mark}Biii", 3, 0, 1, 3)
