"""What the walking trials ask of the robot: motions on level ground, courses of stairs, pushes."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from climbing import (
    LISTED,
    Climber,
    Errors,
    Footstep,
    Sizes,
    Tread,
    alternating,
    course,
    level_steps,
    pairs,
    seen,
    sizes_of,
)

STARTS_S = 0.5
WALKING_MPS = 0.1
CLIMBS_S = 2.0
SETTLES_S = 0.5
PLATE_M = 6.0
"""Length and width of a plate."""
SLOPE_M = 0.7
SLOPE_WIDTH_M = 2.0
"""Length, seen from above, and width of a slope."""
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

    def at(self, sizes: Sizes) -> "Plan":
        """Return the same at a robot's size: times and speeds by its pace; impulses as told."""
        pace = sizes.pace

        def sized(motion: Motion) -> Motion:
            if isinstance(motion, tuple):
                x, y, turn = motion
                return (x * pace, y * pace, turn / pace)
            return motion

        return replace(
            self,
            motions=[(at * pace, sized(motion)) for at, motion in self.motions],
            end_s=self.end_s * pace,
            pushes=[(at * pace, impulse) for at, impulse in self.pushes],
        )


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
    slope: float
    told: bool = False
    head_kg: float = 0.0

    @property
    def sizes(self) -> Sizes:
        """What goes by the robot's size."""
        return sizes_of(self.robot)


def straight(_rng: np.random.Generator, _job: Job) -> Plan:
    return Plan([(STARTS_S, (WALKING_MPS, 0.0, 0.0)), (STARTS_S + 20.5, None)], 23.0)


def across(_rng: np.random.Generator, _job: Job) -> Plan:
    """Walk on until the edge is behind the robot."""
    return Plan([(STARTS_S, (WALKING_MPS, 0.0, 0.0)), (STARTS_S + 11.0, None)], 14.0)


def over(_rng: np.random.Generator, _job: Job) -> Plan:
    """Walk on until the slope is behind the robot."""
    return Plan([(STARTS_S, (WALKING_MPS, 0.0, 0.0)), (STARTS_S + 15.0, None)], 18.0)


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


def listed(rng: np.random.Generator, job: Job) -> Plan:
    return Plan([(STARTS_S, level_steps(rng, job.sizes))], STARTS_S + 1.3 * LISTED + 2.0)


def listed_stop(rng: np.random.Generator, job: Job) -> Plan:
    """Take a list and stop at any phase of a step."""
    until = rng.uniform(1.0, 7.0)
    return Plan([(STARTS_S, level_steps(rng, job.sizes)), (until, None)], until + 4.0)


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
    return course([sign * job.rise] * job.steps, [job.tread] * (job.steps - 1), job.sizes)


def climb_up(rng: np.random.Generator, job: Job) -> list[Tread]:
    return stair(rng, job, 1.0)


def climb_down(rng: np.random.Generator, job: Job) -> list[Tread]:
    return stair(rng, job, -1.0)


def sill(_rng: np.random.Generator, job: Job) -> list[Tread]:
    scale = job.sizes.scale
    return course([0.038 * scale, -0.038 * scale], [0.09 * scale], job.sizes)


def basin(_rng: np.random.Generator, job: Job) -> list[Tread]:
    scale = job.sizes.scale
    return course([-0.03 * scale, 0.03 * scale], [0.13 * scale], job.sizes)


def random_stairs(rng: np.random.Generator, job: Job) -> list[Tread]:
    """Up or down, whichever the seed says."""
    sign = rng.choice([-1.0, 1.0])
    scale = job.sizes.scale
    rises = sign * scale * rng.uniform(0.02, 0.05, job.steps)
    return course(list(rises), list(scale * rng.uniform(0.11, 0.2, job.steps - 1)), job.sizes)


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
    in_turn = job.task.startswith("continuous")
    lists = (alternating if in_turn else pairs)(believed, job.sizes)
    end = CLIMBS_S + STAIR_S * (sum(map(len, lists)) + 1)
    pushes, at = [], CLIMBS_S + rng.uniform(0.0, 4.0)
    while job.pushed > 0.0 and at < end:
        direction = rng.uniform(-math.pi, math.pi)
        pushes.append((at, (job.pushed * math.cos(direction), job.pushed * math.sin(direction))))
        at += rng.uniform(2.0, 4.0)
    pace = job.sizes.pace
    return Plan([], end, pushes, Climber(lists, SETTLES_S * pace, CLIMBS_S * pace))


def edge(rng: np.random.Generator, job: Job) -> list[dict[str, object]]:
    """A plate of one rise, its edge at any angle across the way onto it or off it."""
    angle, ahead = rng.uniform(-math.pi / 3, math.pi / 3), rng.uniform(0.3, 0.7)
    half = PLATE_M / 2 if job.task == "edge_up" else -PLATE_M / 2
    return [
        {
            "kind": "platform",
            "name": "plate",
            "position": [ahead + half * math.cos(angle), half * math.sin(angle)],
            "yaw": angle,
            "size": [PLATE_M, PLATE_M, job.rise],
        }
    ]


def slope(rng: np.random.Generator, job: Job) -> list[dict[str, object]]:
    """A slope up to a platform, or from the one that the robot stands on down to the floor."""
    ahead, rise = rng.uniform(0.3, 0.5), SLOPE_M * math.tan(math.radians(job.slope))
    up = job.task == "slope_up"
    middle = ahead + SLOPE_M + PLATE_M / 2 if up else ahead - PLATE_M / 2
    return [
        {
            "kind": "platform",
            "name": "top",
            "position": [middle, 0.0],
            "size": [PLATE_M, SLOPE_WIDTH_M, rise],
        },
        {
            "kind": "ramp",
            "name": "slope",
            "position": [ahead if up else ahead + SLOPE_M, 0.0],
            "yaw": 0.0 if up else math.pi,
            "length": SLOPE_M,
            "width": SLOPE_WIDTH_M,
            "rise": rise,
        },
    ]


def told(
    course: list[dict[str, object]], job: Job, rng: np.random.Generator
) -> tuple[float, float, float]:
    """Where the slope begins and ends, and its rise per metre, as wrong as a map may have it."""
    middle = cast(list[float], course[0]["position"])[0]
    top = middle + (-0.5 if job.task == "slope_up" else 0.5) * PLATE_M
    begin = top - SLOPE_M if job.task == "slope_up" else top
    off, tilt = rng.uniform(-job.errors.x, job.errors.x), rng.normal(0.0, math.radians(0.7))
    rise = math.tan(math.radians(job.slope) + tilt) * (1.0 if job.task == "slope_up" else -1.0)
    return begin + off, begin + SLOPE_M + off, rise


EDGES: dict[str, Callable[[np.random.Generator, Job], list[dict[str, object]]]] = {
    "edge_up": edge,
    "edge_down": edge,
    "slope_up": slope,
    "slope_down": slope,
}

TASKS: dict[str, Callable[[np.random.Generator, Job], Plan]] = {
    "straight": straight,
    "backward": backward,
    "turn": turn,
    "side": side,
    "stop": stop,
    "listed": listed,
    "listed_stop": listed_stop,
    "push_any": push_any,
    "push_sagittal": push_sagittal,
    "push_sideways": push_sideways,
    "push_standing": push_standing,
    "wander": wander,
    "slope_up": over,
    "slope_down": over,
    "edge_up": across,
    "edge_down": across,
}
