"""The components that an environment puts in: a behaviour that obeys, a planner that does not."""

import math
from dataclasses import replace
from typing import Final

from treadwell._core import FloorView, Goal, Situation, Staircase
from treadwell.protocols import Decision, Plan, Pose

ARRIVED: Final = 0.6
"""Share of the goal's radius within which the robot says that it has arrived."""
LEVEL_M: Final = 0.015
"""Difference from the goal's height, where it has one, up to which it does."""


class Commanded:
    """A behaviour: does what the action says.

    It knows where the robot believes to be: it passes via points, and at the goal it stands still
    and says that it has arrived, whatever the action.

    Attributes:
        decision: what the action asks for.
        situation: of the last tick; None before the first.
        arrived: whether it has said so.
        level_m: heights so near are one level, m.
    """

    def __init__(self, goal_height: float | None) -> None:
        """Stand, on the way to a goal on a level, m; None where any will do."""
        self.decision = Decision("stand")
        self.situation: Situation | None = None
        self.arrived = False
        self._goal_height = goal_height
        self.level_m = LEVEL_M

    def next(self, situation: Situation) -> Decision:
        """Return what the action asks for, or the arrival."""
        self.situation = situation
        x, y, z, _ = situation.estimate
        away = math.dist((x, y), situation.goal)
        if not situation.last_goal:
            return replace(self.decision, goal_passed=away <= situation.goal_radius)
        level = self._goal_height is None or abs(z - self._goal_height) <= self.level_m
        self.arrived |= level and away <= ARRIVED * situation.goal_radius
        if self.arrived:
            return Decision("arrived", gaze=self.decision.gaze, outcome="goal_reached")
        return self.decision


class NoPlanner:
    """A planner: none is needed where the agent finds the way."""

    def plan(self, _view: FloorView, _stairs: Staircase, _start: Pose, _goal: Goal) -> Plan:
        """Return no way."""
        return Plan(None, "the agent finds the way", replanned=False)
