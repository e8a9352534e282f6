"""A replay: the core over a run's observations, compared with what it answered then."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

from treadwell._core import Pilot, Tick
from treadwell.core_settings import build_core, guards, user_components
from treadwell.errors import CoreError, InputError, RecordingError
from treadwell.guard import Guard, blamed
from treadwell.interruption import Interruption
from treadwell.judging.result import LocalizationErrors, StateEntry
from treadwell.measuring.measures import PoseErrors, timing
from treadwell.observation import Floats, Observation
from treadwell.poses import pose_matrix, rotation_of
from treadwell.progress import Progress
from treadwell.recording.log_file import BrokenLogError
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.observation_log import read_answers, read_observations, read_truth
from treadwell.recording.run_folder import make_folder_beside
from treadwell.recording.trajectory import ESTIMATE, Trajectory
from treadwell.replaying.difference import Answer, Difference, between_answers
from treadwell.replaying.result import FirstDifference, ReplayFacts, ReplayResult
from treadwell.replaying.source import Source, open_source
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


@dataclass
class _Findings:
    """What is collected on the way; poses as (tick, estimate, odometry) of camera frames."""

    seconds: dict[str, list[float]] = field(
        default_factory=lambda: {name: [] for name in Pilot.stages}
    )
    states: list[StateEntry] = field(default_factory=list)
    frames: list[tuple[int, int, Floats, Floats]] = field(default_factory=list)
    last: tuple[Observation, Tick] | None = None
    ticks: int = 0
    compared: int = 0
    difference: Difference | None = None
    declared: tuple[str | None, str | None] = (None, None)
    broken: str | None = None
    error: str | None = None
    core_seconds: float = 0.0

    def tick(self, observation: Observation, tick: Tick, pilot: Pilot) -> None:
        """Take in a tick."""
        now = observation.time_ns
        for name, seconds in zip(Pilot.stages, pilot.timing, strict=True):
            if not math.isnan(seconds):
                self.seconds[name].append(seconds)
        if not self.states or self.states[-1].state != tick.state:
            self.states.append(StateEntry(time=1e-9 * now, state=tick.state))
        if self.declared[0] is None and tick.outcome is not None:
            self.declared = (tick.outcome, tick.reason)
        if observation.depth is not None or now == 0:
            self._frame(now, tick)
        self.last = (observation, tick)
        self.ticks += 1

    def end(self) -> None:
        """Add the last tick to the poses, as a run does."""
        if self.last is not None:
            observation, tick = self.last
            if self.frames[-1:] == [] or self.frames[-1][0] != self.ticks - 1:
                self.ticks -= 1
                self._frame(observation.time_ns, tick)
                self.ticks += 1

    def _frame(self, time_ns: int, tick: Tick) -> None:
        poses = pose_matrix(*tick.estimate), pose_matrix(*tick.odometry)
        self.frames.append((self.ticks, time_ns, *poses))


def replay(
    run_dir: str | Path,
    *,
    overrides: Sequence[str] = (),
    out: Path | None = None,
    progress: Progress | None = None,
    user_code: bool = True,
    **components: object,
) -> Replay:
    """Run the core over a run's observations and write a folder: the same as `treadwell replay`.

    Args:
        run_dir: the run's folder.
        overrides: settings `KEY=VALUE` of `navigation`, as `--set` takes them.
        out: the folder; it must be new or empty. None: a new one beside the run's.
        progress: is told how it gets on.
        user_code: False: a run whose scenario names a Python class is refused.
        components: objects of the user's by slot, as in `planner=MyPlanner()`.

    Raises:
        InputError: anything that the user gave is bad; nothing was written.
        RecordingError: the folder cannot be written.
    """
    source = open_source(Path(run_dir), tuple(overrides), tuple(components))
    return replay_source(
        source, run_dir, out=out, progress=progress, user_code=user_code, **components
    )


def replay_source(
    source: Source,
    run_dir: str | Path,
    *,
    out: Path | None = None,
    progress: Progress | None = None,
    user_code: bool = True,
    **components: object,
) -> Replay:
    """Run the core over what `open_source` opened in `run_dir`; all else is as of `replay`."""
    given = user_components(source.scenario, dict(components), user_code=user_code)
    guarded = guards(source.scenario, given, set(components))
    given.update(guarded)
    pilot = build_core(source.scenario, source.core.settings, given, source.core.static_map)
    core = _GuardedCore(pilot, guarded)
    folder = make_folder_beside(out, Path(run_dir), "replay")
    found, begin, interrupted = _Findings(), perf_counter(), False
    try:
        with Interruption() as interruption:
            _loop(source, core, found, progress, begin, interruption)
    except KeyboardInterrupt:
        interrupted, found.error = True, "interrupted: the replay was interrupted"
    except CoreError as error:
        found.error = f"error: {error} at tick {found.ticks}"
    except InputError:
        folder.rmdir()
        raise
    found.end()
    wall = perf_counter() - begin
    result = _result(source, Path(run_dir), pilot, found, wall)
    trajectory = Trajectory()
    for _, time_ns, estimate, _ in found.frames:
        trajectory.add(time_ns, estimate)
    try:
        trajectory.write(folder / ESTIMATE)
        result.write(folder / "result.json")
    except OSError as error:
        raise RecordingError(f"{folder}: cannot be written: {error.strerror}") from error
    return Replay(result, folder, interrupted)


@dataclass(frozen=True, slots=True)
class _GuardedCore:
    """The core, and what stands between it and the user's components."""

    pilot: Pilot
    guards: dict[str, Guard]

    def tick(self, observation: Observation) -> Tick:
        """Return the core's answer; an error has the name of the component that is its cause."""
        try:
            return self.pilot.tick(observation)
        except CoreError as error:
            raise blamed(error, self.guards) from error


def _loop(
    source: Source,
    core: _GuardedCore,
    found: _Findings,
    progress: Progress | None,
    begin: float,
    interruption: Interruption,
) -> None:
    """Hand every observation to the core, and compare its answers with the recorded ones."""
    answers, joints, pilot = _answers(source.path), source.joints, core.pilot
    goals = [*source.scenario.goal.via, source.scenario.goal.position]
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
    now: int, tick: Tick, recorded: Answer, joints: Sequence[str], found: _Findings
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


def _localization(source: Source, found: _Findings) -> LocalizationErrors | None:
    """Return the errors against the recorded truth, read only now that the core has ended."""
    errors = PoseErrors()
    wanted = {tick: (estimate, odometry) for tick, _, estimate, odometry in found.frames}
    try:
        for tick, row in enumerate(read_truth(source.path)):
            if tick in wanted:
                truth = pose_matrix(row[0], row[1], row[2], 0.0)
                truth[:3, :3] = rotation_of(row[3:])
                errors.add(*wanted[tick], truth)
    except BrokenLogError:
        pass  # told with the observations
    return errors.errors()


def _result(
    source: Source, run_dir: Path, pilot: Pilot, found: _Findings, wall: float
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
        localization=_localization(source, found),
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
