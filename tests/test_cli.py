"""The command line: what `check` and `list` say, the status and message of every misuse."""

import io
import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from treadwell.cli import run as cli_run
from treadwell.cli.app import execute
from treadwell.cli.check import checked
from treadwell.cli.list import listed
from treadwell.cli.output import guarded
from treadwell.cli.progress import ProgressLine, line
from treadwell.components import COMPONENTS, PAPERS
from treadwell.errors import InputError, TreadwellError
from treadwell.scenario.loading import scenario_names
from treadwell.scenario.model import Scenario

HEAD = 'schema = 1\nname = "x"\n[start]\n[goal]\n'


def test_check_says_what_would_be_built(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["check", "visitor", "--seed", "3"]) == 0
    shown = capsys.readouterr().out
    for word in ("visitor", "post", "cylinder", "qrio", "0.25 m"):
        assert word in shown


def test_check_as_json_writes_json_and_nothing_else(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["check", "slalom", "--json", "--seed", "3", "--set", "goal.radius=0.2"]) == 0
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    assert document["configuration"]["seed"] == 3
    assert document["goal"]["radius"] == 0.2
    assert document == json.loads(json.dumps(checked(
        "slalom", robot=None, seed=3, settings=["goal.radius=0.2"])))  # fmt: skip
    assert captured.err == ""


@pytest.mark.parametrize(
    ("setting", "told"),
    [
        ("navigation.fog.cel=1", "--set navigation.fog.cel: unknown field"),
        ("navigation.fog.cell=-1", "--set navigation.fog.cell must be from"),
        ("foo.bar=1", "--set foo: unknown key"),
        ("start.yaw=abc", '--set start.yaw: found "abc"'),
        ("course.x.y=1", '--set course.x.y: found "x"'),
    ],
)
def test_what_is_wrong_with_a_setting_is_not_the_files_fault(
    setting: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["check", "doorway", "--set", setting]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"error: {told}")
    assert said.rstrip().endswith("doorway.toml)")


def test_what_is_wrong_with_a_file_is_told_so_whatever_is_set(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "x.toml"
    path.write_text(f"{HEAD}[navigation.fog]\ncel = 1\n[foo]\nx = 1\n")
    assert execute(["check", str(path), "--set", "navigation.fog.cell=0.05"]) == 2
    said = capsys.readouterr().err
    assert f"error: {path}: " in said
    assert "--set" not in said


def test_a_word_of_a_list_that_is_misspelt_has_the_nearest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for arguments, near in (
        (["export", "x", "--to", "octmap"], "octomap"),
        (["schema", "scenaro"], "scenario"),
    ):
        assert execute(arguments) == 2
        said = capsys.readouterr().err
        assert f"did you mean '{near}'?" in said
        assert "Value error" not in said


def test_the_nearest_stands_before_a_list_that_fills_the_screen(
    capsys: pytest.CaptureFixture[str],
) -> None:
    for arguments, begins in (
        (["run", "slalon"], "slalon: no such file or scenario; did you mean 'slalom'? scenarios: "),
        (
            ["list", "parameters", "foog"],
            "NAME: there are no parameters of 'foog'; did you mean 'fog'? allowed are ",
        ),
        (["run", "qqqqqq"], "qqqqqq: no such file or scenario; scenarios: "),
    ):
        assert execute(arguments) == 2
        assert capsys.readouterr().err.startswith(f"error: {begins}")


def test_lists_with_papers_say_which(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["list", "components"]) == 0
    captured = capsys.readouterr()
    assert "Gutmann, Fukuchi and Fujita 2005 (000)" in captured.out
    page = Path(__file__).resolve().parent.parent / "docs" / "papers" / "README.md"
    listed_there = page.read_text().replace("*", "").replace("J.-S. ", "")
    for number, paper in PAPERS.items():
        assert f"{number}: {paper}" in captured.err
        assert f"| {number} |" in listed_there
        assert paper.split(": ", 1)[1].split(", in: ")[0] in listed_there
    assert execute(["list", "parameters", "fog"]) == 0
    told = capsys.readouterr().err
    assert "000: Gutmann" in told
    assert "004: " not in told


@pytest.mark.parametrize("what", ["scenarios", "robots", "components"])
def test_list_has_everything(what: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["list", what, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == listed([what])
    assert execute(["list", what]) == 0
    assert capsys.readouterr().out
    if what == "scenarios":
        assert [entry["name"] for entry in document[what]] == scenario_names()
        assert not any("broken" in entry["description"] for entry in document[what])
    elif what == "robots":
        assert "qrio" in [entry["name"] for entry in document[what]]
    else:
        assert document[what] == COMPONENTS


@pytest.mark.parametrize("slot", COMPONENTS)
def test_one_kind_of_component_is_listed_by_its_plural(
    slot: str, capsys: pytest.CaptureFixture[str]
) -> None:
    kind = f"{slot}s"
    assert execute(["list", kind, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {kind: COMPONENTS[slot]}
    assert execute(["list", kind]) == 0
    shown = capsys.readouterr().out
    listed_names = [line.split()[0] for line in shown.splitlines() if line.strip()]
    assert listed_names[0] == kind
    assert set(COMPONENTS[slot]) <= set(listed_names)


@pytest.mark.parametrize("arguments", [[], ["robot"]])
def test_without_a_verb_the_help_is_shown_and_nothing_is_wrong(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(arguments) == 0
    alone = capsys.readouterr()
    assert alone.err == ""
    assert execute([*arguments, "--help"]) == 0
    assert capsys.readouterr().out == alone.out
    assert alone.out.startswith(f"Usage: {' '.join(['treadwell', *arguments])} ")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["chek"], "Did you mean"),
        (["check"], "SCENARIO"),
        (["check", "slalon"], "did you mean 'slalom'?"),
        (["check", "slalom", "--sed", "1"], "--sed"),
        (["check", "slalom", "--seed", "-1"], "--seed"),
        (["check", "slalom", "--seed", "x"], "--seed"),
        (["check", "slalom", "--set", "physics"], "KEY=VALUE"),
        (["check", "slalom", "--set", "physics.friction=nan"], "physics.friction: found nan"),
        (["check", "slalom", "--set", "course.frist.yaw=1"], "did you mean 'first'?"),
        (["check", "slalom", "--robot", "qiro"], "did you mean 'qrio'?"),
        (["check", "slalom", "slalom"], "slalom"),
        (["check", "slalom", "--set", "start.position=[0.75, 0.12]"], "inside the obstacle"),
        (["check", "slalom", "--set", "navigation.fog.cell=0"], "navigation.fog.cell"),
        (["check", "slalom", "--set", "navigation.fog.sell=1"], "sell"),
        (["check", "slalom", "--set", "navigation.planner=no.such:Thing"], "no.such"),
        (["list", "robot"], "did you mean 'robots'?"),
        (["list", "planner"], "did you mean 'planners'?"),
        (["list", "walls"], "allowed are scenarios, robots, components, experiments, world_models"),
        (["list", "planners", "a_star"], "only `list parameters` and `list experiments`"),
        (["run", "slalon"], "did you mean 'slalom'?"),
    ],
)
def test_a_misuse_is_one_message_and_status_2(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(arguments) == 2
    captured = capsys.readouterr()
    assert expected in captured.err
    assert captured.err.startswith("error: ")
    assert "Traceback" not in captured.err
    assert captured.out == ""
    assert execute([*arguments, "--json"]) == 2
    document = json.loads(capsys.readouterr().out)
    assert document["status"] == 2
    assert document["error"]


@pytest.mark.parametrize("verb", ["run", "check", "list", "inspect", "verify"])
def test_help_of_each_verb_has_an_example_and_json(
    verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute([verb, "--help"]) == 0
    shown = capsys.readouterr().out
    assert f"Example: treadwell {verb}" in shown
    assert "--json" in shown


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (InputError("a"), 2),
        (TreadwellError("a"), 3),
        (OSError(28, "No space left on device"), 3),
        (RuntimeError("a"), 3),
        (MemoryError(), 3),
        (KeyboardInterrupt(), 130),
    ],
)
def test_every_error_has_its_status_and_no_traceback(
    error: BaseException, status: int, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> None:
        raise error

    assert guarded(fail, as_json=True) == status
    captured = capsys.readouterr()
    assert "Traceback" not in captured.err
    assert json.loads(captured.out)["status"] == status


def test_no_traceback_reaches_the_user_of_the_program(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(HEAD + "[physics]\nfriction = 'a'\n")
    done = subprocess.run(
        [sys.executable, "-m", "treadwell.cli.app", "check", str(path)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr.strip() == (
        f'error: {path}: physics.friction: found "a"; must be a valid number'
    )


def test_the_command_line_starts_without_loading_the_physics() -> None:
    program = "import sys, treadwell.cli.app; sys.exit('mujoco' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def result(**changes: object) -> dict[str, Any]:
    plain: dict[str, Any] = {
        "scenario": "x", "robot": "qrio", "seed": 0, "outcome": "goal_reached", "reason": None,
        "passed": True, "failures": [], "simulated_seconds": 12.34, "real_time_factor": 8.0,
        "falls": 0, "collisions": [], "steps_taken": 9, "path_length": 1.0, "replans": 1,
        "localization": {"translation_error": {"mean": 0.012}}, "ablation": False,
    }  # fmt: skip
    return {**plain, **changes}


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, 0),
        ({"outcome": "refused", "reason": "blocked: no way", "passed": True}, 0),
        ({"outcome": "fell", "passed": False}, 1),
        ({"outcome": "timed_out", "passed": False}, 1),
        ({"outcome": "interrupted", "passed": False}, 130),
        ({"outcome": "error", "passed": False}, 3),
    ],
)
def test_run_hands_its_options_on_and_returns_the_outcomes_status(
    changes: dict[str, Any],
    status: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    seen: dict[str, Any] = {}

    def run(scenario: Scenario, **options: object) -> SimpleNamespace:
        seen.update(options, scenario=scenario)
        return SimpleNamespace(document=result(**changes), folder=tmp_path, least_clearance=0.1)

    monkeypatch.setitem(sys.modules, "treadwell.runner", SimpleNamespace(run=run))
    changed = ["--set", "time_limit=9", "--set", "goal.radius=0.2"]
    arguments = ["run", "slalom", "--seed", "4", *changed, "--no-record", "--no-user-code"]
    assert execute([*arguments, "--json"]) == status
    assert json.loads(capsys.readouterr().out) == result(**changes)
    made = seen["scenario"]
    assert (made.name, made.seed, made.time_limit, made.goal.radius) == ("slalom", 4, 9.0, 0.2)
    assert not seen["user_code"]
    assert not seen["record"]
    assert execute(arguments) == status
    assert result(**changes)["outcome"] in capsys.readouterr().out


def test_the_result_table_leaves_out_what_is_not_known(capsys: pytest.CaptureFixture[str]) -> None:
    cli_run.show(result(localization=None, replans=None))
    shown = capsys.readouterr().out
    assert "12.3 s" in shown
    assert "replans" not in shown
    assert "localization" not in shown


def test_progress_without_a_terminal_writes_a_line_at_times_and_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    with ProgressLine("slalom") as progress:
        for tick in range(1000):
            progress.update(tick * 0.01, "walk" if tick < 300 else "search", 2.0, 8.0)
    lines = stream.getvalue().splitlines()
    assert len(lines) == 3  # at 0 s, where the state changes at 3 s, and at 5 s
    assert all(text.startswith("slalom") for text in lines)
    assert "search" in lines[1]


def test_progress_lines_are_aligned_whatever_the_state_is_called(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    with ProgressLine("slalom") as progress:
        for time_s, state in enumerate(("look_around", "walk", "a_state_of_the_users", "walk")):
            progress.update(time_s, state, 2.0, 8.0)
    ends = [text.index(" m to the goal") for text in stream.getvalue().splitlines()]
    assert ends[0] == ends[1] < ends[2] == ends[3]


def test_progress_on_a_terminal_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    with ProgressLine("slalom", terminal=True) as progress:
        progress.update(1.0, "walk", 2.0, 8.0)
    assert "\n" not in stream.getvalue().strip()
    assert "2.00 m to the goal" in line(1.0, "walk", 2.0, 8.0)
