"""A replay: the core over a run's observations, compared with what it answered then."""

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from treadwell._core import Pilot, Tick
from treadwell.core_settings import build_core, guards, user_components
from treadwell.errors import CoreError, InputError
from treadwell.guard import GuardedCore
from treadwell.interruption import Interruption
from treadwell.measuring.measures import timing
from treadwell.plugins import brought, class_names
from treadwell.progress import Progress
from treadwell.recording.core_products import known_occupied
from treadwell.recording.log_file import BrokenLogError
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.observation_log import read_answers, read_observations
from treadwell.recording.run_folder import make_folder_beside
from treadwell.replaying.difference import Answer, Difference, between_answers
from treadwell.replaying.findings import Findings
from treadwell.replaying.folder import write_folder
from treadwell.replaying.result import FirstDifference, ReplayFacts, ReplayResult
from treadwell.replaying.source import Source, open_source
from treadwell.scenario.overrides import Overrides, with_settings
from treadwell.summary import html_table, replay_line, replay_rows, replay_title
from treadwell.version import __version__


@dataclass(frozen=True, slots=True)
class Replay:
    """What came of a replay.

    Attributes:
        result: as in `result.json`.
        folder: where it was written.
        interrupted: whether it was ended by a signal.
    """

    result: ReplayResult
    folder: Path
    interrupted: bool = False

    @property
    def passed(self) -> bool:
        """Whether the core did what it was to: the same as then, where nothing was changed."""
        facts = self.result.replay
        answered = facts.broken is not None or facts.compared == facts.observations
        same = facts.changed or (facts.first_difference is None and answered)
        return same and facts.error is None and not self.interrupted

    def __repr__(self) -> str:
        return f"<Replay {replay_line(self.result.document())}; {self.folder}>"

    def _repr_html_(self) -> str:
        document = self.result.document()
        return html_table(replay_title(document), [*replay_rows(document), ("folder", self.folder)])


def replay(
    run_dir: str | Path,
    *,
    overrides: Overrides = (),
    out: str | Path | None = None,
    progress: Progress | None = None,
    user_code: bool = True,
    **components: object,
) -> Replay:
    """Run the core over a run's observations and write a folder: the same as `treadwell replay`.

    Args:
        run_dir: the run's folder.
        overrides: settings of `navigation`: `KEY=VALUE`, as `--set` takes them, or a mapping of
            keys to values.
        out: the folder; it must be new or empty. None: a new one beside the run's.
        progress: is told how it gets on.
        user_code: False: a run whose scenario names a Python class is refused.
        components: objects of the user's by slot, their classes, or names.

    Raises:
        InputError: anything that the user gave is bad; nothing was written.
        RecordingError: the folder cannot be written.
    """
    settings = with_settings(overrides, class_names(components))
    components = brought(components)
    source = open_source(Path(run_dir), settings, tuple(components))
    return replay_source(
        source, run_dir, out=out, progress=progress, user_code=user_code, **components
    )


def replay_source(
    source: Source,
    run_dir: str | Path,
    *,
    out: str | Path | None = None,
    progress: Progress | None = None,
    user_code: bool = True,
    **components: object,
) -> Replay:
    """Run the core over what `open_source` opened in `run_dir`; all else is as of `replay`."""
    given = user_components(source.scenario, dict(components), user_code=user_code)
    guarded = guards(source.scenario, given, set(components))
    given.update(guarded)
    pilot = build_core(source.scenario, source.core.settings, given, source.core.static_map)
    core = GuardedCore(pilot, guarded)
    folder = make_folder_beside(None if out is None else Path(out), Path(run_dir), "replay")
    found, begin, interrupted = Findings(), perf_counter(), False
    with Interruption() as interruption:
        try:
            _loop(source, core, found, progress, begin, interruption)
        except KeyboardInterrupt:
            interrupted, found.error = True, "interrupted: the replay was interrupted"
        except CoreError as error:
            found.error = f"error: {error} at tick {found.ticks}"
        except InputError:
            folder.rmdir()
            raise
        interruption.hold()
        found.end(source.path)
        wall = perf_counter() - begin
        result = _result(source, Path(run_dir), pilot, found, wall)
        write_folder(folder, source.scenario, result, found, known_occupied(pilot))
    return Replay(result, folder, interrupted)


def _loop(
    source: Source,
    core: GuardedCore,
    found: Findings,
    progress: Progress | None,
    begin: float,
    interruption: Interruption,
) -> None:
    """Hand every observation to the core, and compare its answers with the recorded ones."""
    answers, joints, pilot = _answers(source.path), source.joints, core.pilot
    goals = [goal["position"] for goal in json.loads(source.core.settings)["goals"]]
    try:
        for observation in read_observations(source.path):
            interruption.check()
            start = perf_counter()
            tick = core.tick(observation)
            found.core_seconds += perf_counter() - start
            recorded = next(answers, None)
            if recorded is not None:
                _compare(observation.time_ns, tick, recorded, joints, found)
            found.tick(observation, tick, pilot)
            if progress is not None and observation.depth is not None:
                simulated = 1e-9 * observation.time_ns
                factor = simulated / max(perf_counter() - begin, 1e-9)
                goal = goals[min(pilot.goals_passed, len(goals) - 1)]
                away = math.dist(goal, tick.estimate[:2])
                progress.update(simulated, tick.state, away, factor)
    except BrokenLogError as error:
        if not found.ticks:
            raise InputError(str(error)) from None
        seconds = found.ticks / 100
        found.broken = (
            f"{error}; replayed up to the cut, {found.ticks} observations ({seconds:.2f} s); the "
            f"last {error.lost_bytes} bytes of the file are lost"
        )
    if not found.ticks:
        raise InputError(f"{source.path}: holds not one observation")


def _answers(path: Path) -> Iterator[Answer]:
    try:
        yield from read_answers(path)
    except BrokenLogError:
        return  # the observations tell how far the file is whole


def _compare(
    now: int, tick: Tick, recorded: Answer, joints: Sequence[str], found: Findings
) -> None:
    found.compared += 1
    if found.difference is not None:
        return
    answer = (
        encode_command(now, tick.positions, tick.velocities, tick.torques),
        encode_estimate(now, tick.estimate, tick.odometry, tick.state, tick.outcome, tick.reason),
    )
    what = between_answers(answer, recorded, joints)
    if what is not None:
        found.difference = Difference(found.ticks, 1e-9 * now, what)


def _result(
    source: Source, run_dir: Path, pilot: Pilot, found: Findings, wall: float
) -> ReplayResult:
    difference = found.difference
    simulated = 0.0 if found.last is None else 1e-9 * found.last[0].time_ns + 0.01
    return ReplayResult(
        scenario=source.scenario.name,
        robot=source.header.get("robot", ""),
        seed=source.scenario.seed,
        version=__version__,
        configuration=source.scenario.configuration(),
        simulated_seconds=simulated,
        wall_seconds=wall,
        real_time_factor=simulated / max(wall, 1e-9),
        steps_taken=pilot.steps_taken,
        replans=pilot.replans,
        localization=found.errors.errors(),
        behaviour=found.states,
        timing_ms={stage: timing(values) for stage, values in found.seconds.items()},
        replay=ReplayFacts(
            run=str(run_dir),
            observations=found.ticks,
            compared=found.compared,
            changed=source.changed,
            broken=found.broken,
            declared=found.declared[0],
            reason=found.declared[1],
            error=found.error,
            core_seconds=found.core_seconds,
            first_difference=None
            if difference is None
            else FirstDifference(
                tick=difference.tick, time=difference.time_s, what=difference.what
            ),
        ),
    )
