"""A scenario is input: which Python it names is told before it runs, or refused."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from sweep_builders import short
from test_additions import package

import treadwell
from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.plugins import foreign_parts, load_component
from treadwell.sweeps.request import crossed

pytest_plugins = ["pytester"]
SECOND = "--set=time_limit=0.2"
SOURCE = """import pathlib
pathlib.Path(__file__).with_name("it_ran").write_text("")
from treadwell.protocols import Plan
class P:
    def plan(self, *given):
        return Plan(None, "stays")
"""


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A module that leaves a mark when it is imported; it is named `stranger`."""
    file = tmp_path / "stranger.py"
    file.write_text(SOURCE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "stranger", raising=False)
    return file


def scenario(folder: Path, planner: str = "stranger:P", more: str = "") -> str:
    path = folder / "named.toml"
    path.write_text(
        'schema = 1\nname = "named"\ntime_limit = 0.2\n[start]\n[goal]\nposition = [1.0, 0.0]\n'
        f'[navigation]\nplanner = "{planner}"\n{more}'
    )
    return str(path)


def test_check_names_the_class_and_loads_nothing_of_it(
    module: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = scenario(tmp_path, more="[navigation.P]\nspeed = 3\n")
    assert execute(["check", path]) == 0
    shown = capsys.readouterr().out
    assert f"planner stranger:P {module}: named, not loaded" in shown
    assert execute(["check", path, "--json"]) == 0
    (named,) = json.loads(capsys.readouterr().out)["python"]
    assert named == {
        "slot": "planner", "name": "stranger:P", "class": "stranger:P", "file": str(module),
    }  # fmt: skip
    assert not (tmp_path / "it_ran").exists()
    assert "stranger" not in sys.modules


def test_what_treadwell_brings_itself_is_no_python_of_the_users(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert execute(["check", "slalom", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["python"] == []


@pytest.mark.parametrize("verb", ["check", "run", "sweep"])
@pytest.mark.parametrize(
    ("planner", "message"),
    [
        ("unittest.__main__:P", "unittest.__main__ has no class P"),
        ("this:Zen", "this has no class Zen"),
        ("xml.dom.minidom:Node", "Node has no method plan"),
        ("no_such_module:P", "there is no module no_such_module"),
    ],
)
def test_a_module_without_such_a_class_is_refused_and_not_imported(
    verb: str, planner: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, name = scenario(tmp_path, planner), planner.partition(":")[0]
    before = set(sys.modules)
    more = ["--episodes", "1"] if verb == "sweep" else []
    more += ["--out", str(tmp_path / "out")] if verb != "check" else []
    assert execute([verb, path, *more]) == 2
    captured = capsys.readouterr()
    assert f"{path}: navigation.planner: {planner}: {message}" in captured.err
    assert captured.out == ""
    assert name in before or name not in sys.modules
    assert not (tmp_path / "out").exists()


def test_a_run_says_once_and_before_which_python_it_runs(
    module: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert execute(["run", scenario(tmp_path), "--no-record", "--json", "--out", str(out)]) == 1
    captured = capsys.readouterr()
    assert captured.err.startswith(f"python:    runs planner stranger:P ({module})\n")
    assert captured.err.count("stranger:P") == 1
    assert json.loads(captured.out)["outcome"] == "timed_out"
    assert (tmp_path / "it_ran").exists()


@pytest.mark.usefixtures("module")
def test_no_user_code_refuses_it_in_every_verb(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, run = scenario(tmp_path), tmp_path / "run"
    assert execute(["run", path, "--no-user-code", "--out", str(run)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"error: {path}: navigation.planner: found 'stranger:P'")
    assert "python:" not in said
    sweep = ["sweep", "--episodes", "1", "--no-user-code", "--out", str(tmp_path / "sweep")]
    assert execute([*sweep, path]) == 2
    assert execute([*sweep, "slalom", "--vary", "navigation.planner=a_star,stranger:P"]) == 2
    assert capsys.readouterr().err.count("found 'stranger:P'") == 2
    assert not (tmp_path / "it_ran").exists()
    assert not run.exists()
    assert not (tmp_path / "sweep").exists()
    assert (
        execute(["run", "slalom", SECOND, "--no-user-code", "--no-record", "--out", str(run)]) == 1
    )


def test_a_replay_says_it_or_refuses_it_too(
    module: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = tmp_path / "run"
    treadwell.run(scenario(tmp_path), out=run)
    assert execute(["replay", str(run), "--no-user-code", "--out", str(tmp_path / "no")]) == 2
    assert "navigation.planner: found 'stranger:P'" in capsys.readouterr().err
    assert execute(["replay", str(run), "--out", str(tmp_path / "yes")]) == 0
    assert f"python:    runs planner stranger:P ({module})\n" in capsys.readouterr().err
    with pytest.raises(InputError, match=r"no-user-code \(user_code=False\)"):
        treadwell.replay(run, user_code=False, out=tmp_path / "never")


@pytest.mark.usefixtures("module")
def test_a_sweep_knows_the_classes_that_its_seeds_draw(tmp_path: Path) -> None:
    """A scenario may draw its planner: that of the first seed is not that of all."""
    path = Path(short(tmp_path))
    drawn = '"navigation.planner" = { choice = ["a_star", "stranger:P"] }\n'
    path.write_text(path.read_text() + drawn)
    names = [
        {
            part.name
            for part in foreign_parts(
                treadwell.Episode(path, seed=seed).scenario.navigation.slots()
            )
        }
        for seed in range(6)
    ]
    first = next(seed for seed in range(6) if not names[seed])
    assert any(names[first:])
    request = crossed([str(path)], seeds=range(first, 6))
    assert [part.name for part in request.python()] == ["stranger:P"]
    with pytest.raises(InputError, match="found 'stranger:P'"):
        request.refuse_user_code()
    by_hand = crossed(
        [short(tmp_path, "b")], seeds=range(2), settings=("navigation.planner=a_star",)
    )
    assert by_hand.python() == {}


@pytest.mark.slow
def test_a_sweep_says_once_what_its_episodes_run(
    module: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["sweep", scenario(tmp_path), "--episodes", "2", "--workers", "1", "--keep", "0"]
    assert execute([*asked, "--out", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert said.count(f"python:    runs planner stranger:P ({module})\n") == 1
    assert said.index("python:") < said.index("results:")


def test_what_an_installed_package_brings_is_told_and_not_refused(
    module: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    package(tmp_path, "ours", "planner.straight = stranger:P\n")
    path, out = scenario(tmp_path, "straight"), str(tmp_path / "out")
    assert execute(["check", path]) == 0
    assert not (tmp_path / "it_ran").exists()
    assert "planner stranger:P" in capsys.readouterr().out
    assert execute(["run", path, "--no-user-code", "--no-record", "--out", out]) == 1
    assert execute(["run", path, "--no-record", "--out", out + "2"]) == 1
    assert f"runs planner straight = stranger:P ({module})" in capsys.readouterr().err


@pytest.mark.usefixtures("module")
def test_an_object_of_the_callers_beats_what_the_scenario_names(tmp_path: Path) -> None:
    class Own:
        def plan(self, *_: object) -> None:
            raise NotImplementedError

    treadwell.Episode(scenario(tmp_path), user_code=False, planner=Own())
    assert not (tmp_path / "it_ran").exists()
    with pytest.raises(InputError, match=r"named\.toml: navigation\.planner: found 'stranger:P'"):
        treadwell.Episode(scenario(tmp_path), user_code=False)


@pytest.mark.usefixtures("module")
def test_an_environment_refuses_it(tmp_path: Path) -> None:
    gymnasium = pytest.importorskip("gymnasium")
    source = (tmp_path / "stranger.py").read_text().replace("plan(", "estimate(")
    (tmp_path / "stranger.py").write_text(source + "    def correct(self, *given): ...\n")
    path = scenario(tmp_path, "a_star", 'localizer = "stranger:P"\n')
    with pytest.raises(InputError, match=r"navigation\.localizer: found 'stranger:P'"):
        gymnasium.make("treadwell/ObstacleCourse-v0", scenario=path, user_code=False)
    assert not (tmp_path / "it_ran").exists()


@pytest.mark.usefixtures("module")
def test_the_pytest_plugin_refuses_it(pytester: pytest.Pytester) -> None:
    path = scenario(pytester.path)
    (pytester.path / "stranger.py").write_text(SOURCE)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(pytester.path), *sys.path])}
    asked = [sys.executable, "-m", "pytest", "-q", path]
    done = subprocess.run(
        [*asked, "--treadwell-no-user-code"],
        cwd=pytester.path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr
    assert "navigation.planner: found 'stranger:P'" in done.stdout
    assert not (pytester.path / "it_ran").exists()


def test_a_class_is_loaded_from_its_module(module: Path) -> None:
    assert type(load_component("planner", "stranger:P", {})).__module__ == module.stem
