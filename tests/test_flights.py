"""Flights that draw themselves: within their bounds, solvable where none closes them, for both."""

from collections import Counter
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import pytest
from episode_builders import qrio
from test_course import course_of, scenario_of

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.outlines import signed_distance
from treadwell.course.scatter import overlap
from treadwell.course.worlds.drawing import STOP, Budget, World, away, is_closed
from treadwell.course.worlds.flight_shapes import STANDING, USED, Level, shape, with_heights
from treadwell.course.worlds.flights import drawn_flights
from treadwell.course.worlds.raised_floor import HIGH
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.drawn_elements import FLIGHT_SHAPES, FLIGHT_THINGS, Flights
from treadwell.scenario.elements import Platform, Stairs
from treadwell.scenario.loading import load_scenario
from treadwell.solving.solvable import is_solvable

FAMILY = "random_flights"
GOAL = {"goal": {"position": [2.8, 0.0]}}
STOPS = [np.array([0.0, 0.0]), np.array([2.8, 0.0])]


def things(course: Course) -> set[str]:
    return {element.name.split(".")[1].split(" ")[0] for element in course.elements}


def rises(flights: Flights, seed: int) -> list[float]:
    """The differences between neighbouring levels of what is drawn, from the ground up."""
    heights = [0.0]
    for element in drawn_flights(flights, "flights", seed=seed, stops=STOPS).elements:
        if isinstance(element, Stairs):
            heights += np.cumsum(element.rises()).tolist()
        elif isinstance(element, Platform):
            heights.append(element.size[2])
    return [float(rise) for rise in np.diff(heights)]


def test_every_drawn_course_is_built_and_one_stop_is_above() -> None:
    """`build_course` refuses a start inside an obstacle or over an edge."""
    above = Counter[bool]()
    for seed in range(40):
        made = load_scenario(FAMILY, seed=seed)
        course = build_course(made, qrio())
        heights = (course.start.height, course.goal_height)
        assert min(heights) == 0.0
        assert max(heights) > 0.03
        above[course.start.height > 0.0] += 1
        ground = made.goal.position if course.start.height > 0.0 else made.start.position
        outlines = [piece.outline for e in course.elements for piece in e.pieces if e.walkable]
        assert away(outlines, np.array([ground])) > STOP - 0.05
    assert min(above.values()) > 8


def test_both_robots_get_the_same_course_of_a_seed_and_seeds_differ() -> None:
    def corners(seed: int, robot: str) -> list[Any]:
        body = load_robot(robot)
        course = build_course(load_scenario(FAMILY, seed=seed, robot=robot), body)
        vertices = [piece.vertices for e in course.elements for piece in e.pieces]
        return [np.concatenate(vertices).tolist(), [e.name for e in course.elements]]

    assert corners(3, "qrio") == corners(3, "nao")
    assert corners(3, "qrio") != corners(4, "qrio")


def test_steps_are_within_their_bounds_and_one_is_far_too_high_or_a_door_closes() -> None:
    ways = Counter[bool]()
    for seed in range(60):
        opened = Flights(kind="flights", closed=0.0)
        assert all(0.015 - 1e-9 <= rise <= 0.050 + 1e-9 for rise in rises(opened, seed))
        made = rises(Flights(kind="flights", closed=1.0), seed)
        high = [rise for rise in made if rise > 0.050 + 1e-9]
        assert all(rise >= HIGH[0] - 1e-9 for rise in high)
        assert len(high) <= 1
        ways[bool(high)] += 1
        if not high:
            assert sum(made) >= HIGH[0], "else one could get around the door"
    assert min(ways.values()) > 10


def test_every_shape_and_thing_comes_and_what_is_not_asked_for_does_not() -> None:
    seen: set[str] = set()
    for seed in range(30):
        seen |= things(course_of({"kind": "flights", "closed": 0}, seed=seed, **GOAL))
    assert seen >= {*FLIGHT_THINGS, "step", "landing", "top", "winder"}
    only: dict[str, set[str]] = {
        "straight": {"step", "top"},
        "l": {"step", "landing", "top"},
        "u": {"step", "landing", "top"},
        "winder": {"winder"},
    }
    assert set(only) == set(FLIGHT_SHAPES)
    for kind, parts in only.items():
        element = {"kind": "flights", "shapes": [kind], "things": [], "closed": 1}
        for seed in range(4):
            assert things(course_of(element, seed=seed, **GOAL)) == parts


def levels_of(
    kind: str, seed: int, door: Literal["", "landing", "top"] = ""
) -> tuple[list[Level], float]:
    world = World(Flights(kind="flights"), "flights", np.random.default_rng(seed), Budget())
    return shape(world, Flights(kind="flights"), kind, door)


@pytest.mark.parametrize("kind", FLIGHT_SHAPES)
def test_each_level_begins_at_the_one_below_and_none_lies_over_another(kind: str) -> None:
    for seed in range(20):
        door: Literal["", "landing", "top"] = ("", "top", "landing")[seed % 3]
        levels, turn = levels_of(kind, seed, door if kind in {"l", "u"} or seed % 3 < 2 else "")
        assert levels[-1].what == "top"
        assert (turn != 0.0) == (kind == "winder")
        for below, level in pairwise(levels):
            meet = [
                float(signed_distance(one.outline, place[None])[0])
                for one, place in ((below, level.front), (level, below.back))
            ]
            assert min(abs(away_from) for away_from in meet) < 1e-9
        if turn:
            continue
        assert all(0.11 <= level.depth <= 0.25 for level in levels if level.what == "step")
        for number, level in enumerate(levels):
            inside = 0.999 * (level.outline - level.outline.mean(axis=0))
            shrunk = inside + level.outline.mean(axis=0)
            assert not any(overlap(shrunk, other.outline) for other in levels[number + 1 :])


def test_one_can_stand_on_every_winding_tread_where_one_walks() -> None:
    for seed in range(40):
        levels, turn = levels_of("winder", seed)
        first = levels[0]
        outer = first.depth + abs(turn) * (first.width / 2 - USED)
        assert STANDING - 1e-9 <= outer <= 0.25 + 1e-9


def test_levels_are_each_higher_by_a_rise_and_can_be_moved_anywhere() -> None:
    levels, _ = levels_of("l", 3)
    high = with_heights(levels, [0.03] * len(levels))
    assert [level.height for level in high] == pytest.approx(
        [0.03 * (i + 1) for i in range(len(levels))]
    )
    moved = [level.moved(np.array([1.0, -2.0]), 2.0) for level in high]
    for before, after in zip(high, moved, strict=True):
        assert np.linalg.norm(after.back - [1.0, -2.0]) == pytest.approx(
            float(np.linalg.norm(before.back))
        )
        assert after.yaw == pytest.approx(before.yaw + 2.0)


def test_flights_lead_up_in_every_direction() -> None:
    yaws = []
    for seed in range(60):
        drawn = drawn_flights(Flights(kind="flights"), "flights", seed=seed, stops=STOPS)
        first = next(e for e in drawn.elements if isinstance(e, Stairs | Platform))
        yaws.append(first.yaw)
    quarters = Counter(int(np.floor(yaw / (np.pi / 2))) % 4 for yaw in yaws)
    assert min(quarters[quarter] for quarter in range(4)) >= 5


def test_a_goal_too_near_is_told_with_the_key() -> None:
    with pytest.raises(InputError, match=r"course\.flights: .*a goal farther") as told:
        course_of({"kind": "flights"}, goal={"position": [0.1, 0.0]})
    assert len(str(told.value).splitlines()) == 1


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["qrio", pytest.param("nao", marks=pytest.mark.long)])
@pytest.mark.parametrize("shape", FLIGHT_SHAPES)
def test_the_judge_agrees_with_what_was_meant(shape: str, robot: str) -> None:
    body = load_robot(robot)
    for closed, way in [(0.0, True), (1.0, False)]:
        for seed in range(3):
            element = {"kind": "flights", "shapes": [shape], "closed": closed}
            made = scenario_of(element, seed=seed, **GOAL)
            assert is_solvable(made, build_course(made, body), body) is way, seed


@pytest.mark.long
def test_the_judge_finds_a_way_wherever_none_was_closed() -> None:
    """About 85 of 100."""
    made = [load_scenario(FAMILY, seed=seed) for seed in range(40)]
    found = [is_solvable(one, build_course(one, qrio()), qrio()) for one in made]
    assert found == [not is_closed("flights", seed=one.seed, share=0.15) for one in made]
    assert 28 <= found.count(True) <= 39
