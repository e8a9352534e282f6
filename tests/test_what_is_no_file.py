"""Claims about folders in which something is no file: no verb waits for it or reads without end."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

import pytest
from sweep_builders import short

import treadwell
from treadwell.cli.app import execute

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]
MEMORY: Final = 8 << 30
"""Bytes of address space that a verb may take: without bound it would take all there is."""

KINDS: Final[dict[str, Callable[[Path], None]]] = {
    "pipe": os.mkfifo,
    "endless": lambda path: path.symlink_to("/dev/zero"),
}
VERIFY, REPORT = ("verify",), ("report", "--out", "{out}/page.html")
FILM = (*REPORT, "--video", "{out}/film.gif")
REPLAY = ("replay", "--out", "{out}/replay")
Verb = tuple[str, ...]


def export(to: str) -> Verb:
    return ("export", "--to", to, "--out", "{out}/export")


READ_BY: Final[dict[str, tuple[Verb, ...]]] = {
    "result.json": (VERIFY, FILM),
    "trajectory.tum": (VERIFY, FILM, export("tum")),
    "trajectory_truth.tum": (VERIFY, REPORT, export("tum")),
    "map.png": (VERIFY, REPORT),
    "map.npz": (VERIFY, FILM, export("map_server"), export("ply")),
    "model.mjb": (VERIFY, FILM),
    "physics.npz": (VERIFY, FILM),
    "recording.rrd": (VERIFY, REPORT, export("octomap"), export("ply")),
    "observations.mcap": (VERIFY, REPORT, REPLAY),
    "scenario.toml": (VERIFY, REPORT),
}
"""File of a run -> the verbs that read it."""
SWEEP_VERBS: Final = (REPORT, ("compare",))
LIMITED: Final = (
    "import resource, sys; from treadwell.cli.app import execute; "
    f"resource.setrlimit(resource.RLIMIT_AS, ({MEMORY}, {MEMORY})); "
    "[print(f'\\nSTATUS {execute(line.split(chr(124)))}') for line in sys.argv[1:]]"
)


def statuses(verbs: Sequence[tuple[Path, Verb]], out: Path) -> list[int]:
    """Return the exit status of each verb on its folder; all in one process of bounded memory."""
    lines = []
    for number, (folder, (verb, *options)) in enumerate(verbs):
        place = out / str(number)
        place.mkdir(parents=True)
        lines.append("|".join([verb, str(folder), *(word.format(out=place) for word in options)]))
    command = [sys.executable, "-c", LIMITED, *lines]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert "fault of treadwell" not in done.stderr, done.stderr
    assert "MemoryError" not in done.stderr, done.stderr
    found = [int(line[7:]) for line in done.stdout.splitlines() if line.startswith("STATUS ")]
    assert len(found) == len(lines), done.stderr
    return found


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tenth of a second of a run, recorded."""
    out = tmp_path_factory.mktemp("runs") / "run"
    return treadwell.run("slalom", overrides=("time_limit=0.1",), out=out).folder


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep of two short episodes."""
    folder = tmp_path_factory.mktemp("sweeps")
    assert sweep_of(folder) in (0, 1)
    return folder / "sweep"


def sweep_of(folder: Path) -> int:
    out = ("--out", str(folder / "sweep"))
    return execute(["sweep", short(folder), "--episodes", "2", "--workers", "1", *out])


def with_another(folder: Path, name: str, kind: str, place: Path) -> Path:
    """Return a copy of a folder in which one file is of another kind."""
    copy = Path(shutil.copytree(folder, place / "copy"))
    (copy / name).unlink()
    KINDS[kind](copy / name)
    return copy


@pytest.mark.parametrize("kind", ["pipe", pytest.param("endless", marks=pytest.mark.long)])
def test_a_runs_verbs_refuse_what_is_no_file(kind: str, run: Path, tmp_path: Path) -> None:
    verbs = []
    for name, read_by in READ_BY.items():
        copy = with_another(run, name, kind, tmp_path / name)
        verbs += [(copy, verb) for verb in read_by]
    found = statuses(verbs, tmp_path / "out")
    assert set(found) <= {0, 1, 2}
    verified = [status for status, (_, verb) in zip(found, verbs, strict=True) if verb == VERIFY]
    assert verified == [1] * len(READ_BY)


@pytest.mark.parametrize("kind", KINDS)
def test_a_sweeps_verbs_refuse_what_is_no_file(kind: str, sweep: Path, tmp_path: Path) -> None:
    names = ("sweep.json", "results.json", "journal.jsonl")
    copies = [with_another(sweep, name, kind, tmp_path / name) for name in names]
    verbs = [(copy, verb) for copy in copies for verb in SWEEP_VERBS]
    assert set(statuses(verbs, tmp_path / "out")) <= {0, 1, 2}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["sweep.json", "journal.jsonl"])
def test_a_sweep_does_not_go_on_with_what_is_no_file(
    name: str, kind: str, sweep: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy(sweep.parent / "short.toml", tmp_path)
    copy = with_another(sweep, name, kind, tmp_path)
    copy.rename(tmp_path / "sweep")
    assert sweep_of(tmp_path) == 2
    assert f"{name}: cannot be read: it is no file" in capsys.readouterr().err
    assert not (tmp_path / "sweep" / name).is_file()
