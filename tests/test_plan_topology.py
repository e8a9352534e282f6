"""Places, ways and rooms of a map, from cells that are known."""

import numpy as np
import pytest

from treadwell.errors import InputError
from treadwell.map_making.plan_topology import Topology
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap

CELL = 0.05


def two_rooms() -> RememberedMap:
    """Two rooms of 2 x 2 m with a wall of 10 cm between them, and a door of 80 cm in it."""
    kind = np.full((44, 86), OBSTACLE, np.uint8)
    kind[2:42, 2:42] = FLOOR
    kind[2:42, 44:84] = FLOOR
    kind[14:30, 42:44] = FLOOR
    height = np.where(kind == FLOOR, 0.0, np.nan).astype(np.float32)
    return RememberedMap((1.0, -2.0), CELL, kind, height, (kind == FLOOR).astype(np.uint16))


def test_two_rooms_are_told_apart_by_the_doorway_between_them() -> None:
    topology = Topology.of(two_rooms(), {}, np.array([10.0, 0.0]))
    places = topology.places()
    assert places.rooms == 2
    (doorway,) = places.doorways
    assert sorted(doorway.rooms) == [1, 2]
    assert doorway.position == pytest.approx((13.15, -0.9), abs=0.06)
    assert doorway.width == pytest.approx(0.8, abs=0.06)
    kind = two_rooms().kind
    assert ((topology.room_of > 0) == (kind == FLOOR)).all()
    left, right = topology.room_of[20, 10], topology.room_of[20, 70]
    assert {int(left), int(right)} == {1, 2}
    assert (topology.room_of[2:42, 2:42] == left).all()


def test_a_plan_leads_through_the_doorway_and_none_through_what_is_too_narrow() -> None:
    topology = Topology.of(two_rooms(), {}, np.zeros(2))
    way = topology.graph.plan((1.3, -1.7), (4.8, -0.2), 0.2)
    assert way is not None
    assert way[0] == pytest.approx((1.3, -1.7), abs=CELL)
    assert way[-1] == pytest.approx((4.8, -0.2), abs=CELL)
    assert np.hypot(*(way - (3.15, -0.9)).T).min() < 0.1
    assert topology.graph.plan((1.3, -1.7), (4.8, -0.2), 0.5) is None


def test_another_size_of_cells_makes_the_same_graph() -> None:
    found = two_rooms()
    fine = RememberedMap(
        found.origin,
        0.5 * CELL,
        *(np.kron(each, np.ones((2, 2), each.dtype)) for each in (found.kind, found.height)),
        sightings=np.kron(found.sightings, np.ones((2, 2), np.uint16)),
    )
    one, other = (Topology.of(each, {}, np.zeros(2)).graph for each in (found, fine))
    assert one.is_like(other)


def test_a_map_without_floor_has_no_places_and_bad_settings_are_refused() -> None:
    nothing = RememberedMap(
        (0.0, 0.0),
        CELL,
        np.zeros((3, 4), np.uint8),
        np.full((3, 4), np.nan, np.float32),
        np.zeros((3, 4), np.uint16),
    )
    places = Topology.of(nothing, {}, np.zeros(2)).places()
    assert (places.count, places.rooms, places.ways) == (0, 0, [])
    with pytest.raises(InputError, match=r"plan_view\.topology\.angle"):
        Topology.of(nothing, {"angle": 7.0}, np.zeros(2))
