"""Broken senses: what a fault makes of what was measured. What is whole passes as it is."""

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from treadwell.observation import Frame, Observation

Floats = NDArray[np.float64]

NEAREST_OUTLIER_M: Final = 0.1
"""An outlier's depth is at least this, m,"""
FARTHEST_OUTLIER_M: Final = 3.0
"""and at most this, m."""


class SenseFault(Protocol):
    """What is broken, as a scenario's event says it."""

    @property
    def part(self) -> str:
        """Which sense."""

    @property
    def kind(self) -> str:
        """How it is broken."""

    @property
    def value(self) -> float | None:
        """How much."""

    @property
    def joint(self) -> str | None:
        """Whose encoder."""

    @property
    def foot(self) -> str | None:
        """Whose force cells."""

    @property
    def cell(self) -> int | None:
        """Which of them."""


class SenseFaults:
    """What is broken now, and what it needs to remember: call `apply` at every control tick."""

    def __init__(self, joints: Mapping[str, int], rng: np.random.Generator) -> None:
        """Begin with whole senses.

        Args:
            joints: name -> place in the joint order.
            rng: for outliers and frames that are lost.
        """
        self._joints = joints
        self._rng = rng
        self._active: list[SenseFault] = []
        self._frozen: NDArray[np.float32] | None = None
        self._stuck: dict[int, float] = {}
        self._late: deque[tuple[int, Floats, Floats]] = deque()
        self._depth: dict[str, Callable[[Frame, float], Frame | None]] = {
            "nan": lambda frame, _: replace(frame, depth=np.full_like(frame.depth, np.nan)),
            "freeze": self._freeze,
            "scale": lambda frame, factor: replace(frame, depth=frame.depth * np.float32(factor)),
            "outliers": self._outliers,
            "drop": lambda frame, share: None if self._rng.random() < share else frame,
        }

    def set(self, active: list[SenseFault]) -> None:
        """Say what is broken from now on."""
        self._active = active
        kinds = {(fault.part, fault.kind) for fault in active}
        if ("depth", "freeze") not in kinds:
            self._frozen = None
        if ("latency", "imu") not in kinds:
            self._late.clear()
        stuck = {self._joints[f.joint] for f in active if f.part == "encoders" and f.joint}
        self._stuck = {at: value for at, value in self._stuck.items() if at in stuck}

    def apply(self, observation: Observation) -> Observation:
        """Return what the broken senses say in place of whole ones."""
        for fault in self._active:
            match fault.part:
                case "depth":
                    observation = self._see(observation, fault)
                case "imu":
                    observation = _inertial(observation, fault)
                case "encoders":
                    observation = self._stick(observation, fault)
                case "feet":
                    observation = _feet(observation, fault)
                case "latency" if fault.kind == "imu":
                    observation = self._delay(observation, fault.value or 0.0)
        return observation

    def encoder_errors(self, observation: Observation) -> dict[int, float]:
        """Return by how much each stuck encoder reads wrong, rad, by the joint's place.

        Args:
            observation: what whole senses say.
        """
        return {
            at: value - float(observation.joint_positions[at]) for at, value in self._stuck.items()
        }

    def _see(self, observation: Observation, fault: SenseFault) -> Observation:
        if observation.depth is None:
            return observation
        depth = self._depth[fault.kind](observation.depth, fault.value or 0.0)
        return replace(observation, depth=depth)

    def _freeze(self, frame: Frame, _: float) -> Frame:
        if self._frozen is None:
            self._frozen = frame.depth.copy()
        return replace(frame, depth=self._frozen.copy())

    def _outliers(self, frame: Frame, share: float) -> Frame:
        wrong = self._rng.random(frame.depth.shape) < share
        anywhere = self._rng.uniform(NEAREST_OUTLIER_M, FARTHEST_OUTLIER_M, frame.depth.shape)
        return replace(frame, depth=np.where(wrong, anywhere, frame.depth).astype(np.float32))

    def _stick(self, observation: Observation, fault: SenseFault) -> Observation:
        at = self._joints[fault.joint or ""]
        positions, velocities = observation.joint_positions, observation.joint_velocities
        stuck = self._stuck.setdefault(at, float(positions[at]))
        positions, velocities = positions.copy(), velocities.copy()
        positions[at], velocities[at] = stuck, 0.0
        return replace(observation, joint_positions=positions, joint_velocities=velocities)

    def _delay(self, observation: Observation, seconds: float) -> Observation:
        now = (observation.time_ns, observation.angular_velocity, observation.specific_force)
        self._late.append(now)
        while len(self._late) > 1 and (
            self._late[1][0] + round(1e9 * seconds) <= observation.time_ns
        ):
            self._late.popleft()
        _, rate, force = self._late[0]
        return replace(observation, angular_velocity=rate, specific_force=force)


def _inertial(observation: Observation, fault: SenseFault) -> Observation:
    rate, force = observation.angular_velocity, observation.specific_force
    match fault.kind:
        case "bias":
            rate = rate + np.array([0.0, 0.0, fault.value or 0.0])
        case "swap":
            rate, force = rate[[1, 0, 2]], force[[1, 0, 2]]
        case "zero":
            rate, force = np.zeros(3), np.zeros(3)
    return replace(observation, angular_velocity=rate, specific_force=force)


def _feet(observation: Observation, fault: SenseFault) -> Observation:
    forces = observation.foot_forces.copy()
    foot = ("left", "right").index(fault.foot or "left")
    if fault.kind == "dead":
        forces[foot] = 0.0
    else:
        forces[foot, fault.cell or 0] = fault.value or 0.0
    return replace(observation, foot_forces=forces)
