"""Leg odometry after 2 m straight on and after a turn by 90 degrees, every noise on.

    python benches/odometry.py --seeds 200-239

The robot stands for some seconds first, as it does when it looks around at the start of a run:
that is when it learns the gyro's bias. Friction and masses are drawn anew for every seed.
"""

import argparse
import math
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np
from episodes import seeds
from into_results import add_options, write
from numpy.typing import NDArray

from treadwell.episode import Episode
from treadwell.protocols import Decision
from treadwell.random_streams import RandomStreams

STANDING_S = 6.0


class Walk:
    """Stands, walks with one velocity until the odometry says that it is far enough, and stands."""

    def __init__(self, velocity: tuple[float, float, float], distance: float, turn: float) -> None:
        self.velocity, self.distance, self.turn = velocity, distance, turn
        self.begin: tuple[float, float] | None = None
        self.turned, self.yaw, self.done_at = 0.0, 0.0, math.inf

    def next(self, situation) -> Decision:  # noqa: ANN001
        """Return the decision at a control tick."""
        time = 1e-9 * situation.time_ns
        x, y, _, yaw = situation.estimate
        self.begin = self.begin or (x, y)
        self.turned += math.remainder(yaw - self.yaw, 2 * math.pi)
        self.yaw = yaw
        there = math.dist(self.begin, (x, y)) >= self.distance and abs(self.turned) >= self.turn
        if there and self.done_at == math.inf:
            self.done_at = time
        walking = time > STANDING_S and self.done_at == math.inf
        return Decision("walk", self.velocity if walking else None, gaze=(0.0, 0.7))


TASKS = {
    "2 m straight": ((0.10, 0.0, 0.0), 2.0, 0.0),
    "90 degrees": ((0.0, 0.0, 0.4), 0.0, math.pi / 2),
}


def run(job: tuple[str, int, float]) -> tuple[float, float]:
    """Return the errors of one run: metres and radians."""
    task, seed, seconds = job
    rng = RandomStreams(seed)("odometry bench")
    settings = (
        f"physics.friction={rng.uniform(0.6, 1.0)}",
        f"physics.mass_scale={rng.uniform(0.9, 1.1)}",
        f"time_limit={seconds}",
        "goal.position=[9.0, 9.0]",
    )
    behaviour = Walk(*TASKS[task])
    episode = Episode("open_floor", seed=seed, overrides=settings, behaviour=behaviour)
    while 1e-9 * episode.simulation.time_ns < behaviour.done_at + 3.0 and episode.verdict is None:
        step = episode.tick()
    x, y, _, yaw = step.estimate.odometry
    true = episode.judge.frame
    # What the robot believed at the start is what it was told: the truth.
    return math.dist((x, y), (true.x, true.y)), abs(math.remainder(yaw - true.yaw, 2 * math.pi))


def main() -> None:
    """Run and print a row a task."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=seeds, default=list(range(20)))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=200.0, help="simulated, of a run at most")
    add_options(parser)
    options = parser.parse_args()
    rows: list[dict[str, object]] = []
    with ProcessPoolExecutor(options.workers) as pool:
        for task in TASKS:
            jobs = [(task, seed, options.seconds) for seed in options.seeds]
            errors = np.array(list(pool.map(run, jobs)))
            metres, degrees = 100 * errors[:, 0], np.degrees(errors[:, 1])
            sys.stdout.write(
                f"{task:<13} {len(errors)} runs: median and 95 %: "
                f"{np.median(metres):.2f} and {np.percentile(metres, 95):.2f} cm, "
                f"{np.median(degrees):.2f} and {np.percentile(degrees, 95):.2f} degrees\n"
            )
            sys.stdout.flush()
            measured = {
                "position, median / 95 %": _two(metres, "cm"),
                "heading, median / 95 %": _two(degrees, "degrees"),
            }
            rows.append({"what": task, "measured": measured})
    write(options, "Leg odometry", options.seeds, rows)


def _two(errors: NDArray[np.float64], unit: str) -> str:
    return f"{np.median(errors):.2f} / {np.percentile(errors, 95):.2f} {unit}"


if __name__ == "__main__":
    main()
