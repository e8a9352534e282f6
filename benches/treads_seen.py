"""How well treads are seen before they are climbed, in closed harness frames: a table per place.

A robot stands in front of stairs, sweeps its head, and is then set onto one tread after the other,
up and down again, by an event; its localizer is told of that with an error of millimetres. At every
place it sweeps its head again. The regions and the map are compared with the course. Every noise is
on, and the camera's error is drawn by the seed.

python benches/treads_seen.py --rise 0.03 --tread 0.12 --seeds 0-4
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tread_shares import HEAD, Seen, join

from treadwell._core import BodyState, FloorView, Planes, Situation
from treadwell.course.stairs import treads_of
from treadwell.episode import Episode
from treadwell.physics.simulation import Start
from treadwell.poses import pose_matrix
from treadwell.protocols import Decision, Pose
from treadwell.scenario.elements import Stairs
from treadwell.senses.depth import Cast, DepthCamera

Floats = NDArray[np.float64]

SETTLE_S = 2.0
TOE = 0.0525
"""Half a sole, metres."""
LEAST = 100
"""Fewest pixels of a tread that counts as visible."""


class Sweep:
    """A behaviour: stands and swings its head, looking down by 35 to 60 degrees."""

    def next(self, situation: Situation) -> Decision:
        """Return where to look now."""
        t = 1e-9 * situation.time_ns
        pan = 0.35 * np.sin(2 * np.pi * t / 4.0)
        down = np.radians(47.5 + 12.5 * np.sin(2 * np.pi * t / 5.2))
        return Decision("sweep", gaze=(float(pan), float(down)))


class ToldLegs:
    """A localizer: leg odometry, and being told of being set elsewhere; z drawn to the floor."""

    def __init__(self) -> None:
        """Start at the origin of the map."""
        self.map_from_odometry = np.eye(4)

    def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:  # noqa: ARG002
        """Draw the height to the floor in the map, as the core's own does."""
        x, y, z, _ = self.estimate(body)
        row, col = (
            int((v - o) // view.cell) for v, o in zip((y, x), view.origin[::-1], strict=True)
        )
        error = float(view.height[row, col]) - z
        if view.kind[row, col] == 1 and abs(error) < 0.012:
            self.map_from_odometry[2, 3] += 0.1 * error

    def estimate(self, body: BodyState) -> Pose:
        """Return (x, y, z, yaw)."""
        matrix = self.map_from_odometry @ body.odometry_from_robot
        x, y, z = matrix[:3, 3]
        return float(x), float(y), float(z), float(np.arctan2(matrix[1, 0], matrix[0, 0]))


class PosedCamera(DepthCamera):
    """The camera where it was at an exposure."""

    at: tuple[Floats, Floats]

    def pose(self, data: object) -> tuple[Floats, Floats]:  # noqa: ARG002 - it is told
        """Return position and rotation."""
        return self.at


def scenario_text(options: argparse.Namespace) -> str:
    """Return the scenario: stairs up and down between walls."""
    wide = options.width / 2 + 0.025
    return f"""
schema = 1
name = "treads_seen"
time_limit = 600.0
[start]
position = [0.0, 0.0]
[goal]
position = [3.0, 0.0]
[sensors]
latency = 0.0
[[course]]
kind = "stairs"
name = "stairs"
position = [{options.distance}, 0.0]
yaw = {np.radians(options.askew)}
steps = {options.steps}
rise = {options.rise}
tread = {options.tread}
width = {options.width}
landing = {options.landing}
turn = {options.turn}
descent = true
""" + (
        ""
        if not options.walls
        else f"""
[[course]]
kind = "wall"
name = "left wall"
from = [-0.3, {wide}]
to = [3.4, {wide}]
height = 0.6
[[course]]
kind = "wall"
name = "right wall"
from = [-0.3, {-wide}]
to = [3.4, {-wide}]
height = 0.6
"""
    )


class Trial:
    """One seed."""

    def __init__(self, options: argparse.Namespace, seed: int) -> None:
        """Build the episode."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "treads_seen.toml"
            path.write_text(scenario_text(options))
            self.localizer = ToldLegs()
            self.episode = Episode(path, seed=seed, behaviour=Sweep(), localizer=self.localizer)
        self.rng = np.random.default_rng(seed)
        self.options = options
        sensor = self.episode.sensors._depth
        real = sensor.camera
        model = self.episode.course.model
        self.camera = PosedCamera(model, model.camera(real._camera).name, real.pinhole)
        self.real = real
        stairs = next(e for e in self.episode.scenario.course if isinstance(e, Stairs))
        self.treads = treads_of(stairs)
        self.levels = np.unique(np.round([0.0, *(tread.height for tread in self.treads)], 6))

    def places(self) -> Iterator[tuple[str, Start]]:
        """Yield where it is set, in the order of walking."""
        stand = self.options.stand
        yield "floor", Start(self.options.distance - stand - TOE, 0.0)
        for i, tread in enumerate(self.treads[:-1]):
            forward = np.array([np.cos(tread.yaw), np.sin(tread.yaw)])
            down = self.treads[i + 1].height < tread.height
            # Toes short of the riser ahead, or over the edge that leads down.
            x, y = tread.back + (0.015 if down else -0.015) * forward - TOE * forward
            yield tread.part, Start(float(x), float(y), yaw=tread.yaw, height=tread.height)

    def set_at(self, start: Start) -> None:
        """Set the robot elsewhere, as it stands, and tell its localizer with an error."""
        simulation = self.episode.simulation
        before = self.episode.judge.truth.frame(
            self.episode.judge.truth.soles(simulation.data), (True, True)
        ).matrix()
        after = pose_matrix(start.x, start.y, start.height, start.yaw)
        move = after @ np.linalg.inv(before)
        qpos = simulation.data.qpos.copy()
        base = int(simulation.model.joint(simulation.robot.base).qposadr[0])
        qpos[base : base + 3] = move[:3, :3] @ qpos[base : base + 3] + move[:3, 3]
        half = 0.5 * np.arctan2(move[1, 0], move[0, 0])
        w, x, y, z = qpos[base + 3 : base + 7]
        c, s = np.cos(half), np.sin(half)
        qpos[base + 3 : base + 7] = (c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w)
        simulation.set("qpos", qpos)
        rise = after[2, 3] - before[2, 3]
        told = move.copy()
        told[2, 3] = rise + self.options.height_error * self.rng.normal() * (abs(rise) > 1e-3)
        self.localizer.map_from_odometry = told @ self.localizer.map_from_odometry

    def stay(self, seconds: float, seen: Seen | None) -> None:
        """Go on for a while; compare every frame."""
        episode = self.episode
        for _ in range(round(seconds / 0.01)):
            data = episode.simulation.data
            at = self.real.pose(data)
            frame = episode.judge.truth.frame(episode.judge.truth.soles(data), (True, True))
            step = episode.tick()
            if seen is not None and step.observation.depth is not None:
                self.camera.at = at
                self.compare(self.camera.cast(data), frame.matrix(), seen)

    def compare(self, cast: Cast, world_from_robot: Floats, seen: Seen) -> None:
        """Compare a frame's regions with what the rays truly met."""
        planes = self.episode.pilot.planes()
        rays = self.camera.pinhole.directions() @ cast.rotation.T
        met = cast.position + rays * cast.depth.reshape(-1, 1)
        away = np.linalg.norm(met[:, :2] - world_from_robot[:2, 3], axis=1)
        geoms, surface = np.unique(cast.geom, return_inverse=True)
        surface = surface.reshape(-1)
        z = np.nan_to_num(met[:, 2], nan=9.0)
        top = np.full(len(z), np.nan)
        for level in self.levels:
            top[np.abs(z - level) < 1e-4] = level
        given = np.isfinite(planes.points_in_robot[:, 0])
        on = np.isfinite(top)
        labels = planes.labels.astype(int)
        seen.frames += 1
        seen.reliable += planes.reliable
        up = planes.robot_from_camera[:3, :3] @ cast.rotation.T @ np.array([0.0, 0.0, 1.0])
        seen.tilts.append(float(np.arcsin(min(1.0, np.hypot(up[0], up[1])))))
        floor = np.isfinite(planes.floor_height)
        tall = (z > self.levels[-1] + 0.03) & given
        seen.false_floor += float((floor & tall).sum()) / max(1, tall.sum())
        close = on & given & (away < 1.0)
        seen.lost += float((~floor & close).sum()) / max(1, close.sum())
        heights = [region[4] for region in planes.regions]
        parts = np.zeros((len(heights) + 1, len(geoms)), int)
        np.add.at(parts, (labels[on], surface[on]), 1)
        level_regions = [i for i, h in enumerate(heights) if h is not None]
        for one in range(len(geoms)):
            pixels = on & given & (surface == one)
            if pixels.sum() < LEAST:
                continue
            distance = float(np.median(away[pixels]))
            if distance > 1.0:
                continue
            share = seen.near if distance <= 0.6 else seen.far
            height = float(top[pixels][0])
            mine = [
                i for i in level_regions if parts[i + 1].argmax() == one and parts[i + 1, one] > 0
            ]
            hit = [
                i
                for i in mine
                if parts[i + 1, one] >= 0.8 * pixels.sum()
                and parts[i + 1, one] >= 0.8 * parts[i + 1].sum()
            ]
            share.visible += 1
            share.hit += len(hit)
            share.over += not hit and len(mine) > 1
            for i in mine:
                error = world_from_robot[2, 3] + float(heights[i] or 0.0) - height
                own = parts[i + 1].sum()
                share.under += bool(((parts[i + 1] > 0.2 * own) & (parts[i + 1] > 30)).sum() > 1)
                if abs(height - world_from_robot[2, 3]) > 5e-3:
                    share.errors.append(error)

    def judge_map(self, seen: Seen) -> None:
        """Compare the map's cells that lie inside one tread by 4 cm."""
        view = self.episode.pilot.view()
        rows, cols = view.kind.shape
        x = view.origin[0] + view.cell * (np.arange(cols) + 0.5)
        y = view.origin[1] + view.cell * (np.arange(rows) + 0.5)
        points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        inside = np.full(len(points), np.nan)
        for tread in self.treads:
            forward = np.array([np.cos(tread.yaw), np.sin(tread.yaw)])
            along = (points - tread.front) @ forward
            across = np.abs((points - tread.front) @ np.array([-forward[1], forward[0]]))
            own = (along > 0.03) & (along < tread.depth - 0.03)
            own &= across < self.options.width / 2 - 0.04
            inside[own] = tread.height
        known = (view.sightings.reshape(-1) > 3) & np.isfinite(inside)
        known |= (view.kind.reshape(-1) == 2) & np.isfinite(inside)
        error = view.height.reshape(-1)[known] - inside[known]
        kind = view.kind.reshape(-1)[known]
        floor = kind == 1
        right = floor & (np.abs(error) < 0.012)
        seen.inside += int(known.sum())
        seen.blocked += int((~floor).sum())
        seen.wrong += int((floor & ~right).sum())
        seen.cells += [float(e) for e in error[right]]

    def run(self) -> dict[str, Seen]:
        """Return what each place showed."""
        table: dict[str, Seen] = {}
        self.stay(self.options.before, table.setdefault("start", Seen()))
        self.judge_map(table["start"])
        for name, start in self.places():
            self.set_at(start)
            self.stay(0.1, None)
            self.stay(self.options.seconds, table.setdefault(name, Seen()))
            self.judge_map(table[name])
        return table


def seeds(text: str) -> list[int]:
    """Read `100-119` or `3`."""
    first, _, last = text.partition("-")
    return list(range(int(first), int(last or first) + 1))


def main() -> None:
    """Run and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rise", type=float, default=0.03)
    parser.add_argument("--tread", type=float, default=0.12)
    parser.add_argument("--steps", type=int, default=4)
    parser.add_argument("--width", type=float, default=0.6)
    parser.add_argument("--landing", type=float, default=0.33)
    parser.add_argument("--distance", type=float, default=0.5, help="of the first edge, m")
    parser.add_argument("--stand", type=float, default=0.1, help="toes before the first edge, m")
    parser.add_argument("--askew", type=float, default=0.0, help="of the first edge, degrees")
    parser.add_argument("--turn", type=float, default=0.0)
    parser.add_argument("--walls", action="store_true")
    parser.add_argument("--before", type=float, default=8.0)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--height-error", type=float, default=0.002)
    parser.add_argument("--seeds", type=seeds, default=[0])
    options = parser.parse_args()
    table: dict[str, Seen] = {}
    ms: list[float] = []
    for seed in options.seeds:
        trial = Trial(options, seed)
        for name, seen in trial.run().items():
            join(table.setdefault(name, Seen()), seen)
        ms.append(1e3 * float(np.median(trial.episode.seconds["segment"])))
        ms.append(1e3 * float(np.median(trial.episode.seconds["map"])))
    sys.stdout.write(HEAD)
    for name, seen in table.items():
        sys.stdout.write(seen.row(name))
    sys.stdout.write(f"segment {np.median(ms[::2]):.2f} ms, map {np.median(ms[1::2]):.2f} ms\n")


if __name__ == "__main__":
    main()
