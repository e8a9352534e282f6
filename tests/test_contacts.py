"""Claims about contacts: what is a fall, what a collision, and which belong together."""

import mujoco
import numpy as np
import pytest
from episode_builders import BOX, STEP, World, qrio, world

from treadwell.judging.contacts import RISER_IMPULSE, Collision, Contacts
from treadwell.judging.ground_truth import GroundTruth

HANGING = """
[[course]]
kind = "box"
name = "beam"
position = [0.0, 0.0]
size = [0.1, 1.0, 0.1]
base = 0.9
"""


def contacts_of(made: World) -> Contacts:
    truth = GroundTruth(made.model, qrio())
    return Contacts(made.model, made.course, qrio(), truth.sole_bodies)


def put(made: World, x: float, z: float = 0.0, y: float = 0.0) -> mujoco.MjData:
    """Move the robot, as it stands, to a place; nothing is stepped."""
    data, qpos = made.simulation.data, made.course.qpos
    data.qpos[:] = qpos
    data.qpos[:3] += (x, y, z)
    mujoco.mj_forward(made.model, data)
    return data


def test_both_soles_stand_on_the_ground_and_no_part_lies_on_it() -> None:
    made = world()
    touch = contacts_of(made).look(put(made, 0.0, -0.001), 0.0, 0.01)
    assert (touch.left, touch.right, touch.fallen_part) == (True, True, None)


def test_in_the_air_nothing_touches() -> None:
    made = world()
    touch = contacts_of(made).look(put(made, 0.0, 0.1), 0.0, 0.01)
    assert (touch.left, touch.right, touch.fallen_part) == (False, False, None)


def test_a_sole_on_a_walkable_top_is_no_collision() -> None:
    made = world(STEP)
    contacts = contacts_of(made)
    touch = contacts.look(put(made, 1.0, 0.029), 0.0, 0.01)
    assert touch.left
    assert touch.right
    assert contacts.collisions() == []


def test_a_part_in_the_ground_is_a_fall() -> None:
    made = world()
    data = put(made, 0.0, -0.2)
    assert contacts_of(made).look(data, 0.0, 0.01).fallen_part is not None


def test_walking_into_a_box_is_a_collision_with_the_links_and_the_elements_name() -> None:
    made = world(BOX)
    contacts = contacts_of(made)
    contacts.look(put(made, 0.36), 1.0, 0.01)
    found = contacts.collisions()
    assert found
    assert {hit.element for hit in found} == {"box"}
    assert {hit.robot_part for hit in found} <= {
        made.model.body(i).name for i in range(made.model.nbody)
    }
    assert all(hit.time == 1.0 and hit.impulse >= 0.0 for hit in found)
    assert any(hit.impulse > 0.0 for hit in found)


def test_contacts_of_one_pair_within_half_a_second_are_one() -> None:
    made = world(BOX)
    contacts = contacts_of(made)
    data = put(made, 0.36)
    contacts.look(data, 1.0, 0.01)
    pairs = len(contacts.collisions())
    contacts.look(data, 1.5, 0.01)
    contacts.look(data, 1.9, 0.01)
    assert len(contacts.collisions()) == pairs
    contacts.look(data, 2.5, 0.01)
    assert len(contacts.collisions()) == 2 * pairs


def test_the_impulse_is_the_integral_of_the_force() -> None:
    made = world(BOX)
    contacts = contacts_of(made)
    data = put(made, 0.36)
    contacts.look(data, 1.0, 0.01)
    first = contacts.collisions()[0].impulse
    contacts.look(data, 1.01, 0.03)
    assert contacts.collisions()[0].impulse == pytest.approx(4 * first)


def test_forces_are_those_that_hold_the_robots_weight() -> None:
    made = world(HANGING)
    made.stand(0.5)
    scratch = mujoco.MjData(made.model)
    mujoco.mj_copyData(scratch, made.model, made.simulation.data)
    mujoco.mj_forward(made.model, scratch)
    force, total = np.zeros(6), 0.0
    for index in range(scratch.ncon):
        mujoco.mj_contactForce(made.model, scratch, index, force)
        total += force[0]
    weight = 9.81 * float(made.model.body_subtreemass[made.model.body(qrio().root).id])
    assert total == pytest.approx(weight, rel=0.1)


def test_a_sole_that_brushes_a_riser_counts_from_its_impulse_on() -> None:
    light = Collision(1.0, "left_foot", "step", 0.5 * RISER_IMPULSE, 1.0, riser_only=True)
    hard = Collision(1.0, "left_foot", "step", 1.1 * RISER_IMPULSE, 1.0, riser_only=True)
    shin = Collision(1.0, "left_shank", "step", 0.01, 1.0, riser_only=False)
    assert [hit.counts for hit in (light, hard, shin)] == [False, True, True]


STAIRS = """
[[course]]
kind = "stairs"
name = "stairs"
position = [0.6, 0.0]
"""


@pytest.mark.parametrize("step", [1, 2, 3])
@pytest.mark.parametrize("ahead", [-0.02, 0.0, 0.006])
def test_soles_stand_on_every_tread_with_their_toes_near_the_next_riser(
    step: int, ahead: float
) -> None:
    made = world(STAIRS)
    contacts = contacts_of(made)
    middle = 0.6 + 0.12 * step - 0.06
    touch = contacts.look(put(made, middle + ahead, 0.03 * step - 0.001), 0.0, 0.01)
    assert (touch.left, touch.right, touch.fallen_part) == (True, True, None)
    assert contacts._open == {}


def test_soles_whose_heels_hang_over_the_edge_stand_on_a_top() -> None:
    made = world(STAIRS)
    contacts = contacts_of(made)
    touch = contacts.look(put(made, 0.61, 0.029), 0.0, 0.01)
    assert (touch.left, touch.right, touch.fallen_part) == (True, True, None)
    assert contacts._open == {}


def test_toes_in_a_riser_touch_it_and_count_from_the_impulse_on() -> None:
    made = world(STAIRS)
    contacts = contacts_of(made)
    data = put(made, 0.6 + 0.12 - 0.0525 + 0.0005, 0.029)
    contacts.look(data, 0.0, 1e-4)
    hits = list(contacts._open.values())
    assert {hit.robot_part for hit in hits} == {"left_foot", "right_foot"}
    assert all(hit.riser_only for hit in hits)
    assert contacts.collisions() == []
    contacts.look(data, 0.1, 100.0)
    assert {hit.robot_part for hit in contacts.collisions()} == {"left_foot", "right_foot"}


def test_a_sole_against_a_riser_is_not_on_a_floor() -> None:
    made = world(STEP.replace("0.03]", "0.3]"))
    contacts = contacts_of(made)
    data = put(made, 0.66, 0.1)
    touch = contacts.look(data, 1.0, 0.01)
    assert not touch.left
    assert not touch.right
    hits = [hit for hit in (*contacts._open.values(),) if "foot" in hit.robot_part]
    assert hits
    assert all(hit.riser_only for hit in hits)
