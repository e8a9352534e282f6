"""One episode: observe, tick, act, advance, judge. What is written of it: `run.py`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Final

from treadwell._core import Octree, Pilot
from treadwell.core_settings import (
    CoreInput,
    build_core,
    core_settings,
    guards,
    told_map,
    user_components,
)
from treadwell.course.build import build_course
from treadwell.course.events import Events
from treadwell.errors import CoreError
from treadwell.guard import blamed
from treadwell.judging.judge import Judge
from treadwell.judging.truth_localizer import TruthLocalizer
from treadwell.judging.verdict import Referee, Verdict
from treadwell.observation import Observation
from treadwell.physics.motors import LateTargets, strengths
from treadwell.physics.simulation import TICK_NS, Simulation, Start
from treadwell.plugins import brought, class_names, class_path
from treadwell.protocols import Footstep, JointTargets, Pose
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import load_robot
from treadwell.scenario.faults import Fault
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import Overrides, with_settings
from treadwell.scenario.scaling import size_of, to_robot
from treadwell.scenario.unread import warn_of_unread
from treadwell.senses.sensors import Sensors
from treadwell.stage_times import StageTimes

FOOTSTEP_STAGES: Final = ("footsteps_first", "footsteps_best")
"""What is timed of a plan of footsteps: until a first one is found, and until the best is."""


@dataclass(frozen=True, slots=True, repr=False)
class Estimate:
    """What the robot believes.

    Attributes:
        pose: (x m, y m, z m, yaw rad) of the robot's frame in the map.
        odometry: the same by leg odometry alone.
        lost: whether it knows that it does not know where it is; `pose` then means little.
    """

    pose: Pose
    odometry: Pose
    lost: bool = False

    def __repr__(self) -> str:
        (x, y, z, yaw), lost = self.pose, ", lost" if self.lost else ""
        return f"<Estimate at ({x:.2f}, {y:.2f}, {z:.2f}) m, {yaw:.2f} rad{lost}>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Step:
    """What happened at a control tick.

    Attributes:
        time_ns: nanoseconds since the start.
        observation: what the robot was told.
        estimate: what it believes.
        command: what it told its motors.
        state: name of the behaviour's state.
        footsteps: steps that its feet are told to take, in the robot's frame as it was
            when they were listed first; empty while it walks or stands.
        outcome: what it declares: `goal_reached`, `refused` or None.
        reason: why it refuses.
    """

    time_ns: int
    observation: Observation
    estimate: Estimate
    command: JointTargets
    state: str
    footsteps: tuple[Footstep, ...] = ()
    outcome: str | None = None
    reason: str | None = None

    def __repr__(self) -> str:
        x, y, z, yaw = self.estimate.pose
        parts = [self.state, f"believes ({x:.2f}, {y:.2f}, {z:.2f}) m, {yaw:.2f} rad"]
        parts += ["a depth image"] if self.observation.depth is not None else []
        parts += [said for said in (self.outcome, self.reason) if said]
        return f"<Step at {1e-9 * self.time_ns:.2f} s: {', '.join(parts)}>"


class Episode:
    """A robot on a course, ready to go.

    Iterating goes on from one camera frame to the next until the episode is over; `tick` goes on
    by one control tick of 10 ms.

    Attributes:
        scenario: as it is run, with overrides and draws applied, and fitted to the robot.
        robot, course, simulation, sensors, events, judge, referee: the parts of the harness.
        pilot: the core.
        guards: slot -> what stands between the core and a component of the user's.
        core_input: what the core was made of.
        ablation: whether anything in the core was given the truth.
        verdict: how it ended, None while it goes on.
        times: how long each stage took.
    """

    def __init__(
        self,
        scenario: str | Path | Scenario,
        *,
        robot: str | Path | None = None,
        seed: int | None = None,
        overrides: Overrides = (),
        user_code: bool = True,
        **components: object,
    ) -> None:
        """Build everything.

        Args:
            scenario: a name, a path, or a scenario that is already loaded.
            robot: its name or folder, instead of the scenario's.
            seed: instead of the scenario's.
            overrides: settings `KEY=VALUE`, as `--set` takes them, or a mapping of keys to values.
            user_code: False: a scenario that names a Python class is refused.
            components: objects of the user's by slot, their classes, as in `planner=MyPlanner`, or
                names as a scenario has them, as in `planner="voronoi"`.

        Raises:
            InputError: anything that the user gave is bad.
        """
        if not isinstance(scenario, Scenario):
            settings = with_settings(overrides, class_names(components))
            components = brought(components)
            scenario = load_scenario(scenario, robot=robot, seed=seed, overrides=settings)
            warn_of_unread(scenario, components)
        self.robot = load_robot(scenario.robot)
        self.scenario = scenario = to_robot(scenario, self.robot)
        self.course = build_course(scenario, self.robot)
        place, ideal = self.course.start, scenario.sensors.encoders == "ideal"
        start = Start(*place.position, yaw=place.yaw, height=place.height)
        self.simulation = Simulation(self.course.model, self.robot, start, play=not ideal)
        self.sensors = Sensors(
            self.course.model,
            self.robot,
            scenario.sensors,
            RandomStreams(scenario.seed),
            self.course.texture,
        )
        self.simulation.motors.encoder_offsets = self.sensors.encoder_offsets
        self.events = Events(scenario, self.course, self.robot)
        self._broken: list[Fault] = []
        self._late = LateTargets()
        self.judge = Judge(self.course.model, self.course, scenario, self.robot)
        self.referee = Referee(self.judge, scenario.time_limit, size_of(self.robot).patience)
        self.verdict: Verdict | None = None
        self.times = StageTimes(("physics", "depth", *FOOTSTEP_STAGES), Pilot.stages)
        self._plans = 0
        paths = {slot: class_path(component) for slot, component in components.items()}
        given = user_components(scenario, dict(components), user_code=user_code)
        self.guards = guards(scenario, given, set(components))
        given.update(self.guards)
        self.ablation = scenario.navigation.localizer == "truth" and "localizer" not in given
        if self.ablation:
            given["localizer"] = TruthLocalizer(self.judge, self.simulation.data)
        told = core_settings(scenario, self.robot, self.course)
        static_map = told_map(scenario, self.robot, self.course)
        self.core_input = CoreInput(told, self.robot.file.navigation, static_map, paths)
        self.pilot = build_core(scenario, told, given, static_map)

    def __repr__(self) -> str:
        title = f"{self.scenario.name} with {self.robot.name}, seed {self.scenario.seed}"
        end = "" if self.verdict is None else f", {self.verdict.outcome}"
        return f"<Episode {title}, {1e-9 * self.simulation.time_ns:.2f} s{end}>"

    def tick(self) -> Step:
        """Go on by one control tick.

        Raises:
            CoreError: a stage of the core or a component of the user's failed.
            SimulationError: the physics diverged.
        """
        simulation, times = self.simulation, self.times
        data = simulation.data
        time_ns = simulation.time_ns
        begin = perf_counter()
        observation = self.sensors.observe(data, time_ns, simulation.motors)
        if observation.depth is not None:
            times.add("depth", perf_counter() - begin)
        try:
            tick = self.pilot.tick(observation)
        except CoreError as error:
            named = blamed(error, self.guards)
            raise named from named.__cause__
        times.add_row(self.pilot.timing)
        self._time_footsteps()
        command = JointTargets(tick.positions, tick.velocities, tick.torques)
        outcome, reason, footsteps = tick.outcome, tick.reason, tick.footsteps
        if self.course.events:
            self.events.before_tick(simulation)
            if self.events.carried:
                self.judge.begin_elsewhere()
            self._tell_senses(time_ns)
        told = self._told(command, time_ns) if self.course.events else command
        begin = perf_counter()
        simulation.advance(told)
        times.add("physics", perf_counter() - begin)
        now = 1e-9 * simulation.time_ns
        self.judge.watch(data, now)
        self.verdict = self.referee.decide(data, now, outcome, reason)
        return Step(
            time_ns,
            observation,
            Estimate(tick.estimate, tick.odometry, tick.lost),
            command,
            tick.state,
            tuple([Footstep(*listed) for listed in footsteps]) if footsteps else (),
            outcome,
            reason,
        )

    def _time_footsteps(self) -> None:
        """Note how long a plan of footsteps took, where there is a new one."""
        planned = self.pilot.footstep_times
        if planned is not None and planned[0] != self._plans:
            self._plans = planned[0]
            for stage, seconds in zip(FOOTSTEP_STAGES, planned[1:], strict=True):
                self.times.add(stage, seconds)

    @property
    def seconds(self) -> dict[str, Sequence[float]]:
        """Stage -> seconds that it took, one a tick at which it ran; of footsteps, one a plan."""
        times = self.times.seconds().items()
        return {name: took for name, took in times if len(took) or name not in FOOTSTEP_STAGES}

    @property
    def static_map(self) -> Octree | None:
        """What the core was told of the course; None where nothing in it asks for one."""
        return self.core_input.static_map

    @property
    def goal(self) -> tuple[float, float]:
        """The place that is pursued now, (x, y) m."""
        places = (*self.scenario.goal.via, self.scenario.goal.position)
        return places[min(self.pilot.goals_passed, len(places) - 1)]

    def _tell_senses(self, time_ns: int) -> None:
        """Let the senses suffer, from the next tick on, what events did to them."""
        if self.events.encoder_offsets:
            self.sensors.set_encoder_shifts(self.events.encoder_offsets)
        if self.events.is_blind(1e-9 * (time_ns + TICK_NS)):
            self.sensors.blind(time_ns + TICK_NS + 1)
        for knock in self.events.knocks:
            self.sensors.knock(knock.roll, knock.pitch, knock.yaw)
        self.events.knocks.clear()
        broken = self.events.broken(1e-9 * time_ns)
        if broken == self._broken:
            return
        self._broken = broken
        self.sensors.set_faults(broken)
        joints = {name: i for i, name in enumerate(self.robot.joints)}
        weak = [(f.joint or "all", f.value or 0.0) for f in broken if f.part == "motors"]
        self.simulation.motors.weaken(strengths(joints, weak))

    def _told(self, command: JointTargets, time_ns: int) -> JointTargets:
        """Return what reaches the motors of what they are told."""
        late = [f.value or 0.0 for f in self._broken if (f.part, f.kind) == ("latency", "motors")]
        return self._late.told(command, time_ns, max(late, default=0.0))

    def __iter__(self) -> Iterator[Step]:
        """Yield the ticks at which a depth frame arrives, until the episode is over."""
        while self.verdict is None:
            step = self.tick()
            if step.observation.depth is not None:
                yield step
