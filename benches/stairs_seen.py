"""Each step before it is climbed, against the course: height, front edge and heading.

The robot stands and looks around as it does before it climbs: first aside, where the floor is open,
then steeply down in front. Places: `up` and `sill` (toes 10 cm before the edge) and `down` (from a
platform, toes 25 to 35 cm before its edge: who starts nearer sees no level floor). Rises of 20 to
50 mm, treads of 11 to 20 cm, yaw up to 10 degrees, every noise on; each seed has its own error of
the camera. What is known while a robot climbs: `episodes.py`.

python benches/stairs_seen.py up down sill --seeds 0-19
"""

import argparse
import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from episodes import seeds
from into_results import add_options, write
from numpy.typing import NDArray

from treadwell._core import Situation
from treadwell.episode import Episode
from treadwell.measuring.step_watch import EDGE_M, HEADING_RAD, HEIGHT_M
from treadwell.protocols import Decision

Floats = NDArray[np.float64]

TOE = 0.0525
"""Half a sole, metres."""
GAZES = (
    *((pan, down) for down in (0.8, 1.05) for pan in (1.1, -1.1)),
    *((0.0, down) for down in (0.85, 0.95, 1.05)),
    *((pan, 1.1) for pan in (0.2, -0.2)),
    (0.0, 1.2),
)
"""Where it looks, (pan, down) rad, a second each."""
SAME_STEP_M = 0.06
"""A stair that is believed to begin further from the true edge is another one."""


class Look:
    """A behaviour: stands and looks around."""

    def next(self, situation: Situation) -> Decision:
        """Return where to look now."""
        index = min(int(1e-9 * situation.time_ns), len(GAZES) - 1)
        return Decision("look", gaze=GAZES[index])


@dataclass(frozen=True)
class Place:
    """A course and where the robot stands on it, at the origin.

    Attributes:
        course: TOML of its elements.
        stands: m, height of what it stands on.
        edge: (2,) m, middle of the edge that is asked for, world.
        heading: rad, across that edge.
        height: m, of the surface behind it.
    """

    course: str
    stands: float
    edge: Floats
    heading: float
    height: float


def place(kind: str, rng: np.random.Generator) -> Place:
    """Draw a place."""
    rise, tread = rng.uniform(0.02, 0.05), rng.uniform(0.11, 0.20)
    yaw, width = rng.uniform(-0.17, 0.17), rng.uniform(0.33, 0.9)
    aside = rng.uniform(-0.03, 0.03)
    forward = np.array([math.cos(yaw), math.sin(yaw)])
    if kind == "sill":
        edge = np.array([TOE + 0.10, aside])
        return Place(stairs(edge, yaw, 1, 0.038, 0.09, 1.0, landing=0.09), 0.0, edge, yaw, 0.038)
    if kind == "down":
        edge = np.array([TOE + rng.uniform(0.25, 0.35), aside])
        first, middle = edge + 2 * tread * forward, edge - 0.6 * forward
        course = stairs(first, yaw + math.pi, 2, rise, tread, width, landing=tread)
        course += (
            f'[[course]]\nkind = "platform"\nposition = [{middle[0]}, {middle[1]}]\n'
            f"yaw = {yaw}\nsize = [1.2, 2.0, {3 * rise}]\n"
        )
        return Place(course, 3 * rise, edge, yaw, 2 * rise)
    edge = np.array([TOE + 0.10, aside])
    return Place(stairs(edge, yaw, 3, rise, tread, width, landing=0.5), 0.0, edge, yaw, rise)


def stairs(
    first: Floats,
    yaw: float,
    steps: int,
    rise: float,
    tread: float,
    width: float,
    *,
    landing: float,
) -> str:
    """Return the `[[course]]` entry."""
    return (
        f'[[course]]\nkind = "stairs"\nposition = [{first[0]}, {first[1]}]\nyaw = {yaw}\n'
        f"steps = {steps}\nrise = {rise}\ntread = {tread}\nwidth = {width}\nlanding = {landing}\n"
    )


def rotation(yaw: float) -> Floats:
    """Return the rotation (2, 2) by a yaw, rad."""
    return np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])


def run(kind: str, seed: int) -> tuple[float, float, float] | None:
    """Return errors of height m, edge m and heading rad; None when the step was not found."""
    drawn = place(kind, np.random.default_rng([seed, len(kind)]))
    text = (
        'schema = 1\nname = "stairs_seen"\ntime_limit = 60.0\n[start]\nposition = [0.0, 0.0]\n'
        f"height = {drawn.stands}\n[goal]\nposition = [5.0, 0.0]\n{drawn.course}"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "stairs_seen.toml"
        path.write_text(text)
        episode = Episode(path, seed=seed, behaviour=Look())
    while episode.simulation.time_ns < len(GAZES) * 1_000_000_000 and episode.verdict is None:
        step = episode.tick()
    true = episode.judge.frame
    middle = rotation(true.yaw).T @ (drawn.edge - [true.x, true.y])
    heading, height = drawn.heading - true.yaw, drawn.height - true.z
    x, y, z, yaw = step.estimate.pose
    turn = rotation(yaw).T
    normal = np.array([math.cos(heading), math.sin(heading)])
    # The place on the true edge that is straight ahead, square to it.
    foot = float(middle @ normal) * normal
    best = None
    for stair in episode.pilot.staircase().stairs:
        left, right = (turn @ (np.array(end[:2]) - [x, y]) for end in stair.front)
        along = (left - right) / np.linalg.norm(left - right)
        across = np.array([along[1], -along[0]])
        edge = float(across @ (left - foot))
        near_height = abs(stair.height - z - height) < 0.015
        if abs(edge) < SAME_STEP_M and near_height and (best is None or abs(edge) < abs(best[1])):
            off = math.remainder(math.atan2(across[1], across[0]) - heading, 2 * math.pi)
            best = (stair.height - z - height, edge, off)
    return best


def row(errors: Floats) -> str:
    """Return the figures of errors (n, 3) of height m, edge m and heading rad."""
    height, edge, heading = np.abs(errors).T
    bias, worst = 1e3 * errors.mean(axis=0), 1e3 * np.percentile(np.abs(errors), 95, axis=0)
    within = (edge <= EDGE_M) & (heading <= HEADING_RAD)
    return (
        f"height {bias[0]:+.1f} mm, 95 % {worst[0]:.1f}, within 3 mm {np.sum(height <= HEIGHT_M)}; "
        f"edge {bias[1]:+.1f} mm, 95 % {worst[1]:.1f}; heading 95 % "
        f"{np.degrees(1e-3 * worst[2]):.1f} degrees; within 10 mm and 3 degrees {np.sum(within)}"
    )


def main() -> None:
    """Run and print a row a place."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("places", nargs="+", choices=["up", "down", "sill"])
    parser.add_argument("--seeds", type=seeds, default=list(range(20)))
    add_options(parser)
    options = parser.parse_args()
    rows: list[dict[str, object]] = []
    for kind in options.places:
        outcomes = [run(kind, seed) for seed in options.seeds]
        errors = np.array([outcome for outcome in outcomes if outcome is not None])
        measured = {"found": f"{len(errors)} of {len(outcomes)}"}
        measured |= {"errors": row(errors)} if len(errors) else {}
        rows.append({"what": f"`{kind}`", "measured": measured})
        if not len(errors):
            sys.stdout.write(f"{kind:<5} found 0 of {len(outcomes)}\n")
            continue
        sys.stdout.write(f"{kind:<5} found {len(errors)} of {len(outcomes)}: {row(errors)}\n")
        sys.stdout.flush()
    write(options, "The first step as it is known from before it", options.seeds, rows)


if __name__ == "__main__":
    main()
