"""Things that move along a path, and people who give way to the robot."""

import numpy as np
import pytest
from test_events import Stepless, advance, prepared

from treadwell.course.course import CourseElement
from treadwell.course.events import Events
from treadwell.course.motions import PATIENCE, ROOM
from treadwell.course.outlines import Floats

POST = {"kind": "cylinder", "name": "post", "position": [1.0, 1.0], "radius": 0.1}


def moving(**keys: object) -> tuple[Events, Stepless, CourseElement]:
    event = {"at": 0.0, "do": "move", "name": "post", "speed": 0.5, **keys}
    events, physics, course = prepared(event, course=(POST,))
    post = course.element("post")
    assert post is not None
    return events, physics, post


def place(physics: Stepless, post: CourseElement) -> Floats:
    assert post.mocap_id is not None
    found: Floats = physics.data.mocap_pos[post.mocap_id][:2]
    return found


def test_a_path_is_walked_point_by_point_at_the_speed_and_ends() -> None:
    events, physics, post = moving(path=[[1.0, 2.0], [2.0, 2.0]])
    advance(events, physics, 1.0)
    np.testing.assert_allclose(place(physics, post), [1.0, 1.5], atol=1e-9)
    advance(events, physics, 2.0)
    np.testing.assert_allclose(place(physics, post), [1.5, 2.0], atol=1e-9)
    advance(events, physics, 3.0)
    np.testing.assert_allclose(place(physics, post), [2.0, 2.0])
    written = len(physics.written)
    advance(events, physics, 1.0)
    assert len(physics.written) == written


def test_a_loop_goes_on_from_the_last_point_to_the_first() -> None:
    events, physics, post = moving(path=[[1.0, 1.0], [1.0, 2.0]], loop=True)
    for seconds, y in [(1.0, 1.5), (2.0, 1.5), (2.0, 1.5), (1.0, 2.0)]:
        advance(events, physics, seconds)
        np.testing.assert_allclose(place(physics, post), [1.0, y], atol=1e-6)


def test_a_path_of_one_place_is_left_alone_there() -> None:
    events, physics, post = moving(path=[[1.0, 1.0], [1.0, 1.0]], loop=True)
    advance(events, physics, 1.0)
    np.testing.assert_allclose(place(physics, post), [1.0, 1.0])


def test_who_gives_way_stops_before_the_robot_and_turns_back() -> None:
    events, physics, post = moving(path=[[1.0, 1.0], [1.0, -1.0]], loop=True, gives_way=True)
    physics.data.qpos[:2] = [1.0, 0.0]
    advance(events, physics, 2.0)
    stopped = place(physics, post)[1]
    assert stopped == pytest.approx(0.1 + 0.14 + ROOM, abs=0.01)
    advance(events, physics, PATIENCE)
    assert place(physics, post)[1] > stopped
    advance(events, physics, 0.4)
    assert place(physics, post)[1] == pytest.approx(1.0, abs=0.1)


def test_who_does_not_give_way_walks_on() -> None:
    events, physics, post = moving(path=[[1.0, -1.0]])
    physics.data.qpos[:2] = [1.0, 0.0]
    advance(events, physics, 4.1)
    np.testing.assert_allclose(place(physics, post), [1.0, -1.0])


def test_a_robot_behind_keeps_nobody_from_walking_on() -> None:
    events, physics, post = moving(path=[[1.0, 3.0]], gives_way=True)
    physics.data.qpos[:2] = [1.0, 0.7]
    advance(events, physics, 4.1)
    np.testing.assert_allclose(place(physics, post), [1.0, 3.0])
