"""What the core is told before the first tick, and the components that take a named one's place."""

import json
from typing import Any

from treadwell.components import COMPONENTS
from treadwell.course import Course
from treadwell.plugins import check_component, load_component
from treadwell.robot import Robot
from treadwell.scenario import Scenario

INJECTED = ("truth",)
"""Components that the harness makes itself, since they know what the core must not."""


def core_settings(scenario: Scenario, robot: Robot, course: Course) -> str:
    """Return robot, start, goals and navigation as JSON. No truth but the start."""
    goal = scenario.goal
    places = [{"position": list(via), "radius": goal.radius} for via in goal.via]
    places.append({"position": list(goal.position), "radius": goal.radius, "height": goal.height})
    start = course.start
    settings = {
        "robot": robot.description(),
        "start": {"position": list(start.position), "height": start.height, "yaw": start.yaw},
        "goals": places,
        "navigation": {**scenario.navigation.slots(), **scenario.navigation.parameters()},
    }
    return json.dumps(settings, allow_nan=False)


def user_components(scenario: Scenario, given: dict[str, object]) -> dict[str, Any]:
    """Return the components that are Python objects, by slot.

    Args:
        scenario: names those to load, as `package.module:Class`.
        given: objects that the caller brings; they beat the scenario's.

    Raises:
        InputError: one cannot be loaded, or lacks a method.
    """
    for slot, component in given.items():
        check_component(slot, component)
    loaded = {
        slot: load_component(
            slot, name, scenario.navigation.parameters().get(name.partition(":")[2], {})
        )
        for slot, name in scenario.navigation.slots().items()
        if slot not in given and name not in COMPONENTS[slot]
    }
    return {**loaded, **given}
