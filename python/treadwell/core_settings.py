"""What the core is told before the first tick, and the components that take a named one's place."""

import json
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from treadwell._core import Goal, Octree, Pilot
from treadwell.errors import InputError
from treadwell.guard import Guard
from treadwell.plugins import (
    brought_component,
    foreign_parts,
    load_component,
    refuse_user_code,
)
from treadwell.protocols import Setup
from treadwell.scenario.messages import nearest, report
from treadwell.scenario.model import Navigation, Scenario
from treadwell.scenario.values import flag

if TYPE_CHECKING:
    # A replay tells the core the same without MuJoCo, which these two need.
    from treadwell.course.course import Course
    from treadwell.robot.load import Robot

MAPPED = frozenset({"monte_carlo", "octree"})
"""Components that are told a static map."""

TOLD = ("odometry", "scan_match", "fast_slam")
"""Localizers that cannot find where the robot is, but have to be told where it starts."""


@dataclass(frozen=True, slots=True, eq=False)
class CoreInput:
    """All that a core is made of: with it a recording can make the same one again.

    Attributes:
        settings: what `core_settings` returned.
        robot_navigation: the robot's own parameters, over which a scenario's go.
        static_map: what `told_map` returned.
        given: slot -> `package.module:Class` of an object that the caller brought.
    """

    settings: str
    robot_navigation: Mapping[str, Any] = field(default_factory=dict)
    static_map: Octree | None = None
    given: Mapping[str, str] = field(default_factory=dict)


_SAME_LEVEL = 0.02
"""Metres: heights so near are one level, on a course of scale 1."""


def core_settings(scenario: Scenario, robot: "Robot", course: "Course") -> str:
    """Return robot, start, goals and navigation as JSON. No truth but the start, where it is known.

    Of a start that is not known the core is told nothing. A goal that lies on another level than
    the start is told with its height, also where the scenario leaves it at the highest surface.
    """
    goal = scenario.goal
    apart = abs(course.goal_height - course.start.height)
    other_level = apart > _SAME_LEVEL * course.scale
    goal_height = course.goal_height if goal.height is None and other_level else goal.height
    place = course.start
    start = {"position": list(place.position), "height": place.height, "yaw": place.yaw}
    return told_settings(scenario, robot, start, goal_height)


def told_settings(
    scenario: Scenario, robot: "Robot", start: Mapping[str, Any], goal_height: float | None
) -> str:
    """Return robot, start, goals and navigation as JSON, of a place that need not be a course.

    Args:
        scenario: with goal and navigation.
        robot: the robot.
        start: position m, height of the ground m and yaw rad; told where the scenario says that
            it is known.
        goal_height: m; None: the goal counts on any level.
    """
    goal = scenario.goal
    places = [{"position": list(via), "radius": goal.radius} for via in goal.via]
    places.append({"position": list(goal.position), "radius": goal.radius, "height": goal_height})
    settings = {
        "robot": robot.description(),
        "start": start if scenario.start.known else None,
        "goals": places,
        "navigation": navigation_settings(scenario.navigation, robot.file.navigation),
    }
    return json.dumps(settings, allow_nan=False)


def navigation_settings(navigation: Navigation, of_robot: Mapping[str, Any]) -> dict[str, Any]:
    """Return the table `navigation` of the core's settings.

    Args:
        navigation: the scenario's table.
        of_robot: the robot's own parameters.
    """
    tables = over(of_robot, navigation.parameters())
    told = tables.get("static_map")
    if isinstance(told, dict):
        # The core is told the file's map, not the file.
        tables["static_map"] = {key: value for key, value in told.items() if key != "file"}
    return {**navigation.slots(), **tables}


def told_map(scenario: Scenario, robot: "Robot", course: "Course") -> Octree | None:
    """Return the map that the robot is told, None when no component needs it and nobody asks.

    A table `[navigation.static_map]` asks for it: a component of the user's may read it.

    Raises:
        InputError: `[navigation.static_map]` or the file that it names is bad, or the course too
            large for it.
    """
    asked = "static_map" in scenario.navigation.parameters()
    if not asked and not MAPPED & set(scenario.navigation.slots().values()):
        return None
    from treadwell.course.static_map import told_octree

    where = str(scenario.path or scenario.name)
    table = scenario.navigation.parameters().get("static_map", {})
    return told_octree(course, table, scenario.folder, where, robot.scale)


def navigation_parameters(scenario: Scenario, robot: "Robot") -> dict[str, Any]:
    """Return the components' parameters: the robot's own, and a scenario's over them."""
    return over(robot.file.navigation, scenario.navigation.parameters())


def over(own: Mapping[str, Any], asked: Mapping[str, Any]) -> dict[str, Any]:
    """Return a robot's own parameters with those that are asked for over them, table by table."""
    both = dict(own)
    for key, value in asked.items():
        table = both.get(key)
        if isinstance(table, dict) and isinstance(value, dict):
            value = over(table, value)
        both[key] = value
    return both


def user_components(
    scenario: Scenario, given: dict[str, object], *, user_code: bool = True
) -> dict[str, Any]:
    """Return the components that are Python objects, by slot.

    Args:
        scenario: names those to load, as `package.module:Class`.
        given: objects that the caller brings, or their classes; they beat the scenario's.
        user_code: False: the scenario may name no class.

    Raises:
        InputError: one cannot be loaded, lacks a method, or cannot do without a known start; or
            the scenario names a class and may not.
    """
    parameters = scenario.navigation.parameters()
    brought = {slot: brought_component(slot, part, parameters) for slot, part in given.items()}
    if (
        not scenario.start.known
        and scenario.navigation.localizer in TOLD
        and "localizer" not in given
    ):
        raise InputError(
            f"{scenario.path or scenario.name}: start.known: found false; the localizer "
            f"{scenario.navigation.localizer} has to be told where it starts"
        )
    where = str(scenario.path or scenario.name)
    slots = {slot: name for slot, name in scenario.navigation.slots().items() if slot not in given}
    parts = foreign_parts(slots)
    if not flag("user_code", user_code):
        refuse_user_code(parts, where)
    loaded = {}
    for part in parts:
        own = parameters.get(part.name.rpartition(":")[2], {})
        try:
            loaded[part.slot] = load_component(part.slot, part.name, own)
        except InputError as error:
            raise InputError(report(where, [str(error)], given=scenario.set_keys)) from error
    return {**loaded, **brought}


def guards(
    scenario: Scenario, components: dict[str, object], objects: Collection[str]
) -> dict[str, Guard]:
    """Return the user's components as the core gets them: with a limit on each call.

    Args:
        scenario: names those that it brings, and has the limit.
        components: what `user_components` returned.
        objects: slots of those that the caller brought as objects; they are called by their class.
    """
    names = scenario.navigation.slots()
    names |= {slot: type(components[slot]).__name__ for slot in objects}
    limit_s = scenario.navigation.call_limit
    return {slot: Guard(slot, names[slot], part, limit_s) for slot, part in components.items()}


def setup_of(settings: str, static_map: Octree | None) -> Setup:
    """Return what components are told, of what `core_settings` returned."""
    told = json.loads(settings)
    start, goals = told["start"], told["goals"]
    pose = start and (*start["position"], start["height"], start["yaw"])
    places = (Goal(tuple(one["position"]), one["radius"], one.get("height")) for one in goals)
    return Setup(pose, tuple(places), told["robot"], static_map)


def _begin(components: Mapping[str, object], setup: Setup, where: str) -> None:
    """Tell the components that ask for it what the core is told.

    Raises:
        InputError: one raised an exception.
    """
    for slot, component in components.items():
        begin = getattr(component, "begin", None)
        if begin is None:
            continue
        try:
            begin(setup)
        except (Exception, SystemExit) as error:
            name = component.name if isinstance(component, Guard) else type(component).__name__
            raise InputError(f"{where}: navigation.{slot}: {name}.begin: {error!r}") from error


def build_core(
    scenario: Scenario, settings: str, components: dict[str, Any], static_map: Octree | None = None
) -> Pilot:
    """Return the core.

    Args:
        scenario: for the file's name in an error.
        settings: what `core_settings` returned.
        components: what `user_components` returned.
        static_map: what `told_map` returned.

    Raises:
        InputError: a parameter is unknown or cannot be, or the robot's gait has one that cannot;
            the message names file, key and spelling.
    """
    _begin(components, setup_of(settings, static_map), str(scenario.path or scenario.name))
    try:
        return Pilot(settings, static_map=static_map, **components)
    except InputError as error:
        words = re.findall(r"`(\w+)`", str(error))
        unknown = "unknown field" in str(error) and len(words) > 1
        hint = nearest(words[0], words[1:]) if unknown else ""
        of_robot = str(error).startswith(("walker: ", "robot: "))
        where = f"robot {scenario.robot}" if of_robot else str(scenario.path or scenario.name)
        raise InputError(report(where, [f"{error}{hint}"], given=scenario.set_keys)) from None
