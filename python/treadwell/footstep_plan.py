"""Planned footsteps as plain data: of a run's behaviour, or of a plan over heights of one's own."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class PlannedFootstep:
    """One step of a plan.

    Attributes:
        side: the foot that moves.
        x: of the middle of its sole in the frame of the heights, m.
        y: as `x`.
        yaw: its heading, rad.
        height: of the plane on which it rests, under its middle, m.
        slope: how that plane rises forward and to the left.
        bearing: the part of the sole that bears, from and to, from its middle forward, m.
        bearing_share: of the sole's area.
        manner: as the robot walks, or carefully, from a stand.
        time: that the step takes, s.
        partial: what it costs that the sole bears in part, or on uneven ground, s.
        margin: what it costs that not all of the ground beside it is known and within reach, s.
        turn: what it costs that the foot turns, s.
    """

    side: Literal["left", "right"]
    x: float
    y: float
    yaw: float
    height: float
    slope: tuple[float, float]
    bearing: tuple[float, float]
    bearing_share: float
    manner: Literal["walked", "careful"]
    time: float
    partial: float
    margin: float
    turn: float

    def forward(self) -> tuple[float, float]:
        """Return its direction in the plane."""
        return math.cos(self.yaw), math.sin(self.yaw)

    @property
    def cost(self) -> float:
        """What the step costs, s."""
        return self.time + self.partial + self.margin + self.turn


@dataclass(frozen=True, slots=True, repr=False)
class FootstepPlan:
    """Steps to a goal, or why there are none. Iterating over it gives the steps.

    Attributes:
        steps: from the first on; the last one puts the feet side by side.
        reason: why there are none, or None.
        cost: of all steps, s; NaN without any.
        whole_cost: of the way to the goal, s: the steps, and what leads on over ground that was
            not seen, as far as that can be told.
        epsilon: they cost no more than so many times the cheapest, as far as the search's
            estimates are right.
        first_cost: what the first plan cost that was found, s.
        expanded: places of a foot that the search looked on from.
        refused: why steps that the user's planner listed were not taken, last time that they were
            not; None where that was never so.
    """

    steps: tuple[PlannedFootstep, ...]
    reason: str | None = None
    cost: float = math.nan
    whole_cost: float = math.nan
    epsilon: float = math.nan
    first_cost: float = math.nan
    expanded: int = 0
    refused: str | None = None

    def __iter__(self) -> Iterator[PlannedFootstep]:
        """Give the steps one after the other."""
        return iter(self.steps)

    def __len__(self) -> int:
        """Return how many steps there are."""
        return len(self.steps)

    def __repr__(self) -> str:
        if self.reason is not None:
            return f"<FootstepPlan none: {self.reason}>"
        return f"<FootstepPlan {len(self.steps)} steps, {self.cost:.1f} s>"


def plan_of(found: Mapping[str, Any]) -> FootstepPlan:
    """Return a plan that the core gives as a dict."""
    if found.get("reason") is not None:
        return FootstepPlan((), found["reason"], refused=found.get("refused"))
    steps = [
        PlannedFootstep(side, x, y, yaw, height, slope, bearing, share, manner, *costs)
        for (side, manner), costs, (x, y, yaw), stands in found["steps"]
        for height, slope, bearing, share in [stands]
    ]
    return FootstepPlan(
        tuple(steps),
        cost=found["cost"],
        whole_cost=found["whole"],
        epsilon=found["epsilon"],
        first_cost=found["first"][0],
        expanded=found["expanded"],
        refused=found.get("refused"),
    )
