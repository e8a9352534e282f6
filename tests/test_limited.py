"""Claims about the child process: what it returns comes back, what it refuses is an error here."""

from pathlib import Path

import pytest

from treadwell.errors import InputError
from treadwell.limited import TASKS, limited

BOX = "<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>"


def test_what_a_task_returns_comes_back(tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text(BOX)
    assert limited("build", [str(tmp_path / "x.xml"), "x"], "x") is True


def test_what_a_task_refuses_is_refused_in_its_words(tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text("<mujoco><worldbody><geom size='-1'/></worldbody></mujoco>")
    with pytest.raises(InputError, match="the thing: MuJoCo cannot"):
        limited("build", [str(tmp_path / "x.xml"), "the thing"], "the thing")


def test_every_task_is_a_function() -> None:
    import importlib

    for where in TASKS.values():
        module, _, name = where.partition(":")
        assert callable(getattr(importlib.import_module(module), name))
