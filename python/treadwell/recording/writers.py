"""What a run leaves behind: recording, observations, audit, trajectories, picture, result."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from treadwell.episode import Episode, Step
from treadwell.errors import InputError, RecordingError, TreadwellError
from treadwell.extras import install_hint
from treadwell.judging.result import Result
from treadwell.map_memory import RememberedMap
from treadwell.recording.core_products import known_occupied, known_surface
from treadwell.recording.file import NAME as RECORDING
from treadwell.recording.map_file import NAME as MAP
from treadwell.recording.map_file import PICTURE, write_map
from treadwell.recording.mesh_file import NAME as MESH
from treadwell.recording.mesh_file import write_mesh
from treadwell.recording.messages import encode_command, encode_estimate
from treadwell.recording.scenario_file import NAME as SCENARIO
from treadwell.recording.scenario_file import write_scenario
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.step_memory import StepMemory
from treadwell.recording.trajectory import ESTIMATE, TRUTH, Trajectory, turned
from treadwell.recording.writing_thread import WritingThread
from treadwell.trace import Trace

if TYPE_CHECKING:
    from treadwell.recording.log_writer import Entry
    from treadwell.recording.observation_log import ObservationLog
    from treadwell.recording.recorder import Recorder


_TICKS_A_JOB: Final = 16
"""Control ticks that are handed over for writing at a time."""
_TICKS_A_FLUSH: Final = 32
"""Control ticks, a third of a second, whose part of the audit may wait in memory."""


class Writers:
    """Everything that writes into a run's folder."""

    def __init__(
        self,
        folder: Path,
        episode: Episode,
        *,
        record: bool,
        viewer: Any = None,  # noqa: ANN401
    ) -> None:
        """Open what is written as it happens.

        Args:
            folder: new and empty.
            episode: before its first tick.
            record: whether to keep recording and observations.
            viewer: a window on the physics, from `open_viewer`.

        Raises:
            RecordingError: a file cannot be written.
        """
        self._folder = folder
        self._episode = episode
        self._recorder: Recorder | None = None
        self._observations: ObservationLog | None = None
        self._thread: WritingThread | None = None
        self._viewer = viewer
        self._ticks = 0
        self._place = _identity(folder)
        self._messages: list[Entry] = []
        self._frames: list[Trace] = []
        # First of all: the folder is then taken, and what was run is known however it ends.
        try:
            write_scenario(folder / SCENARIO, episode.scenario)
        except OSError as error:
            raise RecordingError(f"{folder}: cannot be written: {error.strerror}") from error
        episode.simulation.audit.keep_in(folder)
        if record:
            from treadwell.recording import observation_log
            from treadwell.recording import recorder as recording

            made = episode.scenario
            self._recorder = recording.Recorder(
                folder / RECORDING,
                episode.course.model,
                episode.course,
                made,
                episode.robot,
                episode.static_map,
            )
            self._observations = observation_log.ObservationLog(
                folder, made, episode.robot, episode.core_input
            )
            self._thread = WritingThread()

    @property
    def records(self) -> bool:
        """Whether there is a recording."""
        return self._recorder is not None

    def tick(self, step: Step) -> None:
        """Take in a control tick.

        Raises:
            RecordingError: a file does not take it any more.
        """
        self._ticks += 1
        if self._observations is not None:
            self._take(self._observations, step)
            if self._ticks % _TICKS_A_JOB == 0:
                self._hand_over()
        if self._ticks % _TICKS_A_FLUSH == 0:
            self._check_place()
            self._episode.simulation.audit.flush()
        if self._viewer is not None and step.observation.depth is not None:
            self._viewer.sync()

    def _take(self, log: "ObservationLog", step: Step) -> None:
        """Keep a tick's messages. They are made here: a part's arrays may be its own again soon."""
        now, command, belief = step.time_ns, step.command, step.estimate
        told = encode_command(now, command.position, command.velocity, command.torque)
        believed = encode_estimate(
            now, belief.pose, belief.odometry, step.state, step.outcome, step.reason
        )
        truth = self._episode.judge.frame
        stood_ns = self._episode.simulation.time_ns
        self._messages += log.observed(step.observation)
        self._messages += log.answered(now, told, believed)
        self._messages += log.stood(stood_ns, truth[:3], turned(truth[3]))

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame, which nobody changes afterwards."""
        if self._recorder is not None:
            self._frames.append(trace)

    def _hand_over(self) -> None:
        """Let the thread write what has come.

        Raises:
            RecordingError: a file does not take any more.
        """
        if self._thread is not None:
            messages, self._messages = self._messages, []
            frames, self._frames = self._frames, []
            self._thread.do(lambda: self._write(messages, frames))

    def _write(self, messages: list["Entry"], frames: list[Trace]) -> None:
        """Write messages and frames, each though the other fails."""
        assert self._observations is not None
        assert self._recorder is not None
        try:
            self._observations.append(messages)
            self._observations.flush()
        finally:
            for trace in frames:
                self._recorder.frame(trace)

    def finish(
        self,
        result: Result,
        estimate: Trajectory,
        truth: Trajectory,
        remembered: RememberedMap,
        feet: tuple[StairMemory, StepMemory],
        problem: TreadwellError | None = None,
    ) -> None:
        """Close what is open and write the rest, `result.json` last.

        Args:
            result: of the run.
            estimate: the believed way.
            truth: the true one.
            remembered: what the map last said of every cell.
            feet: what was known of stairs, and where footsteps were planned and taken.
            problem: what ended the run before its time; it is raised in the end.

        Raises:
            TreadwellError: the problem.
            RecordingError: something could not be written; everything else was.
        """
        folder, episode = self._folder, self._episode
        jobs: list[Callable[[], None]] = [
            self._close,
            self._check_place,
            lambda: estimate.write(folder / ESTIMATE),
            lambda: truth.write(folder / TRUTH),
            lambda: episode.simulation.save_audit(folder),
            lambda: self._draw(result, estimate, truth, remembered, feet),
            lambda: write_map(folder / MAP, remembered, known_occupied(episode.pilot)),
            self._write_mesh,
            lambda: result.write(folder / "result.json"),
        ]
        first: Exception | None = None
        for job in jobs:
            try:
                job()
            except _MovedError as error:
                problem = error  # whatever else went wrong came of it
                break
            except (OSError, RecordingError) as error:
                first = first or error
        if problem is not None:
            raise problem
        if first is not None:
            raise RecordingError(f"{folder}: not everything could be written: {first}") from first

    def _write_mesh(self) -> None:
        surface = known_surface(self._episode.pilot)
        if surface is not None:
            write_mesh(self._folder / MESH, surface)

    def _draw(
        self,
        result: Result,
        estimate: Trajectory,
        truth: Trajectory,
        remembered: RememberedMap,
        feet: tuple[StairMemory, StepMemory],
    ) -> None:
        # Late, because matplotlib takes half a second to import.
        from treadwell.recording.map_picture import caption_of, draw_map

        course, path = self._episode.course, self._folder / PICTURE
        stairs, footsteps = feet
        sole = self._episode.robot.file.legs.left.sole
        soles = (footsteps, (sole.length, sole.width))
        draw_map(path, course, caption_of(result), remembered, estimate, truth, stairs, soles)

    def _check_place(self) -> None:
        """Find out whether the folder is still where it was.

        Raises:
            RecordingError: it is not.
        """
        if _identity(self._folder) != self._place:
            raise _MovedError(
                f"{self._folder}: was removed or renamed while the run wrote into it; what was "
                "written until then is where the folder is now"
            )

    def _close(self) -> None:
        if self._viewer is not None:
            self._viewer.close()
        with ExitStack() as closing:
            # The last is the first to be done, and each is though one before it fails.
            if self._recorder is not None:
                closing.callback(self._recorder.close)
            if self._observations is not None:
                closing.callback(self._observations.close)
            if self._thread is not None:
                closing.callback(self._thread.close)
                closing.callback(self._hand_over)


class _MovedError(RecordingError):
    """The folder of the run is no longer there."""


def _identity(folder: Path) -> tuple[int, int] | None:
    """Return what tells a folder from another of its name; None where there is none."""
    try:
        found = folder.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


class NoWriters:
    """Takes what `Writers` takes of an episode on its way, and writes nothing."""

    records: Final = False

    def tick(self, step: Step) -> None:
        """Take in a control tick."""

    def frame(self, trace: Trace) -> None:
        """Take in a camera frame."""


def open_viewer(episode: Episode) -> Any:  # noqa: ANN401 - MuJoCo's viewer has no types
    """Return a window on the physics.

    Raises:
        InputError: the viewer is not installed, or there is no display.
    """
    try:
        from mujoco import viewer

        return viewer.launch_passive(episode.course.model, episode.simulation.data)
    except Exception as error:
        raise InputError(
            f"--view: no window can be opened ({error}); it needs a display and "
            f"the extra `view`: {install_hint('view')}"
        ) from error
