"""A whole run: one episode from start to verdict, and everything that is written of it."""

import math
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from treadwell.episode import Episode
from treadwell.errors import CoreError, InputError, ShellLimitError, SimulationError, TreadwellError
from treadwell.interruption import Interruption
from treadwell.judging.result import Result
from treadwell.judging.verdict import Verdict
from treadwell.map_memory import RememberedMap
from treadwell.measuring.clearance import least_clearance
from treadwell.measuring.step_watch import KnownTop, StepError
from treadwell.measuring.watch import Watch
from treadwell.physics.simulation import TICK_NS
from treadwell.progress import Progress
from treadwell.recording.rhythm import Rhythm
from treadwell.recording.run_folder import run_folder
from treadwell.recording.tracing import trace_of
from treadwell.recording.trajectory import jumps
from treadwell.recording.writers import NoWriters, Writers, open_viewer
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import Overrides
from treadwell.scenario.values import flag
from treadwell.scores import Scores, result_of
from treadwell.shell_limits import RECORDED_RUN, tightness
from treadwell.summary import html_table, result_line, result_rows, result_title


@dataclass(frozen=True, slots=True)
class Run:
    """What came of a run.

    Attributes:
        result: as in `result.json`.
        folder: where everything lies.
        least_clearance: m, room between the robot's cylinder and what stood on its way, as far as
            it went on its feet; None where nothing did.
        steps: what was known of each step before it was climbed.
        tops: the surfaces of steps that the robot knew in the end.
        remembered: what the map last said of every cell.
        findings: of the watch that was asked for; None without one.
    """

    result: Result
    folder: Path
    least_clearance: float | None = None
    steps: tuple[StepError, ...] = ()
    tops: tuple[KnownTop, ...] = ()
    remembered: RememberedMap | None = None
    findings: Any = None

    @property
    def outcome(self) -> str:
        """How it ended."""
        return self.result.outcome

    @property
    def reason(self) -> str | None:
        """Why it ended so, where there is a reason."""
        return self.result.reason

    @property
    def passed(self) -> bool:
        """Whether it met the scenario's expectations."""
        return self.result.passed

    @property
    def document(self) -> dict[str, Any]:
        """The result as plain data, as in the file."""
        return self.result.document()

    def __repr__(self) -> str:
        return f"<Run {result_line(self.document)}; {self.folder}>"

    def _repr_html_(self) -> str:
        document = self.document
        rows = [*result_rows(document), ("folder", self.folder)]
        return html_table(result_title(document), rows)


def run(  # noqa: PLR0913 - one an option
    scenario: str | Path | Scenario,
    *,
    robot: str | Path | None = None,
    seed: int | None = None,
    overrides: Overrides = (),
    out: str | Path | None = None,
    record: bool = True,
    view: bool = False,
    progress: Progress | None = None,
    user_code: bool = True,
    **components: object,
) -> Run:
    """Run one episode and write its folder: the same as `treadwell run`.

    Args:
        scenario: a name, a path, or a scenario that is already loaded.
        robot: its name or folder, instead of the scenario's.
        seed: instead of the scenario's; one seed gives one result on one kind of processor.
        overrides: settings `KEY=VALUE`, as `--set` takes them; or a mapping, as in
            `{"navigation.fog.cell": 0.05}` or `{"navigation": {"fog": {"cell": 0.05}}}`.
        out: the folder; it must be new or empty.
        record: False leaves out the recording and the observations.
        view: show the physics in a window; needs the extra `view`.
        progress: is told how the run gets on.
        user_code: False: a scenario that names a Python class is refused.
        components: the part for a slot: a name as a scenario has it, as in `planner="voronoi"`; a
            class of yours, as in `planner=MyPlanner`, of which an object is made with the
            scenario's `[navigation.MyPlanner]` for its parameters; or an object. What each must
            have: `treadwell.protocols`.

    Raises:
        InputError: anything that the user gave is bad; nothing was written.
        RecordingError: the recording cannot be written; what was written stays readable.
    """
    episode = Episode(
        scenario,
        robot=robot,
        seed=seed,
        overrides=overrides,
        user_code=user_code,
        **components,
    )
    return run_episode(episode, out=out, record=record, view=view, progress=progress)


def run_episode(
    episode: Episode,
    *,
    out: str | Path | None = None,
    record: bool = True,
    view: bool = False,
    progress: Progress | None = None,
    watch: type[Watch] | None = None,
) -> Run:
    """Run an episode that has not begun, and write its folder.

    Args:
        episode: made, not yet stepped.
        out: the folder; it must be new or empty.
        record: False leaves out the recording and the observations.
        view: show the physics in a window; needs the extra `view`.
        progress: is told how the run gets on.
        watch: looks at every camera frame; what it found is the run's `findings`.

    Raises:
        InputError: the folder cannot be taken; nothing was written.
        RecordingError: the recording cannot be written; what was written stays readable.
        ShellLimitError: the shell allows too little memory for a recording.
    """
    made = episode.scenario
    record, view = flag("record", record), flag("view", view)
    if record and (tight := tightness(RECORDED_RUN)):
        raise ShellLimitError(f"the run cannot be recorded: {tight}; --no-record takes a third")
    viewer = open_viewer(episode) if view else None
    scores = Scores(episode, watch)
    with Interruption() as interruption:
        with run_folder(_place(out), made.name, episode.robot.name, made.seed) as folder:
            writers = Writers(folder, episode, record=record, viewer=viewer)
        result, problem = _played(episode, scores, writers, progress, interruption)
        remembered = scores.memory.map()
        ways = (scores.estimate, scores.truth)
        feet = (scores.stairs, scores.footsteps)
        writers.finish(result, *ways, remembered, feet, problem)
    # No robot walks farther than a sole is long between two frames: it was carried.
    carried = jumps(scores.truth.rows, episode.robot.file.legs.left.sole.length)
    walked = np.split(scores.truth.positions(), carried)
    clearance = least_clearance(episode.course, episode.robot, walked)
    findings = None if scores.watch is None else scores.watch.findings()
    return Run(
        result,
        folder,
        clearance,
        tuple(scores.steps.steps),
        scores.steps.tops,
        scores.memory.map(),
        findings,
    )


def _place(out: str | Path | None) -> Path | None:
    try:
        return None if out is None else Path(out)
    except TypeError:
        raise InputError(f"out: found {out!r}; must be the path of a folder") from None


def play_episode(episode: Episode) -> Result:
    """Run an episode that has not begun, and write nothing: the same result in less time.

    Raises:
        TreadwellError: what is neither the physics' nor a component's failure.
    """
    episode.simulation.audit.drop()
    with Interruption() as interruption:
        result, problem = _played(episode, Scores(episode), NoWriters(), None, interruption)
    if problem is not None:
        raise problem
    return result


def _played(
    episode: Episode,
    scores: Scores,
    writers: Writers | NoWriters,
    progress: Progress | None,
    interruption: Interruption,
) -> tuple[Result, TreadwellError | None]:
    """Run an episode to its end; return the result and what kept it from being written.

    From then on no signal cuts short what follows.
    """
    begin = perf_counter()
    verdict: Verdict | None = None
    problem: TreadwellError | None = None
    try:
        _loop(episode, scores, writers, progress, begin, interruption)
        verdict = episode.verdict
    except KeyboardInterrupt:
        verdict = Verdict("interrupted", "interrupted: the run was interrupted")
    except (CoreError, SimulationError) as error:
        time_ns = episode.simulation.time_ns
        when = f"at tick {time_ns // TICK_NS} ({1e-9 * time_ns:.2f} s)"
        verdict = Verdict("error", f"error: {error} {when}")
    except TreadwellError as error:
        verdict = Verdict("error", f"error: {error}")
        problem = error
    interruption.hold()
    assert verdict is not None
    return result_of(episode, scores, verdict, perf_counter() - begin), problem


def _loop(
    episode: Episode,
    scores: Scores,
    writers: Writers | NoWriters,
    progress: Progress | None,
    begin: float,
    interruption: Interruption,
) -> None:
    """Go on until there is a verdict."""
    pictures, rhythm = writers.records or scores.watch is not None, Rhythm()
    while episode.verdict is None:
        interruption.check()
        step = episode.tick()
        scores.tick(step)
        if step.observation.depth is not None or step.time_ns == 0 or episode.verdict is not None:
            scores.frame(step)
            if pictures:
                trace = trace_of(episode, step, rhythm)
                if scores.watch is not None:
                    scores.watch.frame(trace)
                writers.frame(trace)
            if progress is not None:
                simulated = 1e-9 * step.time_ns
                factor = simulated / max(perf_counter() - begin, 1e-9)
                away = math.dist(episode.goal, step.estimate.pose[:2])
                progress.update(simulated, step.state, away, factor)
        writers.tick(step)
