"""Walks over patches of floor, slippery or not: what their shade tells of how far feet slip.

    python benches/slip_trials.py --patches 30 --workers 2
    python benches/slip_trials.py --shade-noise 0.03 --picture slip.png

Every seed draws one patch: half of them have a friction of 0.05 to 0.15, half of 0.3 to 0.9; its
shade tells the friction to `--shade-noise`. A robot walks on it for some seconds. What slips is the
mean speed of loaded soles. Each robot has a sense of slip (joints and inertial unit), learned on
patches of its own where the simulator says the slip; with it alone one robot learns on other
patches, one after the other, what a shade means, and that is tried on the other robot's slip on
patches that nobody has met. No camera: the shade is drawn, not seen.
"""

import argparse
import json
import math
import sys
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from into_results import add_options, write
from numpy.typing import NDArray
from walking_trials import TICK_S, World, first_job

from treadwell._core import LocalRegression, SlipSense, gait_statistics
from treadwell.robot.load import load_robot

SLIPPERY, FIRM = (0.05, 0.15), (0.3, 0.9)
SHADE_NOISE = 0.01
SPEED = 0.1
STARTS_S = 0.5
WINDOW_S = 1.0
SETTLES_S = 2.0
"""Before it, the gait has not settled: no second of it counts."""
CARRIES = 0.2
"""Share of the weight from which on a sole counts as loaded."""
LEARNING = json.dumps({"width": 0.06, "noise": 3.0, "spread": 100.0, "doubt": 0.1})
"""Of slip in mm/s: a second's measurement is off by 3, and slip changes by 100 over all shades."""
ROBOTS = ("qrio", "nao")
SENSE, TRAINING, TEST = 1000, 0, 3000
"""First seeds of the patches on which a sense is learned, shades are learned, and all is tried;
settings were chosen on 2000 to 2029."""
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Walk:
    """A walk over one patch, second by second: statistics of the gait, true slip in m/s."""

    friction: float
    shade: float
    statistics: Floats
    slip: Floats


def patch(seed: int, shade_noise: float = SHADE_NOISE) -> tuple[float, float]:
    """Return friction and shade of the patch of a seed."""
    random = np.random.default_rng([seed, 36])
    friction = float(random.uniform(*(SLIPPERY if random.random() < 0.5 else FIRM)))
    shade = 0.1 + 0.9 * friction + random.normal(0.0, shade_noise)
    return friction, float(np.clip(shade, 0.0, 1.0))


def walk(name: str, seed: int, seconds: float, shade_noise: float = SHADE_NOISE) -> Walk:
    """Let a robot walk on the patch of a seed, until it falls or the seconds are over."""
    friction, shade = patch(seed, shade_noise)
    world = World(first_job(name, "straight", seed))
    world.simulation.model.geom_friction[:, 0] = friction
    robot = load_robot(name)
    legs = [robot.file.legs.left.joints, robot.file.legs.right.joints]
    joints = np.array([[list(robot.joints).index(joint) for joint in leg] for leg in legs])
    turns, forces, speeds, angles, slips = [], [], [], [], []
    for index in range(round(seconds / TICK_S)):
        seen = world.tick((SPEED, 0.0, 0.0) if index * TICK_S > STARTS_S else None)
        turns.append(seen.angular_velocity)
        forces.append(seen.specific_force)
        speeds.append(seen.joint_velocities[joints])
        angles.append(seen.joint_positions[joints])
        slips.append(_slip(world, seen.foot_forces.sum(axis=1)))
        if world.has_fallen():
            break
    window = round(WINDOW_S / TICK_S)
    starts = range(round(SETTLES_S / TICK_S), len(slips) - window + 1, window)
    parts = [slice(start, start + window) for start in starts]
    measured = [np.array(one, np.float64) for one in (turns, forces, speeds, angles)]
    statistics = [gait_statistics(*(one[part] for one in measured)) for part in parts]
    slip = [float(np.nanmean(slips[part])) for part in parts]
    return Walk(friction, shade, np.array(statistics).reshape(len(parts), -1), np.array(slip))


def _slip(world: World, loads: Floats) -> float:
    """Return the mean speed of the soles that carry, m/s."""
    model, data = world.simulation.model, world.simulation.data
    speeds, velocity = [], np.zeros(6)
    for sole, load in zip(world.soles, loads, strict=True):
        if load > CARRIES * 9.81 * float(model.body_mass.sum()):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, sole, velocity, 0)
            arm = np.array([0.0, 0.0, -world.foot_height])  # the sole's speed, not the link's
            speeds.append(np.linalg.norm((velocity[3:] + np.cross(velocity[:3], arm))[:2]))
    return float(np.mean(speeds)) if speeds else math.nan


def sense_of(walks: Iterable[Walk]) -> SlipSense:
    """Return a robot's sense of slip, learned where the simulator says what slips."""
    walks = list(walks)
    statistics = np.concatenate([one.statistics for one in walks])
    return SlipSense(statistics, np.concatenate([one.slip for one in walks]))


def learned_of(sense: SlipSense, walks: Iterable[Walk]) -> tuple[LocalRegression, float]:
    """Return what shades mean, in mm/s, and the mean, as the robot felt it patch after patch."""
    walks = list(walks)
    felt = [1000.0 * sense.slip(one.statistics) for one in walks]
    usual = float(np.mean(np.concatenate(felt)))
    learned = LocalRegression(1, usual, LEARNING)
    for one, slips in zip(walks, felt, strict=True):
        learned.learn(np.full((len(slips), 1), one.shade), slips)
    return learned, usual


def errors(learned: LocalRegression, usual: float, walks: Iterable[Walk]) -> list[float]:
    """Return by how much the told slips are off, and by how much the mean is: RMSE, mm/s."""
    walks = list(walks)
    truth = np.array([1000.0 * one.slip.mean() for one in walks])
    told, _ = learned.predict(np.array([[one.shade] for one in walks]))
    return [float(np.sqrt(np.mean((one - truth) ** 2))) for one in (told, usual)]


def _walk(job: tuple[str, int, float, float]) -> Walk:
    return walk(*job)


def draw(learned: dict[str, LocalRegression], tried: dict[str, list[Walk]], file: Path) -> None:
    """Draw what each robot learned, and the slips on patches that nobody had met."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 3.6))
    shades = np.linspace(0.0, 1.0, 200)
    for name, of in learned.items():
        axes.plot(shades, of.predict(shades[:, None])[0], label=f"learned by {name}")
    for name, walks in tried.items():
        slips = [1000.0 * one.slip.mean() for one in walks]
        axes.plot([one.shade for one in walks], slips, ".", label=f"{name}, new patches")
    axes.set(xlabel="shade of the patch", ylabel="slip of loaded soles, mm/s")
    axes.legend()
    figure.savefig(file, bbox_inches="tight")


def main() -> int:
    """Run the trials and print what came out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--patches", type=int, default=30, help="for each of the three purposes")
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--shade-noise", type=float, default=SHADE_NOISE)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--picture", type=Path, help="of what was learned")
    add_options(parser)
    arguments = parser.parse_args()
    firsts = (SENSE, TRAINING, TEST)
    seeds = [first + at for first in firsts for at in range(arguments.patches)]
    noise = arguments.shade_noise
    jobs = [(robot, seed, arguments.seconds, noise) for robot in ROBOTS for seed in seeds]
    with ProcessPoolExecutor(arguments.workers) as pool:
        walks = dict(zip([job[:2] for job in jobs], pool.map(_walk, jobs), strict=True))

    def of(robot: str, first: int) -> list[Walk]:
        return [walks[robot, first + at] for at in range(arguments.patches)]

    learned = {name: learned_of(sense_of(of(name, SENSE)), of(name, TRAINING)) for name in ROBOTS}
    rows = []
    for name in ROBOTS:
        for other in ROBOTS:
            own, constant = errors(*learned[name], of(other, TEST))
            measured = f"{own:.1f} of {constant:.1f} mm/s: {own / constant:.2f}"
            rows.append({"what": f"learned by {name}, tried on {other}", "measured": measured})
            print(f"{rows[-1]['what']}: {measured}")
    if arguments.picture:
        tried = {name: of(name, TEST) for name in ROBOTS}
        draw({name: one for name, (one, _) in learned.items()}, tried, arguments.picture)
    title = f"Slip told from a shade that is wrong by {noise}"
    write(arguments, title, range(arguments.patches), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
