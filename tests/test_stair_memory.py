"""Claims about what a run knew of stairs in the end."""

import numpy as np
from episode_builders import flight

from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.steppable import outline
from treadwell.trace import StairTrace


def remembered(*frames: tuple[StairTrace, ...]) -> list[StairTrace]:
    memory = StairMemory()
    for stairs in frames:
        memory.update(stairs, climbing=False)
    return memory.stairs


def test_a_stair_that_is_seen_again_takes_its_own_place_and_no_other() -> None:
    first, second = flight(4, front_fitted=True), flight(2, front_fitted=True)
    stairs = remembered(first, second)
    assert len(stairs) == 4
    assert sum(any(stair is new for new in second) for stair in stairs) == 2


def test_a_fitted_sighting_is_kept_until_there_is_another() -> None:
    fitted, bare = flight(1, front_fitted=True), flight(1, front_fitted=False)
    later = flight(1, front_fitted=True)
    assert remembered(bare, fitted, bare) == [*fitted]
    assert remembered(fitted, later) == [*later]


def test_what_is_no_longer_seen_stays_and_what_is_only_remembered_is_not_taken_in() -> None:
    assert len(remembered(flight(3), ())) == 3
    assert len(remembered(flight(3, steps_ago=1))) == 0


def test_stairs_that_the_core_forgot_are_not_drawn_and_those_of_before_are() -> None:
    memory = StairMemory()
    first, wrong = flight(2), flight(5)[3:]
    for stairs, forgotten in ((first, 0), (wrong, 0), ((), 1)):
        memory.update(stairs, climbing=False, forgotten=forgotten)
    assert memory.stairs == [*first]
    memory.update((), climbing=False, forgotten=None)
    assert memory.stairs == [*first]


def test_the_floor_at_the_foot_of_stairs_is_no_stair_to_be_drawn() -> None:
    (stair,) = flight(1)
    far = np.array([1.0, 0.0, 0.0])
    floor = StairTrace(
        stair.front, stair.back + far, front_fitted=True, back_fitted=False, steps_ago=0
    )
    assert remembered((floor,)) == []


def test_a_stair_above_another_is_one_more() -> None:
    (low,) = flight(1)
    up = np.array([0.0, 0.0, 0.03])
    high = StairTrace(
        low.front + up, low.back + up, front_fitted=False, back_fitted=False, steps_ago=0
    )
    assert len(remembered((low,), (high,))) == 2


def test_an_outline_goes_round() -> None:
    (stair,) = flight(1)
    corners = outline(stair)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    assert np.allclose(sides, [0.32, 0.12, 0.32, 0.12])
