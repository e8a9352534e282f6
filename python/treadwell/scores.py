"""What a run's result says of an episode: collected on its way, put together at its end."""

from treadwell.episode import Episode, Step
from treadwell.footstep_plan import FootstepPlan, plan_of
from treadwell.judging.result import CollisionEntry, Result, StateEntry
from treadwell.judging.verdict import Verdict
from treadwell.map_memory import MapMemory
from treadwell.measuring.measures import PoseErrors, timing
from treadwell.measuring.score import map_counts, surfaces, true_cells
from treadwell.measuring.step_watch import StepWatch
from treadwell.measuring.watch import Watch
from treadwell.processor import processor
from treadwell.recording.core_products import stairs_of
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.step_memory import StepMemory
from treadwell.recording.steppable import step_limits
from treadwell.recording.trajectory import Trajectory
from treadwell.version import __version__


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
        self.stairs = StairMemory(step_limits(episode.scenario, episode.robot))
        self.footsteps = StepMemory()
        self._plan: FootstepPlan | None = None
        self._plans = 0
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
        pilot, believed, truth = self._episode.pilot, step.estimate, self._episode.judge.observed
        self.poses.add_level(believed.pose, believed.odometry, truth)
        if believed.lost:
            self.poses.add_lost()
        self.estimate.add_level(step.time_ns, believed.pose)
        self.truth.add_level(step.time_ns, truth)
        forgotten = pilot.maps_forgotten
        stairs = stairs_of(pilot)
        self.stairs.update(
            stairs, climbing=bool(step.footsteps), lost=believed.lost, forgotten=forgotten
        )
        self._footsteps(step)
        self.memory.update(*pilot.floor(), forgotten=forgotten)

    def _footsteps(self, step: Step) -> None:
        pilot, judge = self._episode.pilot, self._episode.judge
        if pilot.footstep_times is not None and pilot.footstep_times[0] != self._plans:
            self._plans = pilot.footstep_times[0]
            found = pilot.planned_footsteps()
            self._plan = None if found is None else plan_of(found)
            if self._plan is not None:
                self.footsteps.plan(self._plan, taken=bool(step.footsteps))
        self.footsteps.frame(
            self._plan,
            1e-9 * step.time_ns,
            landed=pilot.stepping.landed,
            listed=bool(step.footsteps),
            soles=judge.soles,
            touch=(judge.touch.left, judge.touch.right),
        )

    @property
    def plans_footsteps(self) -> bool:
        """Whether the behaviour plans footsteps."""
        return self._episode.pilot.footstep_times is not None


def result_of(episode: Episode, scores: Scores, verdict: Verdict, wall_seconds: float) -> Result:
    """Return what came of an episode, judged by its scenario's expectations."""
    judge, course, made = episode.judge, episode.course, episode.scenario
    simulated = 1e-9 * episode.simulation.time_ns
    remembered = scores.memory.map()
    places = {
        element.name: episode.events.place(element, episode.simulation.data)
        for element in course.elements
        if element.name in episode.events.present
    }
    passed = scores.truth.positions()[:, :2]
    headroom = episode.robot.file.body.height
    seen = remembered.kind.size > 0
    seconds = episode.seconds
    physics = sum(seconds["physics"])
    result = Result(
        scenario=made.name,
        robot=episode.robot.name,
        seed=made.seed,
        version=__version__,
        processor=processor(),
        configuration=made.configuration(),
        scale=course.scale,
        ablation=episode.ablation,
        outcome=verdict.outcome,
        reason=verdict.reason,
        simulated_seconds=simulated,
        wall_seconds=wall_seconds,
        real_time_factor=simulated / max(wall_seconds, 1e-9),
        physics_real_time_factor=simulated / max(physics, 1e-9),
        falls=judge.falls,
        collisions=[
            CollisionEntry(
                time=hit.time,
                robot_part=hit.robot_part,
                element=hit.element,
                impulse=hit.impulse,
                **({} if hit.encounter is None else hit.encounter._asdict()),
            )
            for hit in judge.collisions
        ],
        steps_taken=episode.pilot.steps_taken,
        footsteps_planned=scores.footsteps.landed if scores.plans_footsteps else None,
        footsteps_refused=scores.footsteps.refused,
        footstep_plans=scores.footsteps.plans,
        stairs_climbed=judge.stairs_climbed,
        stairs_descended=judge.stairs_descended,
        path_length=judge.path_length,
        replans=episode.pilot.replans,
        localization=scores.poses.errors(),
        surfaces=surfaces(course, remembered, passed, places) if seen else [],
        behaviour=scores.states,
        timing_ms={stage: timing(values) for stage, values in seconds.items()},
    )
    if seen:
        result.map = map_counts(
            remembered, true_cells(episode.events.course_now(), remembered, headroom, places)
        )
    return result.judged_by(made.expect)
