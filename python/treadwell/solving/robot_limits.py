"""What a robot can do by its folder and the scenario, for a search on the true course.

Its width and height, with the sway of a walk, are those of `[body]` in its `robot.toml`; steps are
those of `[navigation.climbing]` there; of slopes `STEEPEST` holds for all.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Final

from treadwell.core_settings import navigation_parameters
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario

STEEPEST: Final = math.radians(10.0)
"""A slope that is walked on; up to 12 degrees a robot may refuse or walk, steeper it refuses."""
FOOT_GAP: Final = 0.01
"""Metres between the feet side by side, of a robot of scale 1."""


@dataclass(frozen=True, slots=True)
class OneWay:
    """The limits of steps up, or of steps down, as in `[navigation.climbing.ascend]`."""

    highest: float
    front_x_limit: float
    back_x_limit: float

    def multiplied(self, factor: float) -> "OneWay":
        """Return the same with all lengths multiplied."""
        own = (self.highest, self.front_x_limit, self.back_x_limit)
        return OneWay(*(factor * each for each in own))


@dataclass(frozen=True, slots=True)
class Limits:
    """What a robot can do, by its folder and the scenario, metres and radians."""

    radius: float
    tall: float
    sole: float
    pair: float
    floor_max: float
    tolerance: float
    side_room: float
    steepest: float
    up: OneWay
    down: OneWay

    @property
    def half_width(self) -> float:
        """Half of what both feet need on a stair."""
        return self.pair / 2 + self.side_room

    def multiplied(self, factor: float) -> "Limits":
        """Return the same with all lengths multiplied."""
        keys = ("radius", "tall", "sole", "pair", "floor_max", "tolerance", "side_room")
        own = replace(self, **{key: factor * getattr(self, key) for key in keys})
        return replace(own, up=self.up.multiplied(factor), down=self.down.multiplied(factor))

    def for_(self, rise: float) -> OneWay:
        """Return the limits of a change of height."""
        return self.up if rise > 0.0 else self.down


def limits_of(scenario: Scenario, robot: Robot) -> Limits:
    """Return a robot's limits; where nothing is published, the core's defaults for its scale."""
    body, sole = robot.file.body, robot.file.legs.left.sole
    parameters = navigation_parameters(scenario, robot)
    climbing: dict[str, Any] = parameters.get("climbing", {})
    up, down = climbing.get("ascend", {}), climbing.get("descend", {})
    planner = parameters.get(scenario.navigation.planner, {})
    scale = robot.scale
    turned = body.depth if planner.get("footprint") == "oriented" else None
    return Limits(
        radius=turned / 2 if turned else body.radius,
        tall=body.height,
        sole=sole.length,
        pair=2 * sole.width + FOOT_GAP * scale,
        floor_max=climbing.get("floor_max", 0.01 * scale),
        tolerance=climbing.get("tolerance", 0.0025 * scale),
        side_room=climbing.get("side_room", 0.02 * scale),
        steepest=STEEPEST,
        up=OneWay(
            up.get("step_max_z", 0.050 * scale),
            up.get("front_x_limit", -0.025 * scale),
            up.get("back_x_limit", -0.005 * scale),
        ),
        down=OneWay(
            -down.get("step_min_z", -0.050 * scale),
            down.get("front_x_limit", 0.015 * scale),
            down.get("back_x_limit", 0.025 * scale),
        ),
    )
