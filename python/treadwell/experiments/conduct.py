"""Runs an experiment: every case with every seed, and its report."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

from treadwell.episode import Episode
from treadwell.experiments.drawn import write_scenario
from treadwell.experiments.experiment import Case, Experiment, Picture, Table
from treadwell.experiments.side_by_side import side_by_side
from treadwell.files import write_text
from treadwell.interruption import Interruption
from treadwell.progress import Progress
from treadwell.recording.run_folder import make_experiment_folder
from treadwell.runner import Run, run_episode
from treadwell.version import __version__

SCHEMA: Final = "treadwell.experiment/1"


@dataclass(frozen=True, slots=True)
class Job:
    """One run to do: a case, a seed, the scenario's name or file, its folder; with a recording?"""

    case: Case
    seed: int
    scenario: str
    folder: Path
    record: bool = False


@dataclass(frozen=True, slots=True)
class Report:
    """What came of an experiment.

    Attributes:
        experiment: which.
        folder: where its runs and the tables lie.
        seeds: that were asked for.
        runs: name of the case and the run, in the order in which they were to be done.
        tables: the paper's figures with ours beside them.
        pictures: of the same, in the folder.
        interrupted: whether it was, and some runs are missing.
    """

    experiment: Experiment
    folder: Path
    seeds: range
    runs: tuple[tuple[str, Run], ...]
    tables: tuple[Table, ...]
    pictures: tuple[Picture, ...]
    interrupted: bool

    @property
    def outcomes(self) -> set[str]:
        """The outcomes that there were."""
        return {done.outcome for _, done in self.runs}

    @property
    def passed(self) -> bool:
        """Whether there is every run, and each met its scenario's expectations."""
        return not self.interrupted and all(done.passed for _, done in self.runs)

    def document(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {
            "schema": SCHEMA,
            "experiment": self.experiment.name,
            "version": __version__,
            "folder": str(self.folder),
            "seeds": len(self.seeds),
            "first_seed": self.seeds.start,
            "interrupted": self.interrupted,
            "passed": self.passed,
            "runs": [
                {
                    "scenario": case,
                    "seed": done.result.seed,
                    "folder": done.folder.name,
                    "outcome": done.outcome,
                    "reason": done.result.reason,
                    "passed": done.passed,
                    "failures": done.result.failures,
                    "steps": [asdict(step) for step in done.steps if step.is_known()],
                }
                for case, done in self.runs
            ],
            "tables": [table.document() for table in self.tables],
            "pictures": [picture.path.name for picture in self.pictures],
        }

    def markdown(self) -> str:
        """Return it as Markdown."""
        extent = f"{len(self.seeds)} seeds from {self.seeds.start} on"
        head = f"# {self.experiment.description}\n\ntreadwell {__version__}, {extent}\n"
        tables = (table.markdown() for table in self.tables)
        return "\n".join([head, *tables, *(picture.markdown() for picture in self.pictures)])


def conduct(
    experiment: Experiment,
    seeds: range,
    out: Path | None = None,
    *,
    workers: int = 1,
    record: bool = False,
    progress: Callable[[str], AbstractContextManager[Progress]] | None = None,
) -> Report:
    """Run an experiment, write its folder, and return the report. After Ctrl-C: of what there is.

    Args:
        experiment: which.
        seeds: of each case; a case may ask for more or fewer, from the first on.
        out: the folder; it must be new or empty.
        workers: processes that run episodes at the same time; the results are the same.
        record: keep a recording of every run, not only where a case needs it.
        progress: makes what is told how a run gets on, from its title; for one worker. None: nobody
            is told.

    Raises:
        InputError: the folder cannot be taken, or a scenario is bad.
        RecordingError: a run cannot be written.
        SimulationError: a process that runs episodes died.
    """
    folder = make_experiment_folder(out, experiment.name)
    jobs = [
        replace(_job(case, seed, folder), record=record or case.afterwards is not None)
        for case in experiment.cases
        for seed in case.seeds(seeds)
    ]
    results = _one_by_one(jobs, progress) if workers == 1 else _side_by_side(jobs, workers)
    runs = tuple((job.case.name, done) for job, done in zip(jobs, results, strict=False))
    beside, whole = _beside(experiment, folder, workers, missing=len(runs) < len(jobs))
    with Interruption() as interruption:
        interruption.hold()  # hours of runs are not lost to a second Ctrl-C
        by_case = {
            case.name: [done for name, done in runs if name == case.name]
            for case in experiment.cases
        }
        tables = list(experiment.tables(by_case))
        pictures: list[Picture] = []
        if experiment.beside is not None and beside:
            tables += experiment.beside.tables(beside)
            pictures += experiment.beside.pictures(beside)
        pictures += experiment.pictures(by_case, folder)
        report = Report(
            experiment, folder, seeds, runs, tuple(tables), tuple(pictures), interrupted=not whole
        )
        write_text(folder / "experiment.md", report.markdown())
        document = json.dumps(report.document(), indent=2, allow_nan=False)
        write_text(folder / "experiment.json", document + "\n")
    return report


def _job(case: Case, seed: int, folder: Path) -> Job:
    """Return a run to do; a scenario that is drawn is written beside it first."""
    place = folder / f"{case.name}-{seed}"
    if isinstance(case.scenario, str):
        return Job(case, seed, case.scenario, place)
    for name, text in case.beside:
        write_text(folder / name, text)
    drawn = write_scenario(folder / f"{place.name}.toml", case.scenario(seed))
    return Job(case, seed, drawn, place)


def _done(job: Job, progress: Progress | None = None) -> Run:
    case = job.case
    episode = Episode(job.scenario, seed=job.seed, overrides=case.overrides)
    done = run_episode(
        episode, out=job.folder, record=job.record, progress=progress, watch=case.watch
    )
    whole = done.outcome not in {"interrupted", "error"}
    return case.afterwards(done) if case.afterwards is not None and whole else done


def _one_by_one(
    jobs: Sequence[Job], progress: Callable[[str], AbstractContextManager[Progress]] | None
) -> Iterator[Run]:
    """Do the runs one after the other, up to the one that is interrupted, or the pause after it."""
    for number, job in enumerate(jobs, start=1):
        title = _title(number, len(jobs), job)
        try:
            with nullcontext() if progress is None else progress(title) as shown:
                done = _done(job, shown)
        except KeyboardInterrupt:
            return
        if done.outcome == "interrupted":
            return
        yield done


def _side_by_side(jobs: Sequence[Job], workers: int) -> Iterator[Run]:
    """Do the runs in processes of their own, in the order of the jobs, up to an interruption."""

    def told(number: int, done: Run) -> str:
        title = _title(number + 1, len(jobs), jobs[number])
        return f"{title}: {done.outcome} {done.result.reason or ''}"

    yield from side_by_side(_done, jobs, workers, told)


def _beside(
    experiment: Experiment, folder: Path, workers: int, missing: bool
) -> tuple[list[Any], bool]:
    """Return what came of what is done beside the runs, and whether all of that was done.

    Args:
        experiment: whose.
        folder: its folder.
        workers: processes at a time.
        missing: whether the runs were interrupted: then nothing is begun.
    """
    beside = experiment.beside
    if beside is None or missing:
        return [], not missing
    items = beside.items(folder)

    def told(number: int, done: Any) -> str:  # noqa: ANN401 - as `Beside` has it
        return f"{number + 1} of {len(items)}: {beside.told(done)}"

    done = list(side_by_side(beside.work, items, workers, told, fresh=True))
    return done, len(done) == len(items)


def _title(number: int, of: int, job: Job) -> str:
    return f"{number} of {of}: {job.case.name} seed {job.seed}"
