"""Claims about the child process: what it returns comes back, what it refuses is an error here."""

import importlib
from collections.abc import Callable
from pathlib import Path

import pytest

from treadwell.errors import InputError
from treadwell.limited import limited, place_of
from treadwell.mjcf.build import build_files
from treadwell.physics.audit import replay_lengths

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
