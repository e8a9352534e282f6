"""Claims about slip that a robot feels, and that the shade of a patch of floor tells another."""

import numpy as np
import pytest
from slip_trials import (
    ROBOTS,
    SENSE,
    TEST,
    TRAINING,
    Walk,
    errors,
    learned_of,
    patch,
    sense_of,
    walk,
)

SECONDS = 5.0
PATCHES = 16


def walks(robot: str, first: int) -> list[Walk]:
    return [walk(robot, first + at, SECONDS) for at in range(PATCHES)]


def test_half_of_the_patches_are_slippery_and_darker() -> None:
    drawn = np.array([patch(seed) for seed in range(400)])
    slippery = drawn[:, 0] < 0.2
    assert 0.4 < slippery.mean() < 0.6
    assert drawn[slippery, 1].max() < drawn[~slippery, 1].min()


@pytest.mark.long
def test_what_one_robot_felt_tells_the_others_slip_to_half_of_a_constants_error() -> None:
    taught, other = ROBOTS
    sense = sense_of(walks(taught, SENSE))
    learned, usual = learned_of(sense, walks(taught, TRAINING))
    own, constant = errors(learned, usual, walks(other, TEST))
    assert constant > 5.0, "some of the patches are slippery"
    assert own <= 0.5 * constant, (own, constant)
