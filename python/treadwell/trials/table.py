"""The table at the end of `robot check --walk`: what a robot does, and why it does no more."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from treadwell.errors import InputError
from treadwell.robot.load import Robot, load_folder
from treadwell.trials.stairs import Climber, elements, levels
from treadwell.trials.world import PUSH_S, TICK_S, Motion, Size, World

WALKING_MPS: Final = 0.1
SIDEWAYS_MPS: Final = 0.05
TURNING_RADPS: Final = 0.25
STARTS_S: Final = 0.5
WALKS_S: Final = 8.0
"""How long a motion lasts at a scale of 1."""
ENDS_S: Final = 2.5
"""How long the robot stands after it."""
PUSHES_MPS: Final = (0.1, 0.2, 0.3)
"""Impulses over the robot's mass; by the root of the scale."""
PUSHED_AT_S: Final = 3.3
DIRECTIONS: Final = {
    "from behind": 0.0,
    "to the left": 0.5,
    "from ahead": 1.0,
    "to the right": -0.5,
}
"""Where pushes go, in half turns from ahead."""
RISES: Final = (0.1, 0.15, 0.2, 0.25, 0.3, 0.4)
"""Of steps, as shares of a leg of `REFERENCE_LEG_M` times the scale."""
REFERENCE_LEG_M: Final = 0.25
STAND_S: Final = 6.0
"""Longest time for one stand on the stairs; a climb that takes longer is over."""
SEEDS: Final = 3
"""Trials of each motion, with other errors of the senses."""
SHORT: Final = 0.6
"""Of what it was told, what a robot goes or turns at least."""


@dataclass(frozen=True, slots=True)
class Row:
    """What one task came to.

    Attributes:
        task: what was tried.
        result: what came out, in words.
        passed: whether the robot did it; of tasks that get harder, whether it did the least.
        why: why no more; None where it did all.
    """

    task: str
    result: str
    passed: bool
    why: str | None = None

    def plain(self) -> dict[str, Any]:
        """Return it as data that JSON can hold."""
        return {"task": self.task, "result": self.result, "passed": self.passed, "why": self.why}


def table(folder: Path, say: Callable[[str], None], seed: int = 0) -> list[dict[str, Any]]:
    """Try what a robot can do, and return a row for each task.

    Args:
        folder: the robot's.
        say: is told of each task before it is tried.
        seed: of all that is random.

    Raises:
        InputError: the robot cannot be built.
    """
    robot = load_folder(folder)
    size = Size.of(robot)
    rows = []
    for title, task in _tasks(robot, size, seed):
        say(f"{title} ...")
        rows.append(task().plain())
    return rows


def _tasks(robot: Robot, size: Size, seed: int) -> Iterator[tuple[str, Callable[[], Row]]]:
    root = size.scale**0.5
    walks = {
        "walks ahead": (WALKING_MPS * root, 0.0, 0.0),
        "walks back": (-0.6 * WALKING_MPS * root, 0.0, 0.0),
        "walks sideways": (0.0, SIDEWAYS_MPS * root, 0.0),
        "turns": (0.0, 0.0, TURNING_RADPS / root),
    }
    for title, velocity in walks.items():
        yield title, partial(_walk, robot, size, seed, title, velocity)
    yield "stops", partial(_stop, robot, size, seed)
    yield "is pushed as it walks", partial(_pushed, robot, size, seed)
    yield "steps up", partial(_steps, robot, size, seed, 1.0)
    yield "steps down", partial(_steps, robot, size, seed, -1.0)


def _run(
    world: World,
    end_s: float,
    motion: Callable[[float], Motion],
    push: tuple[float, tuple[float, float]] | None = None,
) -> tuple[float, str] | None:
    """Run to an end; return when and how the robot fell, or None."""
    for index in range(round(end_s / TICK_S)):
        now = index * TICK_S
        pushed = push is not None and push[0] <= now < push[0] + PUSH_S
        world.tick(motion(now), push[1] if push is not None and pushed else (0.0, 0.0))
        how = world.fall()
        if how is not None:
            return now, how
    return None


def _walk(
    robot: Robot, size: Size, seed: int, title: str, velocity: tuple[float, float, float]
) -> Row:
    root, done, why, went = size.scale**0.5, 0, None, 0.0
    begins, ends = STARTS_S, STARTS_S + WALKS_S * root
    turns = title == "turns"
    told = (velocity[2] if turns else math.hypot(*velocity[:2])) * (ends - begins)
    for number in range(SEEDS):
        world = World(robot, [], seed + number)
        fell = _run(
            world, ends + ENDS_S * root, lambda now: velocity if begins <= now < ends else None
        )
        x, y, yaw = world.pose()
        went = abs(yaw) if turns else math.hypot(x, y)
        if fell is not None:
            why = f"{fell[1]} after {fell[0] - begins:.1f} s"
        elif went < SHORT * told:
            why = "it gets less far than it is told"
        else:
            done += 1
    unit = "rad" if turns else "m"
    result = f"{done} of {SEEDS}; the last {went:.2f} of {told:.2f} {unit} in {ends - begins:.0f} s"
    return Row(title, result, done == SEEDS, why)


def _stop(robot: Robot, size: Size, seed: int) -> Row:
    """Walk on a curve, and stop at different moments of a step."""
    root, done, why = size.scale**0.5, 0, None
    velocity = (0.8 * WALKING_MPS * root, 0.0, 0.6 * TURNING_RADPS / root)
    for number in range(SEEDS):
        world, ends = World(robot, [], seed + number), STARTS_S + (2.3 + 0.3 * number) * root

        def motion(now: float, ends: float = ends) -> Motion:
            return velocity if STARTS_S <= now < ends else None

        fell = _run(world, ends + 1.6 * ENDS_S * root, motion)
        if fell is not None:
            why = f"{fell[1]} {fell[0] - ends:.1f} s after"
        elif not world.walker.standing:
            why = "it goes on stepping"
        else:
            done += 1
    return Row("stops", f"{done} of {SEEDS}", done == SEEDS, why)


def _pushed(robot: Robot, size: Size, seed: int) -> Row:
    root, borne = size.scale**0.5, 0.0
    velocity = (WALKING_MPS * root, 0.0, 0.0)
    for level in PUSHES_MPS:
        impulse = level * root * size.mass_kg
        for word, half_turns in DIRECTIONS.items():
            force = impulse / PUSH_S
            turn = math.pi * half_turns
            push = (PUSHED_AT_S * root, (force * math.cos(turn), force * math.sin(turn)))
            fell = _run(
                World(robot, [], seed), (PUSHED_AT_S + 3.0) * root, lambda _: velocity, push
            )
            if fell is not None:
                why = f"{impulse:.1f} N s {word}: {fell[1]}"
                result = f"{borne:.1f} N s from any side" if borne else "falls"
                return Row("is pushed as it walks", result, borne > 0.0, why)
        borne = impulse
    return Row("is pushed as it walks", f"{borne:.1f} N s from any side", True)


def _steps(robot: Robot, size: Size, seed: int, direction: float) -> Row:
    title, climbed = "steps up" if direction > 0.0 else "steps down", 0.0
    for share in RISES:
        rise = share * REFERENCE_LEG_M * size.scale
        whys = [_climb(robot, size, seed + number, direction * rise) for number in range(SEEDS)]
        why = next((why for why in whys if why is not None), None)
        if why is not None:
            result = f"{1e3 * climbed:.0f} mm" if climbed else "none"
            return Row(title, result, climbed > 0.0, f"{1e3 * rise:.0f} mm: {why}")
        climbed = rise
    return Row(title, f"{1e3 * climbed:.0f} mm, the highest that was tried", True)


def _climb(robot: Robot, size: Size, seed: int, rise_m: float) -> str | None:
    """Climb two steps; return why not, or None."""
    found = levels(size, rise_m)
    try:
        world = World(robot, elements(found, size.scale), seed)
    except InputError as error:
        return str(error).splitlines()[0]
    climber, root = Climber(found, size), size.scale**0.5
    for index in range(round(STAND_S * root * (climber.count + 1) / TICK_S)):
        now = index * TICK_S
        world.tick(climber.motion(now, world.walker, world.start_height))
        how = world.fall()
        if how is not None:
            return how
        if now > climber.finished + root:
            break
    if climber.misstep is not None:
        return climber.misstep
    return None if climber.has_climbed else "it does not get on"
