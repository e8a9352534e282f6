"""What is collected of a replay on its way."""

import math
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

from treadwell._core import Pilot, Tick
from treadwell.judging.result import StateEntry
from treadwell.map_memory import MapMemory
from treadwell.measuring.measures import PoseErrors
from treadwell.observation import Floats, Observation
from treadwell.poses import pose_matrix, rotation_of
from treadwell.recording.core_products import stairs_of
from treadwell.recording.log_file import BrokenLogError
from treadwell.recording.observation_log import read_truth
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.trajectory import Trajectory
from treadwell.replaying.difference import Difference


@dataclass
class Findings:
    """What is collected on the way; of camera frames (tick, time ns, estimate, odometry, lost)."""

    seconds: dict[str, list[float]] = field(
        default_factory=lambda: {name: [] for name in Pilot.stages}
    )
    states: list[StateEntry] = field(default_factory=list)
    frames: list[tuple[int, int, Floats, Floats, bool]] = field(default_factory=list)
    last: tuple[Observation, Tick] | None = None
    memory: MapMemory = field(default_factory=MapMemory)
    stairs: StairMemory = field(default_factory=StairMemory)
    errors: PoseErrors = field(default_factory=PoseErrors)
    estimate: Trajectory = field(default_factory=Trajectory)
    truth: Trajectory = field(default_factory=Trajectory)
    ticks: int = 0
    compared: int = 0
    difference: Difference | None = None
    declared: tuple[str | None, str | None] = (None, None)
    broken: str | None = None
    error: str | None = None
    core_seconds: float = 0.0

    def tick(self, observation: Observation, tick: Tick, pilot: Pilot) -> None:
        """Take in a tick."""
        now = observation.time_ns
        for name, seconds in zip(Pilot.stages, pilot.timing, strict=True):
            if not math.isnan(seconds):
                self.seconds[name].append(seconds)
        if not self.states or self.states[-1].state != tick.state:
            self.states.append(StateEntry(time=1e-9 * now, state=tick.state))
        if self.declared[0] is None and tick.outcome is not None:
            self.declared = (tick.outcome, tick.reason)
        if observation.depth is not None or now == 0:
            self._frame(now, tick)
            forgotten = pilot.maps_forgotten
            stairs = stairs_of(pilot)
            self.stairs.update(
                stairs, climbing=bool(tick.footsteps), lost=tick.lost, forgotten=forgotten
            )
            self.memory.update(*pilot.floor(), forgotten=forgotten)
        self.last = (observation, tick)
        self.ticks += 1

    def end(self, log: Path) -> None:
        """Add the last tick to the poses, as a run does, and hold all against the recorded truth.

        It is read only now that the core has ended.

        Args:
            log: the run's.
        """
        if self.last is not None:
            observation, tick = self.last
            if self.frames[-1:] == [] or self.frames[-1][0] != self.ticks - 1:
                self.ticks -= 1
                self._frame(observation.time_ns, tick)
                # No picture, no other stairs.
                self.stairs.update((), climbing=bool(tick.footsteps), lost=tick.lost)
                self.ticks += 1
        for _, time_ns, pose, _, _ in self.frames:
            self.estimate.add(time_ns, pose)
        wanted = {frame[0]: frame for frame in self.frames}
        with suppress(BrokenLogError):  # told with the observations
            # A row is of after its tick, as the next one's senses see it; the first has no other.
            rows = read_truth(log)
            first = next(rows, None)
            before = [] if first is None else [first]
            for number, row in enumerate(chain(before, before, rows)):
                if number in wanted:
                    _, time_ns, estimate, odometry, lost = wanted[number]
                    truth = pose_matrix(row[0], row[1], row[2], 0.0)
                    truth[:3, :3] = rotation_of(row[3:])
                    self.errors.add(estimate, odometry, truth)
                    if lost:
                        self.errors.add_lost()
                    self.truth.add_row(time_ns, row)

    def _frame(self, time_ns: int, tick: Tick) -> None:
        poses = pose_matrix(*tick.estimate), pose_matrix(*tick.odometry)
        self.frames.append((self.ticks, time_ns, *poses, tick.lost))
