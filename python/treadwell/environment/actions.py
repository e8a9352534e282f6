"""What an agent can do: walk with a velocity and look, or put one foot after the other."""

import math
from collections.abc import Mapping
from typing import Any, Final, Protocol

import gymnasium
import numpy as np

from treadwell._core import Situation
from treadwell.errors import InputError
from treadwell.protocols import Decision, Footstep
from treadwell.scenario.messages import shown

FASTEST: Final = (0.15, 0.1, 0.5)
"""(forward m/s, left m/s, counter-clockwise rad/s) that 1 stands for
in a robot of `qrio`'s size; its own follows its scale."""
STILL: Final = 0.05
"""To ask for less than this of each is to stand."""
WIDEST_PAN_RAD: Final = 0.8
LONGEST_STEP: Final = (0.1, 0.03, 0.3, 0.05)
"""(forward m, outwards m, turn outwards rad, height m) that 1 stands for, likewise."""
LONGEST_STEP_TICKS: Final = 600
"""Control ticks after which a footstep that has not landed is given up."""


def numbers(value: Any, words: tuple[str, ...], where: str = "action") -> list[float]:  # noqa: ANN401
    """Return the numbers of an action, one for each word.

    Args:
        value: what the agent gave.
        words: what the numbers mean, for an error.
        where: what the action's part is called in it.

    Raises:
        InputError: another shape, no numbers, or not finite.
    """
    allowed = f"must be {len(words)} finite numbers: {', '.join(words)}"
    try:
        array = np.asarray(value)
    except (TypeError, ValueError, RuntimeError):
        raise InputError(f"{where}: found {shown(value)}; {allowed}") from None
    if array.dtype.kind not in "fiu":
        raise InputError(f"{where}: found {shown(value)}; {allowed}")
    if array.shape != (len(words),):
        raise InputError(f"{where}: found an array of shape {array.shape}; {allowed}")
    if not np.isfinite(array).all():
        raise InputError(f"{where}: found {shown(array.tolist())}; {allowed}")
    return [float(number) for number in array]


class Actions(Protocol):
    """A kind of action."""

    @property
    def space(self) -> gymnasium.Space[Any]:
        """What actions there are."""

    def decision(self, action: Any) -> Decision:  # noqa: ANN401 - an element of the space
        """Return what the behaviour decides while the action is on.

        Raises:
            InputError: it has not the form of the space's.
        """

    def is_over(self, ticks: int, situation: Situation) -> bool:
        """Say whether the action is done, so many control ticks after it began."""


def gaze_of(pan: float, down: float) -> tuple[float, float]:
    """Return (pan to the left, down from the horizon), rad, for two numbers from -1 to 1.

    0 is straight ahead and 0.5 rad down, -1 the horizon.
    """
    return (WIDEST_PAN_RAD * float(pan), 0.5 + 0.5 * float(down))


class VelocityActions:
    """(forward, left, counter-clockwise, pan, down), from -1 to 1; one camera period long.

    1 is what `FASTEST` says; the walker keeps it within what the gait can do.
    """

    def __init__(self, period_ticks: int, scale: float = 1.0) -> None:
        """Take the camera's period, control ticks, and how large the robot is against `qrio`."""
        self.space = gymnasium.spaces.Box(-1.0, 1.0, (5,), np.float32)
        self._period_ticks = period_ticks
        root = math.sqrt(scale)
        ahead, left, turn = FASTEST
        self._fastest = (ahead * root, left * root, turn / root)

    def decision(self, action: Any) -> Decision:  # noqa: ANN401
        """Walk, or stand where next to nothing is asked for."""
        *shares, pan, down = numbers(
            action, ("forward", "left", "counter-clockwise", "pan", "down")
        )
        gaze = gaze_of(pan, down)
        if max(map(abs, shares)) < STILL:
            return Decision("stand", gaze=gaze)
        ahead, left, turn = (
            most * share for most, share in zip(self._fastest, shares, strict=True)
        )
        return Decision("walk", velocity=(ahead, left, turn), gaze=gaze)

    def is_over(self, ticks: int, _situation: Situation) -> bool:
        """After a camera period."""
        return ticks >= self._period_ticks


class FootstepActions:
    """One footstep: `foot`, where to put it (`step`), and `gaze`; over when the robot stands again.

    `foot`: 0 to stand for a camera period, 1 left, 2 right. `step`: (forward, outwards, turn
    outwards, height of the surface there) from -1 to 1, from where the foot stands beside the
    other; 1 is what `LONGEST_STEP` says, and inwards a foot does not go.
    """

    def __init__(
        self, period_ticks: int, stance_m: float, sole_m: float, scale: float = 1.0
    ) -> None:
        """Take what the robot is like.

        Args:
            period_ticks: the camera's period, control ticks.
            stance_m: the distance between the feet, m.
            sole_m: the length of a sole, m.
            scale: how large the robot is against `qrio`.
        """
        self.space = gymnasium.spaces.Dict(
            {
                "foot": gymnasium.spaces.Discrete(3),
                "step": gymnasium.spaces.Box(-1.0, 1.0, (4,), np.float32),
                "gaze": gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float32),
            }
        )
        self._period_ticks = period_ticks
        self._half_stance_m = 0.5 * stance_m
        self._half_sole_m = 0.5 * sole_m
        ahead, outwards, turn, height = LONGEST_STEP
        self._longest = (ahead * scale, outwards * scale, turn, height * scale)
        self._steps = False
        self._lifted = False

    def decision(self, action: Any) -> Decision:  # noqa: ANN401
        """Take the step, or stand."""
        if not isinstance(action, Mapping) or action.keys() != self.space.keys():
            keys = ", ".join(action) if isinstance(action, Mapping) else type(action).__name__
            raise InputError(f"action: found {keys}; must be a dict of foot, step and gaze")
        shares = numbers(action["step"], ("forward", "outwards", "turn", "height"), "action: step")
        gaze = gaze_of(*numbers(action["gaze"], ("pan", "down"), "action: gaze"))
        (foot,) = numbers(np.atleast_1d(action["foot"]), ("foot",), "action: foot")
        if foot not in {0.0, 1.0, 2.0}:
            raise InputError(f"action: foot: found {foot:g}; must be 0 to stand, 1 left, 2 right")
        self._steps, self._lifted = foot > 0.0, False
        if not self._steps:
            return Decision("stand", gaze=gaze)
        ahead, outwards, turn, height = (
            most * share for most, share in zip(self._longest, shares, strict=True)
        )
        side, sign = ("left", 1.0) if foot == 1.0 else ("right", -1.0)
        step = Footstep(
            side,
            ahead,
            sign * (self._half_stance_m + max(0.0, outwards)),
            sign * max(0.0, turn),
            height,
            -self._half_sole_m,
            self._half_sole_m,
        )
        return Decision("step", footsteps=(step,), gaze=gaze)

    def is_over(self, ticks: int, situation: Situation) -> bool:
        """When the robot stands again, after a camera period where it did nothing else."""
        if not self._steps:
            return ticks >= self._period_ticks
        self._lifted |= not situation.standing
        return (self._lifted and situation.standing) or ticks >= LONGEST_STEP_TICKS
