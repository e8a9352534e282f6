"""Houses and yards that draw themselves: a share of them can be solved, and all can be built."""

import math
from typing import Any

import mujoco
import numpy as np
import pytest
from episode_builders import qrio
from test_course import course_of, scenario_of

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.outlines import signed_distance
from treadwell.course.worlds.border import check_inside, enclose
from treadwell.course.worlds.clutter import KINDS
from treadwell.course.worlds.crossings import HIGH, KERBS, crossing_kinds, shutting_kinds
from treadwell.course.worlds.doorways import AJAR, BARELY, LINTELS, LOW, WIDTHS
from treadwell.course.worlds.drawing import (
    PASSAGE,
    STOP,
    Budget,
    World,
    away,
    disc,
    is_closed,
    strip,
)
from treadwell.course.worlds.furniture import PERSON
from treadwell.course.worlds.house import drawn_house
from treadwell.course.worlds.raised_floor import RISES
from treadwell.course.worlds.rooms import LEAST, Opening, cut_rooms, hops, openings
from treadwell.course.worlds.yard import drawn_yard
from treadwell.errors import InputError
from treadwell.robot.load import load_robot
from treadwell.scenario.drawn_elements import HOUSE_THINGS, YARD_THINGS, House, Yard
from treadwell.scenario.events import Move, SetDoor
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.model import Scenario
from treadwell.solving.robot_limits import STEEPEST
from treadwell.solving.solvable import is_solvable

STOPS = [np.array([0.0, 0.0]), np.array([4.0, 0.0])]
GOAL = {"goal": {"position": [4.0, 0.0]}}
COUNT = 20
"""Courses of each family that are built."""


def scenarios(family: str, count: int) -> list[Scenario]:
    return [load_scenario(family, seed=seed) for seed in range(count)]


def things(course: Course) -> set[str]:
    return {element.name.split(".")[1].split(" ")[0] for element in course.elements}


@pytest.mark.parametrize("family", ["random_house", "random_yard"])
def test_every_drawn_course_is_built_and_its_start_is_free(family: str) -> None:
    """`build_course` refuses a start inside an obstacle or over an edge."""
    for made in scenarios(family, COUNT):
        course = build_course(made, qrio())
        assert course.model.ngeom > 10
        solid = [
            piece.outline
            for element in course.elements
            if not element.walkable
            for piece in element.pieces
        ]
        stops = np.array([made.start.position, made.goal.position])
        assert away(solid, stops) > 0.25
        data = mujoco.MjData(course.model)
        data.qpos[:] = course.qpos
        mujoco.mj_forward(course.model, data)
        assert {int(each) for each in course.geom_element[data.contact.geom].ravel()} == {-1}


@pytest.mark.parametrize("family", ["random_house", "random_yard"])
def test_the_same_seed_is_the_same_course_and_another_is_another(family: str) -> None:
    def corners(seed: int) -> list[Any]:
        course = build_course(load_scenario(family, seed=seed), qrio())
        vertices = [piece.vertices for e in course.elements for piece in e.pieces]
        return [np.concatenate(vertices).tolist(), [e.name for e in course.elements], course.events]

    for seed in (0, 3):
        assert corners(seed) == corners(seed)
    assert corners(0) != corners(1)


def test_both_robots_get_the_same_course() -> None:
    for family in ("random_house", "random_yard"):
        made = load_scenario(family, seed=2)
        one, other = (build_course(made, robot) for robot in (qrio(), load_robot("nao")))
        assert [e.name for e in one.elements] == [e.name for e in other.elements]


@pytest.mark.parametrize("family", ["random_house", "random_yard"])
def test_about_85_of_100_are_open_by_what_is_drawn(family: str) -> None:
    """Three deviations around 0.85 of 400: what the judge finds, without building anything."""
    kind = family.removeprefix("random_")
    opened = 0
    for seed in range(400):
        opened += not is_closed(kind, seed=seed, share=0.15)
    assert 318 <= opened <= 361
    assert is_closed(kind, seed=0, share=1.0)
    assert not is_closed(kind, seed=0, share=0.0)


@pytest.mark.long
@pytest.mark.parametrize("family", ["random_house", "random_yard"])
def test_the_judge_finds_a_way_in_about_85_of_100(family: str) -> None:
    """No physics. It finds one wherever none was closed, and nowhere else."""
    made = scenarios(family, 40)
    found = [is_solvable(one, build_course(one, qrio()), qrio()) for one in made]
    kind = family.removeprefix("random_")
    assert found == [not is_closed(kind, seed=one.seed, share=0.15) for one in made]
    assert 28 <= found.count(True) <= 39


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["house", "yard"])
@pytest.mark.parametrize("robot", ["qrio", pytest.param("nao", marks=pytest.mark.long)])
def test_the_judge_agrees_with_what_was_meant(kind: str, robot: str) -> None:
    body = load_robot(robot)
    for closed, way in [(0.0, True), (1.0, False)]:
        for seed in range(8):
            made = scenario_of({"kind": kind, "closed": closed}, seed=seed, **GOAL)
            assert is_solvable(made, build_course(made, body), body) is way, seed


def test_all_things_come_and_those_that_are_not_asked_for_do_not() -> None:
    seen: set[str] = set()
    for seed in range(30):
        seen |= things(course_of({"kind": "house", "closed": 0}, seed=seed, **GOAL))
    assert seen >= {*HOUSE_THINGS, "wall", "lintel"}
    for seed in range(6):
        made = course_of({"kind": "house", "things": [], "closed": 1}, seed=seed, **GOAL)
        assert things(made) == {"wall", "lintel"}
    seen = set()
    for seed in range(10):
        seen |= things(course_of({"kind": "yard", "closed": 0}, seed=seed, **GOAL))
    assert seen >= {*YARD_THINGS, "fence"}
    bare = course_of({"kind": "yard", "things": [], "closed": 0}, **GOAL)
    assert things(bare) == {"fence"}
    assert set(KINDS) | set(crossing_kinds(YARD_THINGS)) == set(YARD_THINGS)
    assert shutting_kinds([]) == ["fence"]


def test_people_walk_on_the_floor_of_their_room_and_give_way() -> None:
    walkers = 0
    for seed in range(20):
        course = course_of({"kind": "house"}, seed=seed, **GOAL)
        for event in course.events:
            if not isinstance(event, Move):
                continue
            walkers += 1
            assert event.gives_way
            assert event.loop
            person = course.element(event.name)
            assert person is not None
            assert person.mocap_id is not None
            way = np.linspace(*np.array(event.way()), 20)
            fixed = [e for e in course.elements if e.mocap_id is None]
            pieces = [piece.outline for e in fixed for piece in e.pieces if e.hinge is None]
            lintels = [p.outline for e in fixed if "lintel" in e.name for p in e.pieces]
            clear = min(float(signed_distance(outline, way).min()) for outline in pieces)
            over = min((float(signed_distance(o, way).min()) for o in lintels), default=1.0)
            assert clear > PERSON[0] or over < PERSON[1]
            assert np.linalg.norm(way[:, None] - np.array(STOPS)[None], axis=-1).min() > STOP
    assert walkers > 4


def test_a_door_that_is_shut_on_the_way_leaves_another_way() -> None:
    found = 0
    for seed in range(30):
        made = scenario_of({"kind": "house", "closed": 0}, seed=seed, **GOAL)
        course = build_course(made, qrio())
        shut = [event for event in course.events if isinstance(event, SetDoor)]
        if shut:
            found += 1
            assert len(shut) == 1
            assert shut[0].open == 0.0
            leaf = course.element(shut[0].name + ".leaf")
            assert leaf is not None
            assert leaf.mocap_id is not None
    assert found > 1


def test_what_is_drawn_keeps_clear_of_what_no_robot_of_ours_can_tell() -> None:
    """Nothing lies between what can be passed and what cannot: neither heights nor slopes."""
    tall = [robot.file.body.height for robot in (qrio(), load_robot("nao"))]
    assert LOW[1] < min(tall) - 0.04
    assert LINTELS[0] > max(tall) + 0.04
    assert RISES[1] <= 0.050
    assert KERBS[1] <= 0.050
    assert HIGH[0] > 0.060
    assert WIDTHS[0] > PASSAGE
    assert 2 * WIDTHS[1] * math.sin(BARELY[1] * math.pi / 4) < 0.23
    assert 2 * WIDTHS[0] * math.sin(AJAR[0] * math.pi / 4) > PASSAGE
    for family in ("random_house", "random_yard"):
        for made in scenarios(family, 12):
            for _, top in build_course(made, qrio()).tops():
                slope = math.acos(min(1.0, float(top.normal[2])))
                assert slope < STEEPEST or slope > math.radians(12.0)


@pytest.mark.parametrize(
    ("element", "expected"),
    [
        ({"kind": "house", "rooms": 12}, r"course\.house\.area: .*fewer rooms, or a larger area"),
        ({"kind": "house", "area": [[1, -1], [5, 1]]}, r"course\.house\.area: .*must lie inside"),
        ({"kind": "yard", "area": [[1, -1], [5, 1]]}, r"course\.yard\.area: .*must lie inside"),
        (
            {"kind": "yard", "clutter": 60, "area": [[-0.5, -0.5], [4.5, 0.5]]},
            r"course\.yard\.area: .*less clutter",
        ),
    ],
)
def test_an_area_that_is_too_small_is_told_with_its_key(
    element: dict[str, Any], expected: str
) -> None:
    with pytest.raises(InputError, match=expected) as told:
        course_of(element, **GOAL)
    assert len(str(told.value).splitlines()) == 1


def test_the_way_can_lead_backwards_and_over_points_to_pass() -> None:
    house, yard = House(kind="house"), Yard(kind="yard", clutter=3)
    stops = [STOPS[1], np.array([2.0, 1.0]), STOPS[0]]
    for seed in range(3):
        assert drawn_house(house, "house", seed=seed, stops=STOPS[::-1], width=0.3).elements
        assert drawn_yard(yard, "yard", seed=seed, stops=STOPS[::-1], width=0.3).elements
    assert drawn_house(house, "house", seed=0, stops=stops, width=0.3).elements


def test_rooms_are_wide_enough_and_all_of_them_can_be_reached() -> None:
    generator = np.random.default_rng(3)
    found = 0
    for _ in range(60):
        cut = cut_rooms(generator, [(-0.7, -1.5), (4.9, 1.5)], 4, np.array(STOPS))
        if cut is None:
            continue
        rooms, cuts = cut
        found += 1
        assert len(rooms) == 4
        assert len(cuts) == 3
        assert all((room.high - room.low >= LEAST - 1e-9).all() for room in rooms)
        area = sum(float(np.prod(room.high - room.low)) for room in rooms)
        assert area == pytest.approx(5.6 * 3.0)
        doors = openings(generator, rooms, cuts, WIDTHS)
        assert doors is None or min(hops(4, doors, 0)) == 0
    assert found > 10


def test_hops_are_counted_around_what_is_shut() -> None:
    doors = [Opening(0, (0, 1), 0.0, 0.6), Opening(1, (1, 2), 0.0, 0.6), Opening(2, (0, 2), 0, 0.6)]
    assert hops(3, doors, 0) == [0, 1, 1]
    assert hops(3, doors, 0, shut=2) == [0, 1, 2]
    assert hops(3, doors[:1], 0) == [0, 1, -1]


def test_outlines_of_discs_lie_around_them_and_strips_are_as_wide_as_asked() -> None:
    around = disc(np.array([1.0, 2.0]), 0.5)
    assert np.linalg.norm(around - [1.0, 2.0], axis=1).min() >= 0.5
    line = strip(np.array([0.0, 0.0]), np.array([0.0, 2.0]), 0.2)
    assert float(np.ptp(line[:, 0])) == pytest.approx(0.2)
    assert float(np.ptp(line[:, 1])) == pytest.approx(2.0)


def test_a_border_leaves_no_gap_and_no_stop_lies_too_near_to_it() -> None:
    area = ((0.0, 0.0), (3.0, 2.0))
    world = World(Yard(kind="yard", area=area), "yard", np.random.default_rng(0), Budget())
    enclose(world, area, "fence", height=0.5, thickness=0.1)
    assert [wall.name for wall in world.drawn().elements] == [
        f"yard.fence {i}" for i in range(1, 5)
    ]
    for corner in ((0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0)):
        assert away(world.solid, np.array([corner])) <= 0.0
    assert away(world.solid, np.array([[1.5, 1.0]])) == pytest.approx(0.95)
    check_inside("yard", area, np.array([[STOP, STOP]]), border="fences")
    with pytest.raises(InputError, match=r"course\.yard\.area: .* m from the fences"):
        check_inside("yard", area, np.array([[STOP - 0.01, STOP]]), border="fences")
