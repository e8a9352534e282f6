"""Completion in the shell: what it offers where a name is due, and the scripts that ask for it.

Each function here is asked at a press of the tab key, and imports what it needs then.
"""

import os
from enum import StrEnum
from typing import Final

import typer

from treadwell.errors import RecordingError

ASKED: Final = "_TREADWELL_COMPLETE"
"""Environment variable by which a shell's script asks for what there is to offer."""
_PROGRAM: Final = "treadwell"

_BASH: Final = r"""
_treadwell_completion() {
    # Bash takes `=` for the end of a word: key and value are put together for the question, and
    # of each answer only the value is inserted.
    local IFS=$'\n' i words=()
    for ((i = 0; i <= COMP_CWORD; i++)); do
        if ((i > 1)) && [[ ${COMP_WORDS[i]} == "=" || ${COMP_WORDS[i-1]} == "=" ]]; then
            words[${#words[@]}-1]+=${COMP_WORDS[i]}
        else
            words+=("${COMP_WORDS[i]}")
        fi
    done
    COMPREPLY=( $( env COMP_WORDS="${words[*]}" COMP_CWORD=$((${#words[@]} - 1)) \
                   ASKED=complete_bash "$1" ) )
    if ((${#words[@]} <= COMP_CWORD)) && [[ ${words[${#words[@]}-1]} == *=* ]]; then
        COMPREPLY=("${COMPREPLY[@]#*=}")
    fi
    return 0
}

complete -o default -F _treadwell_completion treadwell
""".replace("ASKED", ASKED)


class Shell(StrEnum):
    """A shell for which there is a script."""

    BASH = "bash"
    ZSH = "zsh"
    FISH = "fish"


def script(shell: Shell) -> str:
    """Return what a shell has to read to ask for completions."""
    from typer._completion_shared import get_completion_script

    if shell is Shell.BASH:
        return _BASH.strip()
    return get_completion_script(prog_name=_PROGRAM, complete_var=ASKED, shell=shell.value)


def show(shell: Shell | None) -> None:
    """Write a shell's script to standard output, and end; do nothing for None."""
    if shell is not None:
        typer.echo(script(shell))
        raise typer.Exit


def install(shell: Shell | None) -> None:
    """Put a shell's script where new shells read it, say where, and end; do nothing for None.

    Raises:
        RecordingError: a file of the user's home cannot be written.
    """
    if shell is None:
        return
    from typer._completion_shared import install as write

    try:
        _, path = write(shell=shell.value, prog_name=_PROGRAM, complete_var=ASKED)
        path.write_text(f"{script(shell)}\n")
    except OSError as error:
        raise RecordingError(f"{error.filename}: cannot be written: {error.strerror}") from None
    typer.echo(f"completion: {path}; a new {shell.value} reads it")
    raise typer.Exit


def prepare() -> None:
    """Make ready to answer where a shell's script asks; else do nothing."""
    if os.environ.get(ASKED):
        from typer._completion_classes import completion_init

        completion_init()


def scenarios() -> list[str]:
    """Return the names of scenarios; files come of the shell where none fits."""
    from treadwell.data import scenario_names

    return scenario_names()


def robots() -> list[str]:
    """Return the names of robots."""
    from treadwell.data import robot_names

    return robot_names()


def suites() -> list[str]:
    """Return the names of suites."""
    from treadwell.sweeps.suite import suite_names

    return suite_names()


def settings(incomplete: str) -> list[str]:
    """Return `KEY=VALUE`: components by slot, and parameters with their defaults.

    Args:
        incomplete: what is typed so far.
    """
    from treadwell.additions import known
    from treadwell.components import COMPONENTS

    choices = [f"navigation.{slot}={name}" for slot in COMPONENTS for name in known(slot)]
    if "=" in incomplete:
        return choices
    from treadwell.reference.parameters import find_parameters

    # Functions have settings, too, but not in a scenario.
    rows = [row for row in find_parameters() if row.key.startswith("navigation.")]
    return choices + [f"{row.key}={_bare(row.default)}" for row in rows]


def list_kinds() -> list[str]:
    """Return what `list` can show."""
    from treadwell.cli.list import kinds

    return kinds()


def list_names(context: typer.Context) -> list[str]:
    """Return whose parameters `list parameters` can show; of `list experiments` the experiments."""
    if context.params.get("what") == "experiments":
        return experiments()
    if context.params.get("what") != "parameters":
        return []
    from treadwell.reference.parameters import all_tables

    return [table.name for table in all_tables()]


def experiments() -> list[str]:
    """Return the names of experiments."""
    from treadwell.experiments.catalogue import EXPERIMENTS

    return list(EXPERIMENTS)


def cases(context: typer.Context) -> list[str]:
    """Return the names of the cases of the experiment that was typed before."""
    from treadwell.experiments.catalogue import EXPERIMENTS

    # With an option that lacks its value words are not yet taken for arguments.
    typed = (context.params.get("name"), *context.args)
    return [case.name for word in typed if word in EXPERIMENTS for case in EXPERIMENTS[word].cases]


def _bare(value: object) -> str:
    """Return a value as one types it, nothing for what a shell would need quotes for."""
    if isinstance(value, bool):
        return str(value).lower()
    return str(value) if isinstance(value, int | float | str) else ""
