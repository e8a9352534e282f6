"""Runs an experiment: every scenario with every seed, one after the other, and its report."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from treadwell import __version__
from treadwell.cli.progress import Progress
from treadwell.experiments.experiment import Experiment, Table
from treadwell.judging.result import Result, write_whole
from treadwell.recording.run_folder import make_experiment_folder
from treadwell.runner import run

SCHEMA: Final = "treadwell.experiment/1"


@dataclass(frozen=True, slots=True)
class Report:
    """What came of an experiment.

    Attributes:
        experiment: which.
        folder: where its runs and the tables lie.
        seeds: 0 to this, exclusive.
        runs: scenario, folder of the run and its result, in the order in which they were run.
        tables: the paper's figures with ours beside them.
        interrupted: whether it was, and some runs are missing.
    """

    experiment: Experiment
    folder: Path
    seeds: int
    runs: tuple[tuple[str, Path, Result], ...]
    tables: tuple[Table, ...]
    interrupted: bool

    @property
    def outcomes(self) -> set[str]:
        """The outcomes that there were."""
        return {result.outcome for _, _, result in self.runs}

    @property
    def passed(self) -> bool:
        """Whether there is every run, and each met its scenario's expectations."""
        return not self.interrupted and all(result.passed for _, _, result in self.runs)

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {
            "schema": SCHEMA,
            "experiment": self.experiment.name,
            "version": __version__,
            "folder": str(self.folder),
            "seeds": self.seeds,
            "interrupted": self.interrupted,
            "passed": self.passed,
            "runs": [
                {
                    "scenario": scenario,
                    "seed": result.seed,
                    "folder": folder.name,
                    "outcome": result.outcome,
                    "reason": result.reason,
                    "passed": result.passed,
                    "failures": result.failures,
                }
                for scenario, folder, result in self.runs
            ],
            "tables": [table.document() for table in self.tables],
        }

    def markdown(self) -> str:
        """Return it as Markdown."""
        head = f"# {self.experiment.description}\n\ntreadwell {__version__}, {self.seeds} seeds\n"
        return "\n".join([head, *(table.markdown() for table in self.tables)])


def conduct(
    experiment: Experiment,
    seeds: int,
    out: Path | None = None,
    progress: Callable[[str], Progress] = Progress,
) -> Report:
    """Run an experiment, write its folder, and return the report. After Ctrl-C: of what there is.

    Args:
        experiment: which.
        seeds: how many; 0 is the first.
        out: the folder; it must be new or empty.
        progress: makes what is told how a run gets on, from its title.

    Raises:
        InputError: the folder cannot be taken, or a scenario is bad.
        RecordingError: a run cannot be written.
    """
    folder = make_experiment_folder(out, experiment.name)
    jobs = [(scenario, seed) for scenario in experiment.scenarios for seed in range(seeds)]
    runs: list[tuple[str, Path, Result]] = []
    for number, (scenario, seed) in enumerate(jobs, start=1):
        title = f"{number} of {len(jobs)}: {Path(scenario).stem} seed {seed}"
        place = folder / f"{Path(scenario).stem}-{seed}"
        with progress(title) as shown:
            done = run(scenario, seed=seed, out=place, record=False, progress=shown)
        if done.outcome == "interrupted":
            break
        runs.append((scenario, place, done.result))
    results = {
        scenario: [result for name, _, result in runs if name == scenario]
        for scenario in experiment.scenarios
    }
    tables = tuple(experiment.tables(results))
    missing = len(runs) < len(jobs)
    report = Report(experiment, folder, seeds, tuple(runs), tables, interrupted=missing)
    write_whole(folder / "experiment.md", report.markdown())
    document = json.dumps(report.document(), indent=2, allow_nan=False)
    write_whole(folder / "experiment.json", document + "\n")
    return report
