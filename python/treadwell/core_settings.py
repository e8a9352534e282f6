"""What the core is told before the first tick, and the components that take a named one's place."""

import json
import re
from typing import Any

from treadwell._core import Pilot
from treadwell.components import COMPONENTS
from treadwell.course.build import Course
from treadwell.errors import InputError
from treadwell.plugins import check_component, load_component
from treadwell.robot.load import Robot
from treadwell.scenario.messages import nearest
from treadwell.scenario.model import Scenario


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


def build_core(scenario: Scenario, settings: str, components: dict[str, Any]) -> Pilot:
    """Return the core.

    Args:
        scenario: for the file's name in an error.
        settings: what `core_settings` returned.
        components: what `user_components` returned.

    Raises:
        InputError: a parameter is unknown or cannot be; the message names file, key and spelling.
    """
    try:
        return Pilot(settings, **components)
    except InputError as error:
        words = re.findall(r"`(\w+)`", str(error))
        unknown = "unknown field" in str(error) and len(words) > 1
        hint = nearest(words[0], words[1:]) if unknown else ""
        raise InputError(f"{scenario.path or scenario.name}: {error}{hint}") from None
