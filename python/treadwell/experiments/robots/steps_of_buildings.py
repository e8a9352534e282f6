"""Steps as buildings have them, in metres: for robots as tall as a child."""

import math
from typing import Any, Final

from treadwell.experiments.world.parts import between, platform, scenario, spread

DEPTH_M: Final = 0.28
"""Depth of a tread."""
RISES_M: Final = (0.12, 0.17)
"""Low steps, as those before a house, and those of a staircase."""
_STEPS: Final = 4
_WIDTH_M: Final = 1.0
_LANDING_M: Final = 1.2
_FOOT_M: Final = 1.6
"""How far ahead of the start the lowest step is, up; the way to the goal below, down."""
_EDGE_M: Final = 1.3
"""How far ahead of the start the platform ends."""
_TIME_LIMIT_S: Final = 240.0
_TOP_M: Final = (3.0, 2.4)
"""Length and width of the platform."""
_TURN: Final = 0.35
_SIDEWAYS_M: Final = 0.25


def stairs_of_a_building(robot: str, rise: float, way: str, _seed: int) -> dict[str, Any]:
    """Return the scenario: four steps of one rise, m, `up` to a landing or `down` from a platform.

    Start and heading are drawn from what the seed says, as in `stairs_up` and `stairs_down`.
    """
    high, run = _STEPS * rise, (_STEPS - 1) * DEPTH_M
    flight = {"kind": "stairs", "name": "stairs", "rise": rise, "tread": DEPTH_M, "width": _WIDTH_M}
    vary = {"start.yaw": spread(_TURN), "start.position.1": spread(_SIDEWAYS_M)}
    if way == "up":
        place = {"position": [_FOOT_M, 0.0], "steps": _STEPS, "landing": _LANDING_M}
        goal = {"position": [_FOOT_M + run + _LANDING_M / 2, 0.0], "height": high, "radius": 0.3}
        vary["start.position.0"] = spread(0.4)
        made = scenario("steps", goal, [flight | place], vary=vary)
    else:
        below = _EDGE_M + run
        place = {
            "position": [below, 0.0],
            "yaw": math.pi,
            "steps": _STEPS - 1,
            "landing": DEPTH_M,
        }
        goal = {"position": [below + _FOOT_M, 0.0], "height": 0.0, "radius": 0.3}
        top = platform("platform", (_EDGE_M - _TOP_M[0] / 2, 0.0), (*_TOP_M, high))
        vary["start.position.0"] = between(-0.6, 0.2)
        made = scenario("steps", goal, [top, flight | place], start={"height": high}, vary=vary)
    return {**made, "robot": robot, "time_limit": _TIME_LIMIT_S}
