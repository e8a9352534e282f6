"""The command of a report runs the same configuration again: it is typed in and compared."""

import shlex
from pathlib import Path
from typing import Any

import pytest

from treadwell.recording.scenario_file import write_scenario
from treadwell.reporting.repeat import repeat_command
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario

OWN = """
schema = 1
name = "my_course"
description = "it's <b>\\"mine\\"</b>"
robot = "nao"
[start]
position = [0.0, 0.0]
[goal]
position = [2.0, 0.0]
[[course]]
kind = "box"
name = "a box"
position = [1.0, 0.4]
size = [0.2, 0.1, 0.3]
[vary]
"start.yaw" = { uniform = [-0.3, 0.3] }
"""


def typed(command: str) -> dict[str, Any]:
    """Return the configuration that a command line would run."""
    program, verb, source, *rest = shlex.split(command)
    assert (program, verb) == ("treadwell", "run")
    pairs = list(zip(rest[::2], rest[1::2], strict=True))
    robot = next((value for option, value in pairs if option == "--robot"), None)
    seed = next(int(value) for option, value in pairs if option == "--seed")
    settings = [value for option, value in pairs if option == "--set"]
    return load_scenario(source, robot=robot, seed=seed, overrides=settings).configuration()


def written(folder: Path, made: Scenario) -> Path:
    folder.mkdir(exist_ok=True)
    write_scenario(folder / "scenario.toml", made)
    return folder


@pytest.mark.parametrize(
    ("robot", "seed", "settings"),
    [
        (None, 0, ()),
        (None, 7, ("time_limit=12.5",)),
        ("nao", 7, ("course.0.rise=0.025", "physics.friction=0.61")),
        (None, 3, ("navigation.world_model=averaging", "navigation.fog.cell=0.05")),
        (None, 1, ("goal.via=[[0.2, 0.1]]", "expect.max_time=90", "start.known=true")),
        (None, 1, ("description=a 'quoted' $HOME \"text\"; rm -rf `x`",)),
        (None, 1, ('course=[{kind="box",position=[1,0.6],size=[0.1,0.1,0.2],name="x"}]',)),
    ],
)
def test_the_command_gives_the_same_configuration(
    tmp_path: Path, robot: str | None, seed: int, settings: tuple[str, ...]
) -> None:
    made = load_scenario("stairs_up", robot=robot, seed=seed, overrides=settings)
    found = repeat_command(made.configuration(), tmp_path)
    assert found.words[:3] == ("treadwell", "run", "stairs_up")
    assert typed(found.command) == made.configuration()
    assert found.note == ""


def test_what_was_drawn_is_not_set_again(tmp_path: Path) -> None:
    made = load_scenario("stairs_up", seed=4)
    found = repeat_command(made.configuration(), tmp_path)
    assert found.command == "treadwell run stairs_up --seed 4"


def test_a_file_of_the_users_own_is_named(tmp_path: Path) -> None:
    path = tmp_path / "my course's.toml"
    path.write_text(OWN)
    made = load_scenario(path, seed=2, overrides=("goal.radius=0.2",))
    found = repeat_command(made.configuration(), written(tmp_path / "run", made))
    assert found.words[2] == str(path)
    assert typed(found.command) == made.configuration()


def test_when_that_file_has_changed_the_runs_own_is_named(tmp_path: Path) -> None:
    path = tmp_path / "course.toml"
    path.write_text(OWN)
    made = load_scenario(path, seed=2)
    folder = written(tmp_path / "run", made)
    path.unlink()
    found = repeat_command(made.configuration(), folder)
    assert found.words[2] == str(folder / "scenario.toml")
    assert typed(found.command) == made.configuration()


def test_without_any_file_there_is_no_command_but_a_reason(tmp_path: Path) -> None:
    path = tmp_path / "course.toml"
    path.write_text(OWN)
    made = load_scenario(path)
    path.unlink()
    found = repeat_command(made.configuration(), tmp_path / "gone")
    assert found.words == ()
    assert "my_course" in found.note


@pytest.mark.parametrize("configuration", [{}, {"name": 3}, {"name": "slalom", "seed": "x"}])
def test_a_configuration_that_is_none_has_no_command(
    tmp_path: Path, configuration: dict[str, Any]
) -> None:
    assert repeat_command(configuration, tmp_path).words == ()
