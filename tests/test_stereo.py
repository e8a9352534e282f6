"""Tests of the stereo camera's errors."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell.random_streams import stream
from treadwell.senses.depth import Cast, Pinhole
from treadwell.senses.stereo import StereoConfig, StereoModel

PINHOLE = Pinhole(88, 72, 101.4)
CONFIG = StereoConfig(baseline=0.06)
SILENT = replace(
    CONFIG,
    disparity_noise_fixed=0.0,
    disparity_noise_temporal=0.0,
    mismatch_rate=0.0,
    valid_textured=1.0,
    quantum=0.0,
)
PX_M = PINHOLE.focal * CONFIG.baseline
TEXTURED = 1.0


def scene(depth: NDArray[np.float64] | float, x: float = 0.0, turn: float = 0.0) -> Cast:
    image = np.broadcast_to(np.asarray(depth, np.float64), (72, 88))
    rotation = np.array(
        [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    )
    geom = np.where(np.isnan(image), -1, 0).astype(np.int32)
    return Cast(image, geom, np.array([x, 0.0, 0.5]), rotation)


def model(config: StereoConfig = CONFIG, seed: int = 0, texture: float = TEXTURED) -> StereoModel:
    pattern, noise = stream(seed, "pattern"), stream(seed, "noise")
    return StereoModel(config, PINHOLE, np.array([texture]), pattern, noise)


def errors(stereo: StereoModel, cast: Cast) -> NDArray[np.float64]:
    """Disparity errors (px); NaN where nothing was seen."""
    return PX_M / stereo.see(cast).astype(np.float64) - PX_M / cast.depth


def without(config: StereoConfig, **values: float) -> StereoConfig:
    return replace(config, mismatch_rate=0.0, valid_textured=1.0, **values)  # type: ignore[arg-type]


def test_the_whole_error_on_a_textured_wall_is_an_eighth_of_a_pixel() -> None:
    stereo = model(without(CONFIG))
    found = np.stack([errors(stereo, scene(0.6 + 0.003 * i, x=0.05 * i)) for i in range(40)])
    assert np.nanstd(found) == pytest.approx(0.125, rel=0.1)
    assert np.nanmean(found) == pytest.approx(0.0, abs=0.005)


def test_the_same_pose_gives_the_same_fixed_pattern() -> None:
    stereo = model(without(CONFIG, quantum=0.0))
    mean = np.mean([errors(stereo, scene(0.6)) for _ in range(60)], axis=0)
    assert np.nanstd(mean) == pytest.approx(CONFIG.disparity_noise_fixed, rel=0.1)
    rest = [errors(stereo, scene(0.6)) - mean for _ in range(20)]
    assert np.nanstd(rest) == pytest.approx(CONFIG.disparity_noise_temporal, rel=0.1)


def pattern_correlation(one: Cast, other: Cast) -> float:
    stereo = model(without(CONFIG, quantum=0.0, disparity_noise_temporal=0.0))
    a, b = errors(stereo, one), errors(stereo, other)
    seen = np.isfinite(a) & np.isfinite(b)
    return float(np.corrcoef(a[seen], b[seen])[0, 1])


def test_the_fixed_pattern_changes_when_the_image_moves_by_a_pixel() -> None:
    pixel = 1.0 / PINHOLE.focal
    assert pattern_correlation(scene(0.6), scene(0.6)) == pytest.approx(1.0, abs=1e-6)
    assert pattern_correlation(scene(0.6), scene(0.6, turn=0.05 * pixel)) > 0.98
    assert abs(pattern_correlation(scene(0.6), scene(0.6, turn=1.5 * pixel))) < 0.25
    assert pattern_correlation(scene(0.6), scene(0.6, x=0.0002)) > 0.98
    assert abs(pattern_correlation(scene(0.6), scene(0.6, x=0.01))) < 0.25
    assert abs(pattern_correlation(scene(0.6), scene(0.66))) < 0.25


def test_errors_are_correlated_over_the_window_and_not_beyond() -> None:
    stereo = model(without(CONFIG, quantum=0.0))
    found = np.stack([errors(stereo, scene(0.6, x=0.05 * i)) for i in range(30)])
    found = found[:, 4:-4, 20:-4]
    power = np.mean(found**2)
    for shift in range(1, 8):
        expected = max(0.0, 1.0 - shift / CONFIG.window)
        across = np.mean(found[:, :, shift:] * found[:, :, :-shift]) / power
        down = np.mean(found[:, shift:] * found[:, :-shift]) / power
        assert across == pytest.approx(expected, abs=0.08)
        assert down == pytest.approx(expected, abs=0.08)


def test_without_noise_the_depth_of_a_wall_is_exact() -> None:
    depth = model(SILENT).see(scene(0.6))
    seen = np.isfinite(depth)
    np.testing.assert_allclose(depth[seen], 0.6, rtol=1e-6)
    d = PX_M / 0.6
    assert not seen[:2].any()
    assert not seen[-2:].any()
    assert not seen[:, -2:].any()
    assert seen[2:-2, int(np.ceil(d)) + 2 : -2].all()


def test_what_the_other_eye_has_not_in_view_is_not_seen() -> None:
    for wall in (0.4, 0.7, 1.5):
        depth = model(SILENT).see(scene(wall))
        columns = np.arange(88)
        outside = columns < PX_M / wall + CONFIG.window // 2
        assert np.isnan(depth[:, outside]).all()


def test_a_plane_is_not_bent_by_the_window() -> None:
    u, v = np.meshgrid(np.arange(88), np.arange(72))
    disparity = 5.0 + 0.03 * u + 0.08 * v
    depth = model(SILENT).see(scene(PX_M / disparity))
    seen = np.isfinite(depth)
    assert seen.mean() > 0.7
    np.testing.assert_allclose(PX_M / depth[seen], disparity[seen], atol=1e-3)


@pytest.mark.parametrize("wall", [0.24, 4.2])
def test_too_near_and_too_far_give_no_return(wall: float) -> None:
    assert np.isnan(model(SILENT).see(scene(wall))).all()


def test_no_hit_gives_no_return() -> None:
    depth = np.full((72, 88), 0.6)
    depth[:30] = np.nan
    seen = np.isfinite(model().see(scene(depth)))
    assert not seen[:30].any()
    assert seen[40:60, 30:80].mean() > 0.85


def test_disparities_are_steps_of_the_quantum() -> None:
    disparity = PX_M / model().see(scene(0.6)).astype(np.float64)
    steps = disparity[np.isfinite(disparity)] / CONFIG.quantum
    assert np.abs(steps - np.rint(steps)).max() < 1e-3


@pytest.mark.parametrize(("texture", "share"), [(1.0, 0.95), (0.2, 0.206), (0.0, 0.02)])
def test_a_surface_is_matched_by_its_texture(texture: float, share: float) -> None:
    stereo = model(texture=texture)
    inner = (slice(2, -2), slice(20, -2))
    seen = [np.isfinite(stereo.see(scene(0.6, x=0.05 * i))[inner]) for i in range(60)]
    assert np.mean(seen) == pytest.approx(share, abs=0.025)


def test_missing_matches_come_in_patches() -> None:
    stereo = model(texture=0.8)
    missing = np.stack(
        [np.isnan(stereo.see(scene(0.6, x=0.05 * i))[4:-4, 20:-4]) for i in range(30)]
    )
    beside = np.mean(missing[:, :, 1:] & missing[:, :, :-1]) / np.mean(missing)
    assert beside > 2.0 * np.mean(missing)


def test_mismatches_are_as_rare_as_configured_and_anywhere() -> None:
    stereo = model()
    found = np.concatenate([errors(stereo, scene(0.6, x=0.05 * i)).reshape(-1) for i in range(100)])
    found = found[np.isfinite(found)]
    gross = np.abs(found) > 1.0
    # Those near the true disparity, or outside the other eye's view, are not among them.
    assert np.mean(gross) == pytest.approx(CONFIG.mismatch_rate * 0.85, rel=0.25)
    disparities = found[gross] + PX_M / 0.6
    assert disparities.min() < 4.0
    assert disparities.max() > 20.0


def test_the_same_seed_repeats_and_another_does_not() -> None:
    one, again, other = model(seed=1), model(seed=1), model(seed=2)
    for i in range(3):
        cast = scene(0.6 + 0.1 * i)
        first = one.see(cast)
        np.testing.assert_array_equal(first, again.see(cast))
        assert not np.array_equal(first, other.see(cast), equal_nan=True)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"baseline": 0.0}, "baseline must be > 0, got 0.0"),
        ({"window": 4}, "window must be odd and > 0, got 4"),
        ({"quantum": -0.1}, "quantum must be >= 0"),
        ({"max_disparity": 1.0}, "min_disparity must be > 0 and < max_disparity"),
        ({"disparity_noise_fixed": -1.0}, "disparity_noise must be >= 0"),
        ({"mismatch_rate": 1.5}, "mismatch_rate must be within 0 and 1"),
        ({"valid_textured": 1.1}, "valid_textured"),
    ],
)
def test_what_no_camera_could_be_is_refused(change: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        StereoConfig(**({"baseline": 0.06} | change))  # type: ignore[arg-type]
