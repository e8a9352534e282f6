"""Claims about recordings whose bytes are wrong: an error in one line, or frames that are sound."""

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
import pytest
from bag_builders import SECOND, cloud, depth_bag, way, write_bag
from PIL import Image
from source_builders import HEIGHT, IDENTITY, WIDTH, depth_folder, pcd, picture, ply, read

from treadwell.errors import InputError
from treadwell.sources.frame import RangeFrame

ROUNDS: Final = 120


def _file(name: str, content: Callable[[], bytes]) -> Callable[[Path], Path]:
    def make(folder: Path) -> Path:
        (folder / name).write_bytes(content())
        return folder / name

    return make


def _depths(folder: Path) -> Path:
    made = depth_folder(folder / "depths")
    np.save(made / "depth" / "2.0.npy", picture().astype(np.float32))
    (made / "depth" / "2.0.png").unlink()
    (made / "color").mkdir()
    Image.fromarray(np.zeros((HEIGHT, WIDTH, 3), np.uint8)).save(made / "color" / "1.0.png")
    return made


def _clouds(folder: Path) -> Path:
    made = folder / "clouds"
    made.mkdir()
    (made / "1.0.pcd").write_bytes(pcd("binary_compressed"))
    (made / "2.0.ply.gz").write_bytes(gzip.compress(ply()))
    (made / "poses.tum").write_text(f"1.0 {IDENTITY}\n2.0 {IDENTITY}\n")
    return made


def _heights(folder: Path) -> Path:
    Image.fromarray(np.arange(16, dtype=np.uint8).reshape(4, 4)).save(folder / "a.png")
    (folder / "a.toml").write_text("cell = 0.1\nheight = 1.0\n")
    return folder / "a.png"


def _log() -> bytes:
    scan = (
        "ROBOTLASER1 0 -1.57 3.14 1.57 50.0 0.1 0 3 1.0 2.0 3.0 0 1 2 0 1 2 0 0 0 0 0 0 5.5 h 1\n"
    )
    old = "FLASER 3 1.0 2.0 3.0 5 6 0.0 5.1 6 0.0 976053557.5 host 0.5\n"
    return (f"VERTEX2 0 1 2 0.5\n{scan}" + old).encode()


MADE: Final[dict[str, Callable[[Path], Path]]] = {
    "depth folder": _depths,
    "cloud folder": _clouds,
    "height image": _heights,
    "laser log": _file("a.log", _log),
    "packed log": _file("a.log.gz", lambda: gzip.compress(_log())),
    **{f"pcd {data}": _file("a.pcd", lambda data=data: pcd(data))  # type: ignore[misc]
       for data in ("ascii", "binary", "binary_compressed")},
    **{f"ply {order}": _file("a.ply", lambda order=order: ply(order))  # type: ignore[misc]
       for order in ("ascii", "binary_little_endian", "binary_big_endian")},
    "mcap": lambda folder: write_bag(folder, "mcap", depth_bag()),
    "mcap of clouds": lambda folder: write_bag(folder, "mcap", [*way(), cloud(2 * SECOND)]),
    "ros1 bag": lambda folder: write_bag(folder, "ros1 bag", depth_bag()),
    "ros2 bag": lambda folder: write_bag(folder, "ros2 bag", depth_bag()),
}  # fmt: skip


def check(frame: RangeFrame) -> None:
    """What every frame must be, whatever its source."""
    assert frame.world_from_sensor.shape == (4, 4)
    assert np.isfinite(frame.world_from_sensor).all()
    turn = frame.world_from_sensor[:3, :3]
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.isfinite(frame.time)
    if frame.camera is not None:
        assert frame.layout == "picture"
        assert frame.depth is not None
        assert frame.depth.dtype == np.float32
        assert frame.depth.shape == (frame.camera.height, frame.camera.width)
        seen = frame.depth[~np.isnan(frame.depth)]
        assert len(seen)
        assert (seen > 0.0).all()
        assert np.isfinite(seen).all()
        shape = frame.depth.shape
    else:
        assert frame.points is not None
        assert frame.points.dtype == np.float32
        none = np.isnan(frame.points).any(axis=1)
        assert not none.all()
        assert np.isfinite(frame.points[~none]).all()
        shape = frame.points.shape[:1]
    if frame.colour is not None:
        assert frame.colour.shape == (*shape, 3)
        assert frame.colour.dtype == np.uint8


def spoiled(content: bytes, random: np.random.Generator) -> bytes:
    """Bytes with some changed, left out, doubled or cut off."""
    broken = bytearray(content)
    for _ in range(int(random.integers(1, 6))):
        at = int(random.integers(len(broken) + 1))
        many = int(random.integers(1, 9))
        match int(random.integers(5)):
            case 0:
                broken[at : at + many] = random.bytes(len(broken[at : at + many]))
            case 1:
                del broken[at : at + many]
            case 2:
                broken[at:at] = broken[at : at + many]
            case 3 if random.integers(3) == 0:
                del broken[at:]
            case _:
                broken[at : at + 1] = random.choice([b"\0", b"\xff", b"9", b"-", b" ", b"n"])
    return bytes(broken)


def outcome(path: Path) -> str:
    """Read a source: what is refused, or nothing."""
    try:
        source, frames = read(path)
    except InputError as error:
        return str(error)
    for frame in frames:
        check(frame)
    assert source.unused.total() >= 0
    return ""


@pytest.mark.parametrize("kind", MADE)
def test_what_is_whole_gives_sound_frames(tmp_path: Path, kind: str) -> None:
    assert not outcome(MADE[kind](tmp_path))


@pytest.mark.slow
@pytest.mark.parametrize("kind", MADE)
def test_wrong_bytes_are_refused_or_give_sound_frames(tmp_path: Path, kind: str) -> None:
    path = MADE[kind](tmp_path)
    files = [each for each in sorted(tmp_path.rglob("*")) if each.is_file()]
    random = np.random.default_rng(11)
    for number in range(ROUNDS):
        file = files[number % len(files)]
        whole = file.read_bytes()
        file.write_bytes(spoiled(whole, random))
        message = outcome(path)
        file.write_bytes(whole)
        assert len(message) < 3000
        assert len(message.splitlines()) <= 10
