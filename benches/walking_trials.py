"""Walks without camera and map: how often does the robot fall, and how far does it get?

    python benches/walking_trials.py straight --trials 200 --workers 2
    python benches/walking_trials.py push_sideways --impulse 1.5 --trials 100 --first-seed 5000
    python benches/walking_trials.py climb_up climb_down --rise 0.05 --x-error 0.01 --trials 40

Every seed draws friction (0.6 to 1.0), masses (all off by up to 10 %, each link by 3 % more),
encoder offsets, the IMU's biases, and the task's own numbers; every noise is on. A trial is lost
when the torso tilts by more than 0.8 rad or anything but a sole touches the ground. Climbing, the
footsteps are placed by the true course, seen wrong by as much as the options say; they count from
where leg odometry has the robot, and are given for one stand after the other.
"""

import argparse
import json
import math
import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import mujoco
import numpy as np
from climbing import Climber, Errors, Footstep, Tread, alternating, course, elements, pairs, seen
from numpy.typing import NDArray

from treadwell._core import Walker
from treadwell.course.build import build_course
from treadwell.physics.motors import JointTargets
from treadwell.physics.simulation import Simulation, Start
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import load_robot
from treadwell.scenario.model import Scenario
from treadwell.senses.sensors import Sensors

TICK_S = 0.01
PUSH_S = 0.1
STARTS_S = 0.5
WALKING_MPS = 0.1
CLIMBS_S = 2.0
SETTLES_S = 0.5
STAIR_S = 4.5
"""Longest time for one stand on the stairs; a climb that takes longer is over."""

Motion = tuple[float, float, float] | list[Footstep] | None


@dataclass(frozen=True)
class Plan:
    """What one trial does: motions from given times on, pushes (time s, impulse N s), an end."""

    motions: list[tuple[float, Motion]]
    end_s: float
    pushes: list[tuple[float, tuple[float, float]]] = field(default_factory=list)
    climber: Climber | None = None


@dataclass(frozen=True)
class Job:
    """One trial."""

    task: str
    seed: int
    robot: str
    impulse: float
    minutes: float
    gait: dict[str, float]
    rise: float
    tread: float
    steps: int
    errors: Errors
    pushed: float


@dataclass(frozen=True)
class Trial:
    """How one trial went; true position and heading at its end."""

    seed: int
    fell_s: float | None
    stands: bool
    steps: int
    x: float
    y: float
    turned: float
    odometry_error_m: float
    odometry_error_rad: float
    feet_touched: bool
    pushes: list[tuple[float, tuple[float, float]]]
    misstep: str | None
    stands_missed: int
    seconds_per_stand: float
    ground_error_m: float


def straight(_rng: np.random.Generator, _job: Job) -> Plan:
    return Plan([(STARTS_S, (WALKING_MPS, 0.0, 0.0)), (STARTS_S + 20.5, None)], 23.0)


def backward(_rng: np.random.Generator, _job: Job) -> Plan:
    return Plan([(STARTS_S, (-0.08, 0.0, 0.0)), (STARTS_S + 12.5, None)], 15.0)


def turn(rng: np.random.Generator, _job: Job) -> Plan:
    """Turn on the spot for as long as 90 degrees take at 0.25 rad/s."""
    rate = 0.25 * rng.choice([-1.0, 1.0])
    return Plan([(STARTS_S, (0.0, 0.0, rate)), (STARTS_S + math.pi / 2 / 0.25, None)], 10.0)


def side(rng: np.random.Generator, _job: Job) -> Plan:
    speed = 0.1 * rng.choice([-1.0, 1.0])
    return Plan([(STARTS_S, (0.0, speed, 0.0)), (STARTS_S + 8.0, None)], 11.0)


def stop(rng: np.random.Generator, _job: Job) -> Plan:
    """Walk any way and stop at any phase of a step."""
    walk = (rng.uniform(-0.08, 0.12), rng.uniform(-0.1, 0.1), rng.uniform(-0.4, 0.4))
    until = rng.uniform(1.5, 4.0)
    return Plan([(STARTS_S, walk), (until, None)], until + 4.0)


def push(rng: np.random.Generator, job: Job, direction: float) -> Plan:
    at = rng.uniform(3.0, 4.2)
    impulse = (job.impulse * math.cos(direction), job.impulse * math.sin(direction))
    walk = (WALKING_MPS, 0.0, 0.0)
    return Plan([(STARTS_S, walk), (at + 4.0, None)], at + 7.0, [(at, impulse)])


def push_any(rng: np.random.Generator, job: Job) -> Plan:
    return push(rng, job, rng.uniform(-math.pi, math.pi))


def push_sagittal(rng: np.random.Generator, job: Job) -> Plan:
    return push(rng, job, rng.choice([0.0, math.pi]))


def push_sideways(rng: np.random.Generator, job: Job) -> Plan:
    return push(rng, job, rng.choice([-0.5, 0.5]) * math.pi)


def push_standing(rng: np.random.Generator, job: Job) -> Plan:
    direction = rng.uniform(-math.pi, math.pi)
    impulse = (job.impulse * math.cos(direction), job.impulse * math.sin(direction))
    return Plan([], 5.0, [(1.5, impulse)])


def wander(rng: np.random.Generator, job: Job) -> Plan:
    """Random commands and a push every two to five seconds."""
    end = 60.0 * job.minutes
    motions: list[tuple[float, Motion]] = []
    at = STARTS_S
    while at < end - 3.0:
        x, y, yaw = rng.uniform(-0.08, 0.12), rng.uniform(-0.1, 0.1), rng.uniform(-0.5, 0.5)
        kinds: list[Motion] = [
            (x, y, yaw),
            (x, 0.0, 0.0),
            (0.0, 0.0, yaw),
            (abs(x), 0.0, yaw),
            None,
        ]
        motions.append((at, kinds[rng.integers(len(kinds))]))
        at += rng.uniform(0.3, 5.0)
    motions.append((end - 3.0, None))
    pushes = []
    at = rng.uniform(2.0, 5.0)
    while at < end - 3.0:
        direction = rng.uniform(-math.pi, math.pi)
        pushes.append((at, (job.impulse * math.cos(direction), job.impulse * math.sin(direction))))
        at += rng.uniform(2.0, 5.0)
    return Plan(motions, end, pushes)


def stair(_rng: np.random.Generator, job: Job, sign: float) -> list[Tread]:
    return course([sign * job.rise] * job.steps, [job.tread] * (job.steps - 1))


def climb_up(rng: np.random.Generator, job: Job) -> list[Tread]:
    return stair(rng, job, 1.0)


def climb_down(rng: np.random.Generator, job: Job) -> list[Tread]:
    return stair(rng, job, -1.0)


def sill(_rng: np.random.Generator, _job: Job) -> list[Tread]:
    return course([0.038, -0.038], [0.09])


def basin(_rng: np.random.Generator, _job: Job) -> list[Tread]:
    return course([-0.03, 0.03], [0.13])


def random_stairs(rng: np.random.Generator, job: Job) -> list[Tread]:
    """Up or down, whichever the seed says."""
    sign = rng.choice([-1.0, 1.0])
    rises = sign * rng.uniform(0.02, 0.05, job.steps)
    return course(list(rises), list(rng.uniform(0.11, 0.2, job.steps - 1)))


COURSES: dict[str, Callable[[np.random.Generator, Job], list[Tread]]] = {
    "climb_up": climb_up,
    "climb_down": climb_down,
    "sill": sill,
    "basin": basin,
    "random_stairs": random_stairs,
    "continuous_up": climb_up,
    "continuous_down": climb_down,
}


def climb(rng: np.random.Generator, job: Job, treads: list[Tread]) -> Plan:
    """Climb the course, and stand for a second."""
    believed = seen(treads, job.errors, rng)
    lists = (alternating if job.task.startswith("continuous") else pairs)(believed)
    end = CLIMBS_S + STAIR_S * (sum(map(len, lists)) + 1)
    pushes, at = [], CLIMBS_S + rng.uniform(0.0, 4.0)
    while job.pushed > 0.0 and at < end:
        direction = rng.uniform(-math.pi, math.pi)
        pushes.append((at, (job.pushed * math.cos(direction), job.pushed * math.sin(direction))))
        at += rng.uniform(2.0, 4.0)
    return Plan([], end, pushes, Climber(lists, SETTLES_S, CLIMBS_S))


TASKS: dict[str, Callable[[np.random.Generator, Job], Plan]] = {
    "straight": straight,
    "backward": backward,
    "turn": turn,
    "side": side,
    "stop": stop,
    "push_any": push_any,
    "push_sagittal": push_sagittal,
    "push_sideways": push_sideways,
    "push_standing": push_standing,
    "wander": wander,
}


class World:
    """A robot with random errors on level ground or before stairs."""

    def __init__(self, job: Job) -> None:
        streams = RandomStreams(job.seed)
        rng = streams("trial")
        self.treads = COURSES[job.task](streams("course"), job) if job.task in COURSES else []
        scenario = Scenario.model_validate(
            {
                "schema": 1,
                "name": "walking-trial",
                "robot": job.robot,
                "seed": job.seed,
                "start": {"position": [0.0, 0.0]},
                "goal": {"position": [50.0, 0.0]},
                "course": elements(self.treads),
                "physics": {
                    "friction": float(rng.uniform(0.6, 1.0)),
                    "mass_scale": float(rng.uniform(0.9, 1.1)),
                },
            }
        )
        robot = load_robot(job.robot)
        built = build_course(scenario, robot)
        model, self.start_height = built.model, built.start.height
        scale = rng.uniform(0.97, 1.03, model.nbody)
        model.body_mass *= scale
        model.body_inertia *= scale[:, None]
        mujoco.mj_setConst(model, mujoco.MjData(model))
        self.simulation = Simulation(model, robot, Start(height=self.start_height))
        self.sensors = Sensors(model, robot, scenario.sensors, streams)
        self.sensors.blind(2**62)
        self.simulation.motors.encoder_offsets = self.sensors.encoder_offsets
        description = robot.description()
        description["gait"] = {**description["gait"], **job.gait}
        self.walker = Walker(json.dumps(description))
        self.torso = model.body(robot.file.body.torso).id
        self.soles = [
            model.body(leg.sole.link).id for leg in (robot.file.legs.left, robot.file.legs.right)
        ]
        self.foot_height = -robot.file.legs.left.sole.position[2]
        self.rng = rng

    def tick(self, motion: Motion) -> None:
        simulation = self.simulation
        observation = self.sensors.observe(simulation.data, simulation.time_ns, simulation.motors)
        simulation.advance(JointTargets(*self.walker.step(observation, motion, 0.0, 0.6)))

    def push(self, force: tuple[float, float]) -> None:
        self.simulation.data.xfrc_applied[self.torso, :2] = force

    def has_fallen(self) -> bool:
        data, model = self.simulation.data, self.simulation.model
        if data.xmat[self.torso][8] < math.cos(0.8):
            return True
        bodies = model.geom_bodyid[data.contact.geom]
        parts = bodies[self._is_robot(bodies).sum(axis=1) == 1]
        return not np.isin(parts[self._is_robot(parts)], self.soles).all()

    def feet_touch(self) -> bool:
        bodies = self.simulation.model.geom_bodyid[self.simulation.data.contact.geom]
        return bool(self._is_robot(bodies).all(axis=1).any())

    def _is_robot(self, bodies: NDArray[np.int32]) -> NDArray[np.bool_]:
        root = self.simulation.model.body_rootid
        return np.asarray(root[bodies] == root[self.torso])

    def ground(self) -> float:
        """Height of the lower sole above the start's ground, m."""
        data = self.simulation.data
        feet = data.xpos[self.soles, 2].min()
        return float(feet) - self.foot_height - self.start_height

    def ground_pose(self) -> tuple[float, float, float]:
        """Middle of the soles and mean heading of the feet."""
        data = self.simulation.data
        x, y = data.xpos[self.soles, :2].mean(axis=0)
        forward = data.xmat[self.soles].reshape(2, 3, 3)[:, :, 0].sum(axis=0)
        return float(x), float(y), math.atan2(forward[1], forward[0])


def run(job: Job) -> Trial:
    """Run one trial."""
    world = World(job)
    plan = climb(world.rng, job, world.treads) if world.treads else TASKS[job.task](world.rng, job)
    climber = plan.climber
    fell, touched, turned, heading = None, False, 0.0, 0.0
    for index in range(round(plan.end_s / TICK_S)):
        now = index * TICK_S
        motion = next((then for at, then in reversed(plan.motions) if at <= now), None)
        if climber:
            motion = climber.motion(now, world.walker, world.start_height)
            if climber.is_over(now):
                break
        force = next(
            ((x / PUSH_S, y / PUSH_S) for at, (x, y) in plan.pushes if at <= now < at + PUSH_S),
            (0.0, 0.0),
        )
        world.push(force)
        world.tick(motion)
        touched = touched or world.feet_touch()
        yaw = world.ground_pose()[2]
        turned += math.remainder(yaw - heading, math.tau)
        heading = yaw
        if world.has_fallen():
            fell = now
            break
    x, y, yaw = world.ground_pose()
    by_x, by_y, by_yaw = world.walker.odometry
    return Trial(
        seed=job.seed,
        fell_s=fell,
        stands=world.walker.standing,
        steps=world.walker.steps_taken,
        x=x,
        y=y,
        turned=turned,
        odometry_error_m=math.hypot(by_x - x, by_y - y),
        odometry_error_rad=abs(math.remainder(by_yaw - yaw, math.tau)),
        feet_touched=touched,
        pushes=plan.pushes if len(plan.pushes) == 1 else [],
        misstep=climber.misstep if climber else None,
        stands_missed=len(climber.lists) - climber.done if climber else 0,
        seconds_per_stand=climber.seconds_per_stand() if climber else math.nan,
        ground_error_m=world.walker.ground - world.ground(),
    )


def summary(task: str, trials: list[Trial]) -> dict[str, object]:
    """What a table's row and the JSON say."""
    upright = [trial for trial in trials if trial.fell_s is None]

    def spread(values: list[float]) -> list[float]:
        return [round(float(f(values)), 4) if values else math.nan for f in (np.mean, np.std)]

    return {
        "task": task,
        "trials": len(trials),
        "falls": len(trials) - len(upright),
        "fallen_seeds": [trial.seed for trial in trials if trial.fell_s is not None],
        "not_standing_at_end": [trial.seed for trial in upright if not trial.stands],
        "legs_touched_each_other": [trial.seed for trial in upright if trial.feet_touched],
        "steps": sum(trial.steps for trial in trials),
        "x": spread([trial.x for trial in upright]),
        "abs_y": spread([abs(trial.y) for trial in upright]),
        "abs_turned": spread([abs(trial.turned) for trial in upright]),
        "odometry_error_m": spread([trial.odometry_error_m for trial in upright]),
        "odometry_error_rad": spread([trial.odometry_error_rad for trial in upright]),
        "ground_error_m": spread([trial.ground_error_m for trial in upright]),
        "missteps": {trial.seed: trial.misstep for trial in trials if trial.misstep},
        "not_all_climbed": [trial.seed for trial in upright if trial.stands_missed],
        "seconds_per_stand": spread([trial.seconds_per_stand for trial in upright]),
    }


def main() -> int:
    """Run the trials of a task and print what came out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("task", nargs="+", choices=[*TASKS, *COURSES])
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--robot", default="qrio")
    parser.add_argument("--impulse", type=float, default=0.5, help="of a push, N s")
    parser.add_argument("--minutes", type=float, default=3.0, help="of wandering")
    parser.add_argument("--rise", type=float, default=0.03, help="of each stair, m")
    parser.add_argument("--tread", type=float, default=0.12, help="of each stair, m")
    parser.add_argument("--steps", type=int, default=4, help="of the stairs")
    parser.add_argument("--height-error", type=float, default=0.0, help="of each level, m")
    parser.add_argument("--x-error", type=float, default=0.0, help="of each edge, m")
    parser.add_argument("--pushed", type=float, default=0.0, help="every 2 to 4 s on stairs, N s")
    parser.add_argument("--gait", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--json", type=Path, help="file for all trials")
    arguments = parser.parse_args()
    gait = {key: float(value) for key, value in (item.split("=") for item in arguments.gait)}
    first = Job(
        task="",
        seed=0,
        robot=arguments.robot,
        impulse=arguments.impulse,
        minutes=arguments.minutes,
        gait=gait,
        rise=arguments.rise,
        tread=arguments.tread,
        steps=arguments.steps,
        errors=Errors(arguments.height_error, arguments.x_error),
        pushed=arguments.pushed,
    )
    results = []
    for task in arguments.task:
        begin = time.perf_counter()
        seeds = range(arguments.first_seed, arguments.first_seed + arguments.trials)
        jobs = [replace(first, task=task, seed=seed) for seed in seeds]
        with ProcessPoolExecutor(arguments.workers) as pool:
            trials = list(pool.map(run, jobs, chunksize=2))
        result = summary(task, trials) | {
            "first_seed": arguments.first_seed,
            "impulse": arguments.impulse,
            "wall_s": round(time.perf_counter() - begin, 1),
        }
        json.dump(result, sys.stdout)
        print(flush=True)
        results.append(result | {"each": [asdict(trial) for trial in trials]})
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
