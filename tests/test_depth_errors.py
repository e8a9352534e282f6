"""Tests of the core's depth errors: figures of the model in Python that they took the place of.

The figures are those of `senses/stereo.py` and `senses/structured_light.py` at b80715b, for the
same scenes and two seeds.
"""

import json

import numpy as np
import pytest
from depth_statistics import (
    FOCAL,
    SHAPE,
    See,
    disparity_errors,
    heap,
    motion,
    neighbours,
    patches,
    summary,
    wall,
)

from treadwell import _core
from treadwell.errors import InputError

BASELINE = 0.06
SCALE = FOCAL * BASELINE
LIGHT_SHAPE, LIGHT_FOCAL, LIGHT_BASELINE = (240, 320), 288.7, 0.075
LIGHT_SCALE = LIGHT_FOCAL * LIGHT_BASELINE


def stereo(texture: float = 1.0, seed: int = 1, **settings: float) -> See:
    table = json.dumps({"baseline": BASELINE} | settings)
    height, width = SHAPE
    errors = _core.DepthErrors.stereo(
        np.full(4, texture), width=width, height=height, focal=FOCAL, settings=table,
        pattern=seed, noise=seed + 1000,
    )  # fmt: skip
    return lambda depth, geom, position, rotation: errors.see(
        depth, geom, tuple(position), rotation
    )


def light(seed: int = 1, **settings: float) -> See:
    table = json.dumps({"baseline": LIGHT_BASELINE} | settings)
    height, width = LIGHT_SHAPE
    errors = _core.DepthErrors.structured_light(
        width=width, height=height, focal=LIGHT_FOCAL, settings=table, noise=seed
    )
    return lambda depth, geom, position, rotation: errors.see(
        depth, geom, tuple(position), rotation
    )


def check(found: dict[str, float], expected: dict[str, float]) -> None:
    """The same but for chance: shares within 1 in 100, deviations within 2 %, and so on."""
    assert found["seen"] == pytest.approx(expected["seen"], abs=0.01)
    assert found["deviation"] == pytest.approx(expected["deviation"], rel=0.025)
    assert found["bias"] == pytest.approx(expected["bias"], abs=0.025 * expected["deviation"])
    assert found["gross"] == pytest.approx(expected["gross"], rel=0.12, abs=1e-9)
    for share in ("half", "nine in ten", "nineteen in twenty"):
        assert found[share] == pytest.approx(expected[share], rel=0.03), share


def test_a_textured_wall_is_seen_as_by_the_model_in_python() -> None:
    errors = disparity_errors(stereo(), wall(0.6), SCALE, 60)
    check(summary(errors), {
        "seen": 0.7470, "deviation": 0.1178, "bias": -0.0013, "gross": 0.00626,
        "half": 0.1100, "nine in ten": 0.2350, "nineteen in twenty": 0.2350,
    })  # fmt: skip
    assert patches(errors) == pytest.approx(9.9, rel=0.08)


def test_a_heap_with_creases_occlusions_and_sky_is_seen_as_by_the_model_in_python() -> None:
    check(summary(disparity_errors(stereo(), heap(), SCALE, 60)), {
        "seen": 0.7727, "deviation": 0.1257, "bias": 0.0003, "gross": 0.00834,
        "half": 0.0845, "nine in ten": 0.2095, "nineteen in twenty": 0.2573,
    })  # fmt: skip


def test_a_blank_wall_is_seen_as_by_the_model_in_python() -> None:
    found = summary(disparity_errors(stereo(0.2), wall(0.6), SCALE, 60))
    assert found["seen"] == pytest.approx(0.1624, abs=0.01)
    assert found["deviation"] == pytest.approx(0.1174, rel=0.025)


def test_a_window_of_one_pixel_is_as_in_the_model_in_python() -> None:
    check(summary(disparity_errors(stereo(window=1), heap(), SCALE, 30)), {
        "seen": 0.8747, "deviation": 0.1188, "bias": 0.0, "gross": 0.00553,
        "half": 0.0966, "nine in ten": 0.1903, "nineteen in twenty": 0.2181,
    })  # fmt: skip


def test_errors_are_correlated_over_the_window_as_in_the_model_in_python() -> None:
    see = stereo(mismatch_rate=0.0, quantum=0.0)
    found = neighbours(disparity_errors(see, wall(0.6), SCALE, 60), 7)
    np.testing.assert_allclose(found, 2 * [0.8, 0.6, 0.4, 0.2, 0.0, 0.0], atol=0.025)


def test_what_stays_and_what_is_new_are_as_large_as_in_the_model_in_python() -> None:
    see = stereo(mismatch_rate=0.0, quantum=0.0, valid_textured=1.0)
    errors = disparity_errors(see, wall(0.6), SCALE, 60, way=0.0)[:, 4:-4, 24:-4]
    mean = errors.mean(axis=0)
    assert mean.std() == pytest.approx(0.1026, rel=0.06)
    assert (errors - mean).std() == pytest.approx(0.0495, rel=0.02)


def test_the_fixed_pattern_goes_with_pose_and_disparity_as_in_the_model_in_python() -> None:
    see = stereo(mismatch_rate=0.0, quantum=0.0, disparity_noise_temporal=0.0)
    pixel = 1.0 / FOCAL
    moves = [(0.0, 0.0, 0.0), (0.25 * pixel, 0.0, 0.0), (0.5 * pixel, 0.0, 0.0), (pixel, 0.0, 0.0)]
    moves += [(0.0, 0.001, 0.0), (0.0, 0.003, 0.0), (0.0, 0.0, 0.1), (0.0, 0.0, 0.3)]
    expected = [1.0, 0.867, 0.562, 0.085, 0.940, 0.575, 0.915, 0.427]
    np.testing.assert_allclose(motion(see, SCALE, moves), expected, atol=0.05)


def test_structured_light_sees_a_heap_as_the_model_in_python_does() -> None:
    check(summary(disparity_errors(light(), heap(LIGHT_SHAPE, LIGHT_FOCAL), LIGHT_SCALE, 20)), {
        "seen": 0.9082, "deviation": 0.0313, "bias": 0.0, "gross": 0.00130,
        "half": 0.0215, "nine in ten": 0.0514, "nineteen in twenty": 0.0609,
    })  # fmt: skip
    still = light(lateral_noise=0.0)
    check(summary(disparity_errors(still, heap(LIGHT_SHAPE, LIGHT_FOCAL), LIGHT_SCALE, 20)), {
        "seen": 0.9082, "deviation": 0.0312, "bias": 0.0, "gross": 0.0,
        "half": 0.0215, "nine in ten": 0.0512, "nineteen in twenty": 0.0606,
    })  # fmt: skip


def test_structured_light_sees_a_wall_as_the_model_in_python_does() -> None:
    errors = disparity_errors(light(), wall(1.03, LIGHT_SHAPE), LIGHT_SCALE, 20)
    check(summary(errors), {
        "seen": 1.0, "deviation": 0.03228, "bias": -0.0006, "gross": 0.0,
        "half": 0.0218, "nine in ten": 0.0407, "nineteen in twenty": 0.0407,
    })  # fmt: skip
    np.testing.assert_allclose(neighbours(errors, 4), 2 * [0.5, 0.0, 0.0], atol=0.01)


def test_the_same_seed_repeats_to_the_bit_and_another_does_not() -> None:
    for kind in (stereo, light):
        scene = heap() if kind is stereo else heap(LIGHT_SHAPE, LIGHT_FOCAL)
        one, again, other = kind(seed=1), kind(seed=1), kind(seed=2)
        for frame in range(3):
            place = np.array([0.1 * frame, 0.0, 0.5])
            first = one(*scene, place, np.eye(3))
            np.testing.assert_array_equal(first, again(*scene, place, np.eye(3)))
            assert not np.array_equal(first, other(*scene, place, np.eye(3)), equal_nan=True)


def test_a_picture_smaller_than_the_window_shows_nothing() -> None:
    errors = _core.DepthErrors.stereo(
        np.ones(1), width=4, height=3, focal=4.0, settings="{}", pattern=0, noise=0
    )
    seen = errors.see(np.ones((3, 4)), np.zeros((3, 4), np.int32), (0.0, 0.0, 0.0), np.eye(3))
    assert seen.shape == (3, 4)
    assert np.isnan(seen).all()


def test_what_no_camera_could_be_is_refused_by_its_key() -> None:
    with pytest.raises(InputError, match=r"^camera\.stereo\.window must be odd"):
        stereo(window=4)
    with pytest.raises(InputError, match=r"^camera\.structured_light\.baseline must be > 0"):
        light(baseline=0.0)
    with pytest.raises(ValueError, match="depth must have 6336 values, got 6"):
        stereo()(np.ones((2, 3)), np.zeros((2, 3), np.int32), np.zeros(3), np.eye(3))
