"""A run's folder is new, and `runs/latest` leads to the last."""

import errno
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from treadwell.errors import InputError, RecordingError
from treadwell.recording.run_folder import make_experiment_folder, run_folder


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def begun(out: Path | None, scenario: str, robot: str, seed: int) -> Path:
    """Return the folder of a run that has begun."""
    with run_folder(out, scenario, robot, seed) as folder:
        return folder


def test_runs_of_one_second_have_folders_of_their_own_and_latest_is_the_last(here: Path) -> None:
    made = [begun(None, "slalom", "qrio", 3) for _ in range(4)]
    assert len(set(made)) == 4
    for folder in made:
        assert folder.is_dir()
        assert folder.parent == Path("runs")
        assert folder.name.startswith("slalom-qrio-3-2")
    assert (here / "runs" / "latest").resolve() == made[-1].resolve()


def test_of_many_at_once_each_has_a_folder_of_its_own() -> None:
    barrier = Barrier(16)

    def make(_: int) -> Path:
        barrier.wait()
        return make_experiment_folder(None, "fog")

    with ThreadPoolExecutor(16) as pool:
        assert len(set(pool.map(make, range(16)))) == 16


def test_a_disk_that_is_full_is_no_bad_input(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "mkdir", full)
    with pytest.raises(RecordingError, match="No space left"):
        begun(here / "new", "x", "y", 0)


def test_a_folder_of_the_users_may_be_deep_or_empty(here: Path) -> None:
    assert begun(here / "a" / "b", "x", "y", 0).is_dir()
    (here / "empty").mkdir()
    begun(here / "empty", "x", "y", 0)
    assert not (here / "runs").exists()


def test_a_run_is_never_overwritten(here: Path) -> None:
    full = here / "full"
    full.mkdir()
    (full / "result.json").write_text("{}")
    file = here / "file"
    file.write_text("")
    for taken in (full, file):
        with pytest.raises(InputError, match="exists already; a run is never overwritten"):
            begun(taken, "x", "y", 0)
    assert (full / "result.json").read_text() == "{}"


def test_a_folder_that_cannot_be_made_is_bad_input(here: Path) -> None:
    (here / "file").write_text("")
    with pytest.raises(InputError, match="--out: file/run: "):
        begun(Path("file/run"), "x", "y", 0)
    with pytest.raises(InputError, match="File name too long"):
        begun(Path("x" * 300), "x", "y", 0)


def test_a_file_called_runs_is_bad_input(here: Path) -> None:
    (here / "runs").write_text("")
    with pytest.raises(InputError, match="--out: runs/slalom-qrio-0"):
        begun(None, "slalom", "qrio", 0)


@pytest.mark.parametrize("name", [None, "new", "empty"])
def test_a_run_that_cannot_begin_leaves_nothing_behind(here: Path, name: str | None) -> None:
    (here / "empty").mkdir()
    before = begun(None, "slalom", "qrio", 0)
    there = sorted(here.rglob("*"))

    def fail() -> None:
        with run_folder(None if name is None else Path(name), "slalom", "qrio", 1) as folder:
            (folder / "scenario.toml").write_text("half")
            raise RecordingError("the disk is full")

    with pytest.raises(RecordingError, match="the disk is full"):
        fail()
    assert sorted(here.rglob("*")) == there
    assert (here / "runs" / "latest").resolve() == before.resolve()
