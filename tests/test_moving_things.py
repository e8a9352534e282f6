"""Claims about what changes on a robot's way: who moves is followed and given way, doors open."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell.episode import Episode

Frames = list[tuple[float, NDArray[np.float64], list[Any]]]

SECONDS = 19.5
"""A second before, whoever crosses turns, and is soon out of view."""


@pytest.fixture(scope="module")
def crossed() -> Frames:
    """Time, true place, and what the robot follows, while somebody walks in its view."""
    episode = Episode("person_crosses", robot="qrio", seed=0)
    somebody = next(one for one in episode.course.elements if one.name == "somebody")
    seen = []
    while episode.simulation.time_ns < 1e9 * SECONDS:
        step = episode.tick()
        if step.observation.depth is not None:
            place = episode.simulation.data.mocap_pos[somebody.mocap_id][:2].copy()
            seen.append((1e-9 * step.time_ns, place, episode.pilot.moving_things))
    return seen


def test_nothing_is_followed_before_anything_moves(crossed: Frames) -> None:
    """Whatever the camera's errors are."""
    start = crossed[0][1]
    still = [things for _, place, things in crossed if np.allclose(place, start)]
    assert len(still) > 100
    assert not any(sure for things in still for *_, sure in things)


def test_who_crosses_is_followed_and_its_place_a_second_ahead_is_known(crossed: Frames) -> None:
    """Within 0.2 m at 0.3 m/s, as soon as it surely moves."""
    errors = []
    for time, place, things in crossed:
        later = [there for when, there, _ in crossed if abs(when - time - 1.0) < 0.05]
        for _, at, rate, _, sure in things:
            if sure:
                assert np.linalg.norm(np.subtract(at, place)) < 0.25
                errors += [np.linalg.norm(np.add(at, rate) - there) for there in later]
    assert len(errors) > 15
    assert all(error <= 0.2 for error in errors)


def test_nothing_is_followed_where_that_is_not_wanted() -> None:
    """`navigation.moving.follow`."""
    episode = Episode(
        "person_crosses", robot="qrio", seed=0, overrides=("navigation.moving.follow=false",)
    )
    for _ in range(20):
        episode.tick()
    assert episode.pilot.moving_things == []


def test_who_crosses_is_given_way() -> None:
    """Before, the robot stopped where somebody passed: five touches with this seed."""
    episode = Episode("person_crosses", robot="qrio", seed=1)
    states = set()
    while episode.simulation.time_ns < 24e9:
        states.add(episode.tick().state)
    assert "give_way" in states
    assert episode.judge.collisions == []


@pytest.mark.long
def test_the_way_back_leads_through_the_door_that_was_opened_again() -> None:
    episode = Episode("door_shuts", robot="qrio", seed=0)
    door, crossed = 1.2, []
    before = 0.0
    while episode.verdict is None:
        episode.tick()
        x, y = episode.judge.frame[:2]
        if (before - door) * (x - door) < 0:
            crossed.append(y)
        before = x
    assert episode.verdict.outcome == "goal_reached"
    there, back = crossed
    assert there > 0.7
    assert abs(back) < 0.35
