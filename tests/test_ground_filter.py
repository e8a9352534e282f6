"""Claims about what the points of a cloud are; airborne ones where `TREADWELL_DATA` says."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from isprs_clouds import errors, sample

from treadwell._core import ground_points, point_classes
from treadwell.errors import InputError

DATA = os.environ.get("TREADWELL_DATA")
MOST_WRONG = {"samp11": 9.0, "samp21": 2.0}
"""Per cent of all points, with one set of settings: the defaults."""


@pytest.mark.skipif(DATA is None, reason="TREADWELL_DATA does not say where data are")
@pytest.mark.parametrize("name", MOST_WRONG)
def test_airborne_clouds_of_others_are_told_apart_with_the_defaults(name: str) -> None:
    assert DATA is not None
    points, truth = sample(Path(DATA), name)
    found = errors(truth, ground_points(points))
    assert found["total"] <= MOST_WRONG[name], found


def test_a_house_is_no_ground_and_the_floor_around_it_is() -> None:
    points = np.random.default_rng(5).uniform(0.0, 60.0, (4000, 3))
    inside = (np.abs(points[:, :2] - 30.0) < 8.0).all(axis=1)
    points[:, 2] = np.where(inside, 5.0, 0.0)
    assert np.array_equal(ground_points(points), ~inside)
    small = json.dumps({"largest_object": 4.0})
    assert ground_points(points, small).mean() > (~inside).mean()


def test_a_ball_of_leaves_a_wire_and_a_floor_are_told_apart() -> None:
    random = np.random.default_rng(7)
    leaves = random.uniform(-0.5, 0.5, (2000, 3)) + np.array([0.0, 0.0, 3.0])
    wire = np.column_stack([random.uniform(-3.0, 3.0, 600), np.full(600, 4.0), np.full(600, 4.0)])
    floor = np.column_stack([random.uniform(-2.0, 2.0, (4000, 2)), np.zeros(4000)])
    noisy = np.concatenate([leaves, wire, floor]) + random.normal(0.0, 0.01, (6600, 3))
    classes = point_classes(noisy)
    assert classes.dtype == np.uint8
    for part, expected in ((slice(2000), 1), (slice(2000, 2600), 2), (slice(2600, None), 3)):
        assert (classes[part] == expected).mean() > 0.9, expected
    assert not point_classes(np.eye(3)).any()
    with pytest.raises(InputError, match=r"classification\.moments\.noise must be > 0, got 0"):
        point_classes(np.eye(3), '{"noise": 0.0}')


def test_bad_clouds_and_settings_are_refused_by_name() -> None:
    with pytest.raises(InputError, match="the cloud has 0 points"):
        ground_points(np.zeros((0, 3)))
    with pytest.raises(InputError, match="point 1 is not finite"):
        ground_points(np.array([[0.0, 0.0, 0.0], [0.0, np.nan, 0.0]]))
    with pytest.raises(ValueError, match=r"points must be \(n, 3\)"):
        ground_points(np.zeros((4, 2)))
    with pytest.raises(
        InputError, match=r"classification\.ground_filter\.slope must be > 0, got -1"
    ):
        ground_points(np.zeros((4, 3)), '{"slope": -1.0}')
    with pytest.raises(InputError, match="unknown field `steepness`"):
        ground_points(np.zeros((4, 3)), '{"steepness": 1.0}')
