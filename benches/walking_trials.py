"""Walks without camera and map: how often does the robot fall, and how far does it get?

    python benches/walking_trials.py straight --trials 200 --workers 2
    python benches/walking_trials.py push_sideways --impulse 1.5 --trials 100 --first-seed 5000
    python benches/walking_trials.py climb_up climb_down --rise 0.05 --x-error 0.01 --trials 40
    python benches/walking_trials.py wander --robot nao --impulse 0 --head-weight 0.25

Every seed draws friction (0.6 to 1.0), masses (all off by up to 10 %, each link by 3 % more),
encoder offsets, the IMU's biases, and the task's own numbers; every noise is on. A trial is lost
when the torso tilts by more than 0.8 rad or anything but a sole touches the ground. Climbing, the
footsteps are placed by the true course, seen wrong by as much as the options say; they count from
where leg odometry has the robot, and are given for one stand after the other. Speeds and times
go by the robot's size; rises, treads and impulses are what the options say.
"""

import argparse
import json
import math
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import mujoco
import numpy as np
from climbing import Errors
from into_results import add_options, write
from numpy.typing import NDArray
from walking_tasks import COURSES, EDGES, TASKS, Job, Motion, climb, told

from treadwell._core import Walker
from treadwell.course.build import build_course
from treadwell.observation import Observation
from treadwell.physics.simulation import Simulation, Start
from treadwell.protocols import JointTargets
from treadwell.random_streams import RandomStreams
from treadwell.robot.load import load_robot
from treadwell.scenario.model import Scenario
from treadwell.senses.sensors import Sensors
from treadwell.trials.stairs import elements

TICK_S = 0.01
PUSH_S = 0.1


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


class World:
    """A robot with random errors on level ground or before stairs."""

    def __init__(self, job: Job) -> None:
        streams = RandomStreams(job.seed)
        rng = streams("trial")
        self.treads = COURSES[job.task](streams("course"), job) if job.task in COURSES else []
        course = elements(self.treads, job.sizes.scale)
        if job.task in EDGES:
            course = EDGES[job.task](streams("course"), job)
        scenario = Scenario.model_validate(
            {
                "schema": 1,
                "name": "walking-trial",
                "robot": job.robot,
                "seed": job.seed,
                "start": {"position": [0.0, 0.0]},
                "goal": {"position": [50.0, 0.0]},
                "course": course,
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
        # Where the head's own mass is; the controller does not know of it.
        model.body_mass[model.cam_bodyid[model.camera(robot.file.camera.name).id]] += job.head_kg
        mujoco.mj_setConst(model, mujoco.MjData(model))
        self.simulation = Simulation(model, robot, Start(height=self.start_height))
        self.sensors = Sensors(model, robot, scenario.sensors, streams)
        self.sensors.blind(2**62)
        self.simulation.motors.encoder_offsets = self.sensors.encoder_offsets
        description = robot.description()
        for key, value in job.gait.items():
            *tables, last = key.split(".")
            table = description["gait"]
            for name in tables:
                table = table.setdefault(name, {})
            table[last] = value
        self.walker = Walker(json.dumps(description))
        if job.told:
            self.walker.slope = told(course, job, streams("told"))
        self.torso = model.body(robot.file.body.torso).id
        self.soles = [
            model.body(leg.sole.link).id for leg in (robot.file.legs.left, robot.file.legs.right)
        ]
        self.foot_height = -robot.file.legs.left.sole.position[2]
        self.rng = rng

    def tick(self, motion: Motion) -> Observation:
        simulation = self.simulation
        observation = self.sensors.observe(simulation.data, simulation.time_ns, simulation.motors)
        simulation.advance(JointTargets(*self.walker.step(observation, motion, 0.0, 0.6)))
        return observation

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


def first_job(robot: str, task: str, seed: int) -> Job:
    """Return a trial with nothing out of the ordinary."""
    return Job(
        task=task,
        seed=seed,
        robot=robot,
        impulse=0.0,
        minutes=0.0,
        gait={},
        rise=0.03,
        tread=0.12,
        steps=4,
        errors=Errors(0.0, 0.0),
        pushed=0.0,
        slope=0.0,
    )


def run(job: Job) -> Trial:
    """Run one trial."""
    world = World(job)
    plan = climb(world.rng, job, world.treads) if world.treads else TASKS[job.task](world.rng, job)
    plan = plan.at(job.sizes)
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


def results_row(result: dict[str, object]) -> dict[str, object]:
    """Return the row of a task in docs/results."""
    measured = {"falls": f"{result['falls']} of {result['trials']}", "steps": str(result["steps"])}
    return {"what": f"`{result['task']}`", "measured": measured}


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
    parser.add_argument("--slope", type=float, default=5.0, help="degrees")
    parser.add_argument("--told", action="store_true", help="where the slope is")
    parser.add_argument("--head-weight", type=float, default=0.0, help="more on the head, kg")
    parser.add_argument("--gait", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--json", type=Path, help="file for all trials")
    add_options(parser)
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
        slope=arguments.slope,
        told=arguments.told,
        head_kg=arguments.head_weight,
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
    write(
        arguments,
        f"Falls: {', '.join(arguments.task)}",
        range(arguments.first_seed, arguments.first_seed + arguments.trials),
        [results_row(result) for result in results],
    )
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
