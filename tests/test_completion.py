"""What a shell is offered where a name is due, and that bash inserts it rightly."""

import stat
import subprocess
import sys
from pathlib import Path

import pytest

from treadwell.cli import completion
from treadwell.cli.app import execute
from treadwell.cli.completion import ASKED, Shell
from treadwell.cli.list import kinds
from treadwell.components import COMPONENTS
from treadwell.data import robot_names, scenario_names
from treadwell.experiments.catalogue import EXPERIMENTS
from treadwell.exports.export import FORMATS
from treadwell.reference.parameters import all_tables, find_parameters
from treadwell.sweeps.suite import suite_names

PLANNERS = [f"navigation.planner={name}" for name in COMPONENTS["planner"]]


def offered(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> list[str]:
    """What the command answers bash when the cursor is behind the last of some words."""
    monkeypatch.setenv("COMP_WORDS", "\n".join(["treadwell", *words]))
    monkeypatch.setenv("COMP_CWORD", str(len(words)))
    monkeypatch.setenv(ASKED, "complete_bash")
    completion.prepare()
    with pytest.raises(SystemExit) as done:
        execute([])
    assert done.value.code == 0
    return capsys.readouterr().out.split()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["repl"], ["replay"]),
        (["run", ""], scenario_names()),
        (["check", "slal"], ["slalom"]),
        (["sweep", "slalom", "stairs_up"], ["stairs_up"]),
        (["run", "slalom", "--robot", ""], robot_names()),
        (["map", "x", "--robot=q"], ["qrio"]),
        (["run", "slalom", "--set", "navigation.planner="], PLANNERS),
        (["sweep", "slalom", "--vary", "navigation.pl"], PLANNERS),
        (["replay", "x", "--set", "navigation.fog.cells"], ["navigation.fog.cells=100"]),
        (["sweep", "--suite", ""], suite_names()),
        (["list", ""], kinds()),
        (["list", "parameters", ""], [table.name for table in all_tables()]),
        (["list", "robots", ""], []),
        (["experiment", ""], list(EXPERIMENTS)),
        (["experiment", "nao", "--only", ""], [case.name for case in EXPERIMENTS["nao"].cases]),
        (["experiment", "no", "--only", ""], []),
        (["export", "x", "--to", ""], list(FORMATS)),
        (["verify", "runs/"], []),
    ],
)
def test_a_name_is_offered_where_it_is_due(
    words: list[str],
    expected: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert offered(words, monkeypatch, capsys) == expected


def test_every_parameter_of_a_scenario_is_offered_with_its_default() -> None:
    offers = completion.settings("navigation.")
    keys = {one.partition("=")[0] for one in offers}
    assert {row.key for row in find_parameters() if row.key.startswith("navigation.")} <= keys
    assert len(offers) == len(set(offers))
    assert "navigation.ground.correct=true" in offers
    assert "navigation.a_star.radius=" in offers  # None: it follows
    assert not any(" " in one for one in offers)


ASK = """
source {script}
ask() {{
    COMP_WORDS=("$@"); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
    _treadwell_completion {program}
    echo "${{COMPREPLY[*]}}"
}}
ask treadwell check slal
ask treadwell check slalom --set navigation.planner = a_
ask treadwell check slalom --set navigation.localizer =
ask treadwell check --set navigation.planner = a_star doorw
ask treadwell check --robot = q
"""
"""Words as bash breaks them."""


@pytest.mark.slow  # five starts of the command
def test_bash_breaks_words_at_equals_signs_and_is_given_what_it_may_insert(tmp_path: Path) -> None:
    program = tmp_path / "treadwell"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m treadwell "$@"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    script = tmp_path / "script"
    script.write_text(completion.script(Shell.BASH))
    asked = ASK.format(script=script, program=program)
    done = subprocess.run(["bash", "-c", asked], capture_output=True, text=True, check=True)
    localizers = " ".join(COMPONENTS["localizer"])
    assert done.stdout.splitlines() == ["slalom", "a_star", localizers, "doorway", "qrio"]
    assert done.stderr == ""


@pytest.mark.parametrize("shell", Shell)
def test_a_shells_script_is_shown_and_installed(
    shell: Shell,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert execute(["--show-completion", shell.value]) == 0
    shown = capsys.readouterr().out
    assert f"{ASKED}=complete_{shell.value}" in shown
    monkeypatch.setenv("HOME", str(tmp_path))
    for _ in range(2):  # again: no harm
        assert execute(["--install-completion", shell.value]) == 0
        told = capsys.readouterr().out
    path = Path(told.removeprefix("completion: ").partition(";")[0])
    assert path.is_relative_to(tmp_path)
    assert path.read_text() == shown
    profile = tmp_path / {"bash": ".bashrc", "zsh": ".zshrc", "fish": ".config"}[shell.value]
    assert profile.exists()


def test_a_shell_without_a_script_and_a_home_that_takes_none_are_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["--show-completion", "tcsh"]) == 2
    assert "'bash', 'zsh', 'fish'" in capsys.readouterr().err
    home = tmp_path / "file"
    home.write_text("")
    monkeypatch.setenv("HOME", str(home))
    assert execute(["--install-completion", "fish"]) == 3
    message = capsys.readouterr().err
    assert message.startswith(f"error: {home}")
    assert message.count("\n") == 1
