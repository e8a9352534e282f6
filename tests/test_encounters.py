"""Claims about touches of what moves: who stood, and who moved into whom."""

import json

import mujoco
import numpy as np
import pytest
from episode_builders import BOX, qrio, result, scenario, world

from treadwell.judging.contacts import Collision, Contacts
from treadwell.judging.encounters import STANDING_SECONDS
from treadwell.judging.ground_truth import GroundTruth
from treadwell.judging.result import CollisionEntry
from treadwell.scenario.model import Expect

MOVED = f"""{BOX}
[[event]]
at = 0.0
do = "move"
name = "box"
path = [[0.0, 0.0]]
speed = 0.2
"""


def met(
    *, moves: float, walks: float = 0.0, still: float = 0.0, turns: float = 0.0
) -> list[Collision]:
    """Touches of a box before the robot; it moves towards the robot, turns, and the robot walks."""
    made = world(MOVED)
    truth = GroundTruth(made.model, qrio())
    contacts = Contacts(made.model, made.course, qrio(), truth.sole_bodies)
    data = made.simulation.data
    data.qpos[:] = made.course.qpos
    data.qpos[0] += 0.2
    box = made.course.element("box")
    assert box is not None
    mujoco.mj_forward(made.model, data)
    contacts.look(data, 0.99, 0.01, still)
    assert contacts.collisions() == []
    data.qpos[0] += 0.16
    data.qvel[0] = walks
    data.mocap_pos[box.mocap_id][0] -= 0.01 * moves
    if turns:
        mujoco.mju_axisAngle2Quat(data.mocap_quat[box.mocap_id], np.array([0, 0, 1.0]), turns)
    mujoco.mj_forward(made.model, data)
    contacts.look(data, 1.0, 0.01, still)
    found = contacts.collisions()
    assert found
    return found


def test_who_walks_into_a_standing_robot_moves_and_the_robot_does_not() -> None:
    for hit in met(moves=0.2, still=STANDING_SECONDS):
        assert hit.encounter is not None
        assert hit.encounter.standing is True
        assert hit.encounter.robot_speed == pytest.approx(0.0, abs=1e-6)
    faced = max(hit.encounter.element_speed for hit in met(moves=0.2) if hit.encounter)
    assert faced == pytest.approx(0.2, abs=0.01)


def test_a_robot_that_walks_into_what_moves_away_moves_and_is_not_called_standing() -> None:
    for hit in met(moves=-0.1, walks=0.3):
        assert hit.encounter is not None
        standing, mine, other = hit.encounter
        assert not standing
        # Both along one normal, whatever that is.
        assert mine / 0.3 == pytest.approx(other / -0.1, abs=1e-6)
    ahead = max(hit.encounter.robot_speed for hit in met(moves=-0.1, walks=0.3) if hit.encounter)
    assert ahead == pytest.approx(0.3, abs=0.02)


def test_who_came_to_stand_right_before_is_not_called_standing() -> None:
    found = met(moves=0.2, still=STANDING_SECONDS - 0.01)
    assert [hit.encounter is not None and hit.encounter.standing for hit in found] == [False] * len(
        found
    )


def test_a_leaf_that_turns_moves_as_its_touched_point_does() -> None:
    found = met(moves=0.0, turns=0.002, still=1.0)
    assert all(hit.encounter is not None and hit.encounter.standing for hit in found)
    # 0.2 rad/s, no point of the box further than 0.15 m from its middle.
    assert all(hit.encounter and abs(hit.encounter.element_speed) < 0.03 for hit in found)


def test_of_what_did_not_move_nothing_is_said() -> None:
    assert all(hit.encounter is None for hit in met(moves=0.0, walks=0.3))
    entry = CollisionEntry(time=1.0, robot_part="head", element="box", impulse=0.4)
    assert set(json.loads(entry.model_dump_json())) == {"time", "robot_part", "element", "impulse"}


def test_while_it_stood_and_while_it_walked_are_expected_apart() -> None:
    def hit(*, standing: bool | None) -> CollisionEntry:
        return CollisionEntry(
            time=1.0, robot_part="head", element="box", impulse=0.4, standing=standing
        )

    expect = Expect(max_collisions_walking=0)
    touched = result(scenario(), collisions=[hit(standing=True)] * 2)
    assert touched.collisions_standing == 2
    assert touched.judged_by(expect).passed
    assert not touched.judged_by(Expect(max_collisions=0)).passed
    for standing in (False, None):
        told = result(scenario(), collisions=[hit(standing=True), hit(standing=standing)])
        assert told.judged_by(expect).failures == ["max_collisions_walking: 1, at most 0 expected"]
