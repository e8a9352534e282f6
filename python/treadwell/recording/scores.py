"""What the result says of an episode, collected while it runs."""

from treadwell.episode import Episode, Step
from treadwell.judging.result import StateEntry
from treadwell.map_memory import MapMemory
from treadwell.measuring.measures import PoseErrors
from treadwell.measuring.step_watch import StepWatch
from treadwell.measuring.watch import Watch
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.tracing import stairs_of
from treadwell.recording.trajectory import Trajectory


class Scores:
    """Collects what the result says of an episode, one camera frame after the other."""

    def __init__(self, episode: Episode, watch: type[Watch] | None = None) -> None:
        """Begin with nothing."""
        self._episode = episode
        self.steps = StepWatch(episode)
        self.watch = None if watch is None else watch(episode)
        self.poses = PoseErrors()
        self.estimate, self.truth = Trajectory(), Trajectory()
        self.memory = MapMemory()
        self.stairs = StairMemory()
        self.states: list[StateEntry] = []
        self._state: str | None = None

    def tick(self, step: Step) -> None:
        """Take in a control tick."""
        self.steps.tick(step)
        if step.state != self._state:
            self._state = step.state
            self.states.append(StateEntry(time=1e-9 * step.time_ns, state=step.state))

    def frame(self, step: Step) -> None:
        """Take in a camera frame, right after its tick."""
        pilot, believed, truth = self._episode.pilot, step.estimate, self._episode.judge.frame
        self.poses.add_level(believed.pose, believed.odometry, truth)
        self.estimate.add_level(step.time_ns, believed.pose)
        self.truth.add_level(step.time_ns, truth)
        self.stairs.update(stairs_of(pilot), climbing=bool(step.footsteps))
        self.memory.update(*pilot.floor())
