"""The verb `sweep`: many episodes with a bar of successes so far, and the counts as a table."""

import math
import os
import shlex
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from treadwell.cli.output import (
    FAILED,
    PASSED,
    announce,
    write_json,
    write_message,
    write_table,
)
from treadwell.cli.sweep_progress import SweepProgress
from treadwell.errors import InputError
from treadwell.recording.run_folder import sweep_folder
from treadwell.sweeps.conduct import GIGABYTE, Care, conduct
from treadwell.sweeps.engine import Engine, local_engine
from treadwell.sweeps.request import Request, crossed
from treadwell.sweeps.suite import find_suite


@dataclass(frozen=True, slots=True)
class Asked:
    """Which episodes the command line asks for."""

    scenarios: tuple[str, ...]
    suite: str | None
    episodes: int | None
    first_seed: int
    robot: str | None
    settings: tuple[str, ...]
    vary: tuple[str, ...]

    @property
    def name(self) -> str:
        """What a folder is called after."""
        return self.suite or Path(self.scenarios[0]).stem

    @property
    def command(self) -> str:
        """What asks for the same again, but for the folder."""
        words = ["treadwell", "sweep", *self.scenarios]
        words += ["--suite", self.suite] if self.suite else []
        words += ["--episodes", str(self.episodes)] if self.episodes is not None else []
        words += ["--first-seed", str(self.first_seed)] if self.first_seed else []
        words += ["--robot", self.robot] if self.robot else []
        words += [word for setting in self.settings for word in ("--set", setting)]
        words += [word for one in self.vary for word in ("--vary", one)]
        return shlex.join(words)

    def request(self) -> Request:
        """Return the sweep.

        Raises:
            InputError: what was given is bad, or does not go together.
        """
        if self.suite is not None:
            if self.scenarios or self.episodes is not None or self.first_seed or self.robot:
                raise InputError(
                    "--suite: a suite has its scenarios, seeds and robots; only --set and --vary "
                    "go with it"
                )
            return find_suite(self.suite).request(self.settings, self.vary)
        if not self.scenarios:
            raise InputError("sweep: there is no scenario; name one or more, or --suite NAME")
        if self.episodes is None:
            raise InputError("sweep: --episodes N is missing")
        seeds = range(self.first_seed, self.first_seed + self.episodes)
        return crossed(
            self.scenarios,
            seeds=seeds,
            robot=self.robot,
            settings=self.settings,
            vary=self.vary,
        )


def care(timeout_s: float, memory_gb: float, keep: int) -> Care:
    """Return how episodes are treated, by what the command line says.

    Raises:
        InputError: a limit is no number.
    """
    if math.isnan(timeout_s) or math.isnan(memory_gb):
        raise InputError("--timeout, --memory: found nan; must be a number")
    return Care(timeout_s, int(memory_gb * GIGABYTE), keep)


def sweep(
    asked: Asked,
    *,
    engine: str,
    workers: int | None,
    care: Care,
    out: Path | None,
    user_code: bool,
    as_json: bool,
) -> int:
    """Run a sweep, show its counts, and return the exit status.

    Args:
        asked: which episodes.
        engine: `local` or `ray`.
        workers: episodes at a time; None: as many as there are cores.
        care: limits, and what is kept.
        out: the folder.
        user_code: False: a scenario that names a Python class is refused.
        as_json: write the counts to standard output as JSON instead of a table.

    Raises:
        InputError: what was given is bad, or the folder cannot be taken.
        RecordingError: the folder cannot be written.
    """
    request = asked.request()
    if not user_code:
        request.refuse_user_code()
    announce(request.python())
    folder = sweep_folder(out, asked.name)
    with SweepProgress(len(request.keys())) as progress:
        try:
            made = _engine(engine, workers)
            document = conduct(
                request,
                folder,
                made,
                care=care,
                progress=progress,
                command=asked.command,
                told=write_message,
            )
        except KeyboardInterrupt:
            write_message(
                f"{progress.done} of {len(request.keys())} episodes are done; "
                f"the same command with --out {folder} goes on"
            )
            raise
    if as_json:
        shown = {key: value for key, value in document.items() if key != "episodes"}
        write_json({"folder": str(folder), **shown})
    else:
        show(document)
    write_message(f"results: {folder / 'results.json'}")
    return PASSED if document["passed"] else FAILED


def _engine(name: str, workers: int | None) -> Callable[[], Engine]:
    if name == "ray":
        from treadwell.sweeps.ray_engine import ray_engine

        return lambda: ray_engine(workers)
    return lambda: local_engine(workers or os.cpu_count() or 1)


def show(document: dict[str, Any]) -> None:
    """Write the counts as a table."""
    rows = []
    for line in document["summary"]:
        name = " ".join(filter(None, (line["scenario"], line["robot"], line["variant"])))
        outcomes = ", ".join(f"{count} {outcome}" for outcome, count in line["outcomes"].items())
        rows.append(
            (
                name,
                f"{line['successes']} of {line['episodes']}",
                outcomes,
                line["justified"],
                f"{line['solvable']} of {line['solvable_known']}",
                line["falls"],
                line["collisions"],
            )
        )
        if line["not_reproduced"]:
            write_message(f"not the same again: {', '.join(line['not_reproduced'])}")
    header = (
        "", "successes", "outcomes", "refused rightly", "solvable", "falls", "collisions",
    )  # fmt: skip
    write_table("Sweep", header, rows)
