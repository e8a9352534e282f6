"""What the messages say, on both sides: version 1. `docs/how_to/serve.md` tells it to others."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Tick
from treadwell.observation import Floats, Frame, Observation
from treadwell.protocols import Pose
from treadwell.recording.cdr import LATEST_NS
from treadwell.scenario.messages import nearest, shortened, shown
from treadwell.serving.framing import Message, ProtocolError

VERSION: Final = 1
"""Of the protocol: another number, another meaning. A server speaks one."""
HELLO, OBSERVATION, TARGETS, GOODBYE, ERROR = "hello", "observation", "targets", "goodbye", "error"
"""Types of messages."""
STATIC_MAP: Final = "static_map"
_TIMES: Final = ("exposure_ns", "arrival_ns")


@dataclass(frozen=True, slots=True)
class Shapes:
    """What a robot's arrays must be: how many joints, and the depth image's rows and columns."""

    joints: int
    image: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class Targets:
    """The core's answer to one observation.

    Attributes:
        time_ns: the observation's.
        position: (n,) rad, joint order.
        velocity: (n,) rad/s.
        torque: (n,) N·m, on top of the servo's own.
        estimate: (x m, y m, z m, yaw rad) of the robot's frame in the map, as believed.
        odometry: the same by the legs alone.
        state: name of the behaviour's state.
        outcome: `goal_reached`, `refused` or None.
        reason: why it refuses.
        goals_passed: how many via points are behind it.
    """

    time_ns: int
    position: Floats
    velocity: Floats
    torque: Floats
    estimate: Pose
    odometry: Pose
    state: str
    outcome: str | None
    reason: str | None
    goals_passed: int


def kind_of(message: Message) -> str:
    """Return a message's type.

    Raises:
        ProtocolError: it has none.
    """
    kind = message.header.get("type")
    if not isinstance(kind, str):
        raise ProtocolError(f"the header: type: found {shown(kind)}; must be a message's type")
    return kind


def check_keys(message: Message, keys: Collection[str], arrays: Collection[str]) -> None:
    """Refuse keys and arrays that a message has not.

    Raises:
        ProtocolError: there is one; the message names it.
    """
    kind = message.header.get("type")
    for what, found, allowed in (
        ("key", message.header, ("type", *keys)),
        ("array", message.arrays, tuple(arrays)),
    ):
        for name in found:
            if name not in allowed:
                known = f"allowed: {', '.join(allowed)}" if allowed else "it has none"
                near = nearest(name, allowed)
                raise ProtocolError(f"{kind}: {shortened(name, 60)}: unknown {what}; {known}{near}")


def observation_message(observation: Observation) -> tuple[dict[str, Any], dict[str, Floats]]:
    """Return the header and the arrays of a tick's measurements."""
    header: dict[str, Any] = {"type": OBSERVATION, "time_ns": observation.time_ns}
    arrays: dict[str, NDArray[Any]] = {
        "joint_positions": observation.joint_positions,
        "joint_velocities": observation.joint_velocities,
        "angular_velocity": observation.angular_velocity,
        "specific_force": observation.specific_force,
        "foot_forces": observation.foot_forces,
    }
    if observation.depth is not None:
        header |= {name: getattr(observation.depth, name) for name in _TIMES}
        arrays["depth"] = observation.depth.depth
    return header, arrays


def observation_of(message: Message, shapes: Shapes) -> Observation:
    """Return the measurements of a message.

    Raises:
        ProtocolError: something is missing, of another type or shape, or not finite.
    """
    wanted = {
        "joint_positions": (shapes.joints,),
        "joint_velocities": (shapes.joints,),
        "angular_velocity": (3,),
        "specific_force": (3,),
        "foot_forces": (2, 4),
    }
    check_keys(message, ("time_ns", *_TIMES), (*wanted, "depth"))
    time_ns = _time(message, "time_ns", LATEST_NS)
    arrays = {name: _array(message, name, "float64", shape) for name, shape in wanted.items()}
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise ProtocolError(f"{OBSERVATION}: {name}: has a number that is not finite")
    frame = None
    if "depth" in message.arrays:
        arrival_ns = _time(message, "arrival_ns", time_ns)
        exposure_ns = _time(message, "exposure_ns", arrival_ns)
        depth = _array(message, "depth", "float32", shapes.image)
        frame = Frame(exposure_ns=exposure_ns, arrival_ns=arrival_ns, depth=depth)
    elif message.header.keys() & set(_TIMES):
        raise ProtocolError(f"{OBSERVATION}: has the times of a depth image, and no array depth")
    return Observation(time_ns=time_ns, depth=frame, **arrays)


def targets_message(
    time_ns: int, tick: Tick, goals_passed: int
) -> tuple[dict[str, Any], dict[str, Floats]]:
    """Return the header and the arrays of an answer."""
    header = {
        "type": TARGETS,
        "time_ns": time_ns,
        "state": tick.state,
        "outcome": tick.outcome,
        "reason": tick.reason,
        "goals_passed": goals_passed,
    }
    arrays = {
        "position": tick.positions,
        "velocity": tick.velocities,
        "torque": tick.torques,
        "estimate": np.array(tick.estimate),
        "odometry": np.array(tick.odometry),
    }
    return header, arrays


def targets_of(message: Message, joints: int) -> Targets:
    """Return the answer of a message.

    Raises:
        ProtocolError: something is missing, or of another type or shape.
    """
    header = message.header
    position, velocity, torque = (
        _array(message, name, "float64", (joints,)) for name in ("position", "velocity", "torque")
    )
    poses = [_array(message, name, "float64", (4,)).tolist() for name in ("estimate", "odometry")]
    passed, texts = header.get("goals_passed"), [header.get(k) for k in ("state", "outcome")]
    reason = header.get("reason")
    if not isinstance(texts[0], str) or not all(
        each is None or isinstance(each, str) for each in (*texts, reason)
    ):
        raise ProtocolError(f"{TARGETS}: state, outcome and reason: must be texts")
    return Targets(
        _time(message, "time_ns", LATEST_NS),
        position,
        velocity,
        torque,
        tuple(poses[0]),
        tuple(poses[1]),
        texts[0],
        texts[1],
        reason,
        passed if isinstance(passed, int) else 0,
    )


def _time(message: Message, key: str, latest_ns: int) -> int:
    value = message.header.get(key)
    if type(value) is not int or not 0 <= value <= latest_ns:
        raise ProtocolError(
            f"{message.header.get('type')}: {key}: found {shown(value)}; "
            f"must be whole nanoseconds, 0 to {latest_ns}"
        )
    return value


def _array(message: Message, name: str, dtype: str, shape: tuple[int, ...]) -> NDArray[Any]:
    kind = message.header.get("type")
    array = message.arrays.get(name)
    if array is None:
        raise ProtocolError(f"{kind}: {name}: is missing; an array of {_form(dtype, shape)}")
    if array.dtype != dtype or array.shape != shape:
        raise ProtocolError(
            f"{kind}: {name}: found {_form(array.dtype.name, array.shape)}; "
            f"must be {_form(dtype, shape)}"
        )
    return array


def _form(dtype: str, shape: tuple[int, ...]) -> str:
    return f"{dtype} {list(shape)}"
