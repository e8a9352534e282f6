"""Small courses, finished results and traces for the tests of judge, score and recorders."""

import warnings
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mujoco
import numpy as np

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.judging.result import Result
from treadwell.map_memory import RememberedMap
from treadwell.physics.simulation import Simulation, Start
from treadwell.poses import pose_matrix
from treadwell.protocols import JointTargets
from treadwell.robot.load import Robot, load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario
from treadwell.trace import StairTrace, Trace

STEP = """
[[course]]
kind = "platform"
name = "step"
position = [1.0, 0.0]
size = [0.6, 1.0, 0.03]
"""
BOX = """
[[course]]
kind = "box"
name = "box"
position = [0.5, 0.0]
size = [0.2, 0.2, 0.3]
"""


@cache
def qrio() -> Robot:
    return load_robot("qrio")


@dataclass
class World:
    scenario: Scenario
    course: Course
    simulation: Simulation

    @property
    def model(self) -> mujoco.MjModel:
        return self.course.model

    def stand(self, seconds: float) -> list[float]:
        """Stand, and return the times after each tick."""
        robot = self.simulation.robot
        n = len(robot.joints)
        targets = JointTargets(robot.stand, np.zeros(n), np.zeros(n))
        times = []
        for _ in range(round(seconds / 0.01)):
            self.simulation.advance(targets)
            times.append(1e-9 * self.simulation.time_ns)
        return times


def scenario(course: str = "", goal: str = "position = [2.0, 0.0]", start: str = "") -> Scenario:
    text = f'schema = 1\nname = "small"\n[start]\n{start}\n[goal]\n{goal}\n{course}'
    with TemporaryDirectory() as folder:
        path = Path(folder) / "small.toml"
        path.write_text(text)
        return load_scenario(path)


def world(course: str = "", goal: str = "position = [2.0, 0.0]", start: str = "") -> World:
    made = scenario(course, goal, start)
    built = build_course(made, qrio())
    place = built.start
    begin = Start(*place.position, yaw=place.yaw, height=place.height)
    return World(made, built, Simulation(built.model, qrio(), begin))


def result(made: Scenario, **changes: object) -> Result:
    facts: dict[str, Any] = {
        "scenario": made.name,
        "robot": "qrio",
        "seed": made.seed,
        "version": "0.1.0",
        "configuration": made.configuration(),
        "outcome": "goal_reached",
        "simulated_seconds": 1.0,
        "wall_seconds": 0.1,
        "real_time_factor": 10.0,
        "physics_real_time_factor": 12.0,
    }
    return Result(**facts | changes)


def grid(
    origin: tuple[float, float] = (-1.0, -1.0), rows: int = 50, cols: int = 75, cell: float = 0.04
) -> RememberedMap:
    """A map that knows nothing yet."""
    return RememberedMap(
        origin,
        cell,
        np.zeros((rows, cols), dtype=np.uint8),
        np.full((rows, cols), np.nan, dtype=np.float32),
        np.zeros((rows, cols), dtype=np.uint16),
    )


def trace(built: World, time_ns: int, **changes: object) -> Trace:
    """A camera frame in which something of everything was seen."""
    kind = np.ones((40, 40), dtype=np.uint8)
    kind[10:14, 20:24], kind[30:] = 2, 0
    pose = pose_matrix(0.001 * (time_ns % 10**9) / 1e6, 0.0, 0.0, 0.1)
    depth = np.full((72, 88), 1.5, dtype=np.float32)
    depth[:4] = np.nan
    points = np.random.default_rng(0).normal(size=(72 * 88, 3)).astype(np.float32)
    points[:50] = np.nan
    facts: dict[str, Any] = {
        "time_ns": time_ns,
        "map_from_robot": pose,
        "odometry_from_robot": pose,
        "truth_from_robot": pose,
        "map_from_camera": pose,
        "depth": depth,
        "points_in_robot": points,
        "labels": (np.arange(72 * 88) // 2000).astype(np.uint16),
        "ground": 1,
        "view_origin": (-0.8, -0.8),
        "view_cell": 0.04,
        "view_kind": kind,
        "view_height": np.where(kind > 0, 0.01, np.nan).astype(np.float32),
        "sightings": np.full((40, 40), 4, dtype=np.uint16),
        "map_due": time_ns // 80_000_000 % 4 == 0,
        "clearance": np.full((40, 40), 0.5, dtype=np.float32),
        "path": np.array([[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]]),
        "state": "walk",
        "goal": (2.0, 0.0),
        "gaze": (0.0, 0.5),
        "body_positions": built.simulation.data.xpos.copy(),
        "body_orientations": built.simulation.data.xquat.copy(),
        "timing": {"map": 0.001},
    }
    return Trace(**facts | changes)


def flight(steps: int = 4, **changes: object) -> tuple[StairTrace, ...]:
    """A flight of stairs ahead, 30 mm a step, the nearest with fitted edges."""
    facts: dict[str, Any] = {"front_fitted": False, "back_fitted": False, "steps_ago": 0}
    stairs = []
    for i in range(steps):
        front, back, z = 0.6 + 0.12 * i, 0.72 + 0.12 * i, 0.03 * (i + 1)
        edges = {
            "front": np.array([[front, 0.16, z], [front, -0.16, z]]),
            "back": np.array([[back, 0.16, z], [back, -0.16, z]]),
        }
        stairs.append(StairTrace(**facts | {"front_fitted": i == 0} | edges | changes))
    return tuple(stairs)


def entities(path: Path) -> set[str]:
    """Return the entities of a recording."""
    from rerun.chunk import RrdReader

    with warnings.catch_warnings():
        # A file whose writer was stopped has no table of contents; reading it takes longer.
        warnings.simplefilter("ignore")
        return {str(chunk.entity_path) for chunk in RrdReader(path).stream().to_chunks()}


def shown_as(path: Path) -> tuple[str, str]:
    """Return what rerun's viewer calls a recording: its application, and its own name."""
    from rerun.chunk import RrdReader

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        reader = RrdReader(path)
        (store,) = reader.recordings()
        (name,) = [
            table.column("RecordingInfo:name").to_pylist()[0][0]
            for chunk in reader.stream().to_chunks()
            if "RecordingInfo:name" in (table := chunk.to_record_batch()).schema.names
        ]
    return store.application_id, name
