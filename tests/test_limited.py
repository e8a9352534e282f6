"""Claims about the child process: what it returns comes back, what it refuses is an error here."""

import importlib
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.limited import limited, place_of
from treadwell.mjcf.build import build_files
from treadwell.physics.recorded_audit import replay_lengths

BOX = "<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>"


def test_what_a_task_returns_comes_back(tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text(BOX)
    assert limited(build_files, [str(tmp_path / "x.xml"), "x"], "x") is True


def test_what_a_task_refuses_is_refused_in_its_words(tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text("<mujoco><worldbody><geom size='-1'/></worldbody></mujoco>")
    with pytest.raises(InputError, match="the thing: MuJoCo cannot"):
        limited(build_files, [str(tmp_path / "x.xml"), "the thing"], "the thing")


@pytest.mark.parametrize("task", [build_files, replay_lengths])
def test_every_task_is_a_function_that_a_child_finds(task: Callable[..., object]) -> None:
    module, _, name = place_of(task).partition(":")
    assert getattr(importlib.import_module(module), name) is task


def under_a_limit(gigabytes: float, *arguments: str) -> tuple[int, str]:
    """Return status and messages of a command under `ulimit -v`."""
    most = int(1e9 * gigabytes)
    done = subprocess.run(
        [sys.executable, "-m", "treadwell.cli.app", *arguments],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)),
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    return done.returncode, done.stderr


@pytest.mark.slow
def test_a_limit_of_the_shell_is_not_blamed_on_the_robot(tmp_path: Path) -> None:
    robot = str(shutil.copytree(data_folder("models") / "qrio", tmp_path / "own"))
    assert under_a_limit(3.5, "check", "slalom", "--robot", robot) == (0, "")
    status, told = under_a_limit(0.7, "check", "slalom", "--robot", robot)
    assert status in (0, 3)
    assert status == 0 or "this shell allows 0.7 GB of memory (ulimit -v)" in told


@pytest.mark.slow
@pytest.mark.parametrize("gigabytes", [1.0, 2.0])
def test_a_recording_for_which_there_is_no_memory_is_not_begun(
    gigabytes: float, tmp_path: Path
) -> None:
    out = str(tmp_path / "run")
    status, told = under_a_limit(gigabytes, "run", "slalom", "--out", out)
    assert status == 3
    assert f"error: the run cannot be recorded: this shell allows {gigabytes:.1f} GB" in told
    assert told.count("\n") == 1
    assert not (tmp_path / "run").exists()
