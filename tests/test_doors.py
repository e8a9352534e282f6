"""Doors: where their wall, lintel and leaf stand, and how events turn the leaf."""

import math

import mujoco
import numpy as np
import pytest
from episode_builders import qrio
from test_course import course_of
from test_events import advance, prepared

from treadwell.course.course import Hinge
from treadwell.course.doors import LEAF_THICKNESS, PLAY, frame_pieces, leaf_piece, with_leaf
from treadwell.course.pieces import Piece
from treadwell.errors import InputError
from treadwell.scenario.elements import Door

DOOR = {"kind": "door", "name": "door", "position": [1.5, 0.0], "width": 0.6, "height": 0.7}


def door(**keys: object) -> Door:
    return Door.model_validate({**DOOR, **keys})


def corners(piece: Piece, axis: int) -> tuple[float, float]:
    return float(piece.vertices[:, axis].min()), float(piece.vertices[:, axis].max())


def test_a_door_is_an_opening_in_a_wall_below_a_lintel() -> None:
    made = {piece.name: piece for piece in frame_pieces(door(wall=[0.5, 0.2, 1.0]))}
    assert corners(made["left"], 1) == pytest.approx((0.3, 0.8))
    assert corners(made["right"], 1) == pytest.approx((-0.5, -0.3))
    assert corners(made["lintel"], 1) == pytest.approx((-0.3, 0.3))
    assert corners(made["lintel"], 2) == pytest.approx((0.7, 1.0))
    assert all(corners(piece, 0) == pytest.approx((1.475, 1.525)) for piece in made.values())
    bare = frame_pieces(door(wall=[0.0, 0.0, 0.6]))
    assert bare == []


@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.5])
def test_a_leaf_is_hinged_left_and_opens_away(yaw: float) -> None:
    """In the door's own frame, x the way through and y to the left."""
    turn = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    for opened, tip in [(0.0, (0.0, -0.3)), (1.0, (0.6, 0.3)), (0.5, (0.42, -0.12))]:
        vertices = leaf_piece(door(yaw=yaw, open=opened)).vertices
        inside = (vertices[:, :2] - np.array(DOOR["position"])) @ turn.T
        assert np.hypot(*(inside - np.array(tip)).T).min() < 0.05
        assert np.hypot(*(inside - np.array([0.025, 0.3])).T).min() < LEAF_THICKNESS + PLAY
        assert corners(leaf_piece(door(open=opened)), 2) == pytest.approx((PLAY, 0.7 - PLAY))


def test_a_shut_door_stops_a_ray_and_an_open_one_does_not() -> None:
    for opened, reach in [(0.0, 1.005), (1.0, -1.0)]:
        course = course_of({**DOOR, "open": opened})
        data = mujoco.MjData(course.model)
        mujoco.mj_kinematics(course.model, data)
        start, ahead = np.array([0.5, 0.0, 0.3]), np.array([1.0, 0.0, 0.0])
        geom = np.zeros(1, dtype=np.int32)
        found = mujoco.mj_ray(course.model, data, start, ahead, None, 1, -1, geom)
        assert found == pytest.approx(reach)
        assert [element.name for element in course.elements] == ["door", "door.leaf"]
        assert course.elements[1].hinge == Hinge("door", opened)


def test_a_door_is_set_within_a_second_and_stays() -> None:
    events, physics, course = prepared(
        {"at": 0.5, "do": "set_door", "name": "door", "open": 0.25}, course=({**DOOR, "open": 1},)
    )
    leaf = course.element("door.leaf")
    assert leaf is not None
    assert leaf.mocap_id is not None
    advance(events, physics, 1.0)
    half = events.stands(leaf).hinge
    assert half is not None
    assert half.open == pytest.approx(1.0 - 0.75 * 0.5, abs=0.02)
    advance(events, physics, 2.0)
    turned = physics.data.mocap_quat[leaf.mocap_id]
    assert 2 * math.acos(turned[0]) == pytest.approx(0.75 * math.pi / 2)
    steps = [step for step, name in physics.written if name == "mocap_quat"]
    assert (min(steps), max(steps)) == (250, 745)
    # What events say of the leaf, MuJoCo says of its geom.
    piece = events.stands(leaf).pieces[0]
    mujoco.mj_kinematics(physics.model, physics.data)
    np.testing.assert_allclose(physics.data.geom_xpos[leaf.geom_ids[0]], piece.center, atol=1e-9)
    now = events.course_now().element("door.leaf")
    assert now is not None
    np.testing.assert_allclose(now.pieces[0].vertices, piece.vertices)
    fresh = leaf_piece(door(open=0.25)).vertices
    np.testing.assert_allclose(sorted(piece.vertices.tolist()), sorted(fresh.tolist()), atol=1e-9)


def test_what_is_no_leaf_is_left_as_it_is() -> None:
    course = course_of(DOOR)
    frame, leaf = course.elements
    assert with_leaf(frame, 0.0) is frame
    assert with_leaf(leaf, 1.0) is leaf
    assert leaf.mocap_id is None


def test_an_event_that_names_no_door_is_bad_input() -> None:
    event = {"at": 1.0, "do": "set_door", "name": "dor", "open": 0.0}
    with pytest.raises(InputError, match=r"event\.0\.name: found 'dor'.*did you mean 'door'\?"):
        course_of(DOOR, event=[event])
    with pytest.raises(InputError, match="neither door"):
        course_of(DOOR, event=[{"at": 1.0, "do": "move", "name": "door", "to": [0.0, 0.0]}])


def test_the_robot_is_stopped_by_nothing_in_an_open_door() -> None:
    assert 2 * qrio().file.body.radius < 0.6 - LEAF_THICKNESS
