"""Claims about files: strangers' are bounded and files at all; ours are whole or not there."""

import os
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import pytest

import treadwell
from treadwell.errors import InputError
from treadwell.exports.export import export
from treadwell.files import read_content, read_text, whole_file, write_text
from treadwell.reporting.report import report


def test_a_small_file_is_read(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("ä")
    assert read_text(tmp_path / "x", 2) == "ä"
    with pytest.raises(InputError, match="larger than 1 bytes"):
        read_content(tmp_path / "x", 1)


def test_a_small_file_takes_little_memory_whatever_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("ä")
    tracemalloc.start()
    assert read_text(tmp_path / "x", 1 << 40) == "ä"
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 1_000_000


def test_what_is_no_file_or_no_text_is_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "x").write_bytes(b"\xff")
    for name, word in (("pipe", "no file"), (".", "no file"), ("none", "cannot be read")):
        with pytest.raises(InputError, match=word):
            read_content(tmp_path / name, 10)
    with pytest.raises(InputError, match="not UTF-8"):
        read_text(tmp_path / "x", 10)
    with pytest.raises(InputError, match="not a file's name"):
        read_text(tmp_path / "a\0b", 10)


@pytest.fixture
def umask(request: pytest.FixtureRequest) -> Iterator[int]:
    before = os.umask(request.param)
    yield request.param
    os.umask(before)


@pytest.mark.parametrize("umask", [0o077, 0o002, 0o027], indirect=True)
def test_what_is_written_whole_has_the_umasks_permissions(umask: int, tmp_path: Path) -> None:
    write_text(tmp_path / "x", "ä")
    assert (tmp_path / "x").stat().st_mode & 0o777 == 0o666 & ~umask
    assert (tmp_path / "x").read_bytes() == "ä".encode()


@pytest.mark.slow
@pytest.mark.parametrize("umask", [0o077, 0o002], indirect=True)
def test_every_file_of_a_run_and_of_its_exports_has_the_umasks_permissions(
    umask: int, tmp_path: Path
) -> None:
    folder = treadwell.run("slalom", overrides=("time_limit=0.1",), out=tmp_path / "run").folder
    for to in ("octomap", "map_server", "ply", "tum"):
        export(folder, to)
    report([folder])
    modes = {path.name: path.stat().st_mode & 0o777 for path in folder.rglob("*") if path.is_file()}
    assert len(modes) >= 18
    assert {name: oct(mode) for name, mode in modes.items() if mode != 0o666 & ~umask} == {}


def test_what_fails_amid_its_writing_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "x.txt").write_text("before")

    def fail() -> None:
        with whole_file(tmp_path / "x.txt") as temporary:
            assert temporary.suffix == ".txt"
            temporary.write_text("half")
            raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        fail()
    assert [path.name for path in tmp_path.iterdir()] == ["x.txt"]
    assert (tmp_path / "x.txt").read_text() == "before"
