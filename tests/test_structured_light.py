"""Tests of the errors of a structured-light camera, at the figures of the sensor's literature."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell.random_streams import stream
from treadwell.robot.load import load_robot
from treadwell.senses.depth import Cast, Pinhole
from treadwell.senses.structured_light import StructuredLightConfig, StructuredLightModel

PINHOLE = Pinhole(320, 240, 288.7)
CONFIG = StructuredLightConfig(baseline=0.075)
SHAPE = (240, 320)


def cast(depth: NDArray[np.float64] | float) -> Cast:
    image = np.array(np.broadcast_to(np.asarray(depth, np.float64), SHAPE))
    geom = np.where(np.isnan(image), -1, 0).astype(np.int32)
    return Cast(image, geom, np.zeros(3), np.eye(3))


def camera(config: StructuredLightConfig = CONFIG) -> StructuredLightModel:
    return StructuredLightModel(config, PINHOLE, stream(0, "noise"))


def see(
    depth: NDArray[np.float64] | float, config: StructuredLightConfig = CONFIG
) -> NDArray[np.float64]:
    return camera(config).see(cast(depth)).astype(np.float64)


def tilted(degrees: float, depth: float) -> NDArray[np.float64]:
    """A plane at this depth in the middle, turned about the vertical."""
    across = PINHOLE.directions()[:, 0].reshape(SHAPE)
    return depth / (1.0 - across * np.tan(np.radians(degrees)))


@pytest.mark.parametrize(
    ("depth", "sigma_mm"), [(0.55, 0.43), (1.0, 1.4), (1.5, 3.2), (2.0, 5.7), (3.0, 12.8)]
)
def test_the_random_error_is_that_of_khoshelham_and_oude_elberink(
    depth: float, sigma_mm: float
) -> None:
    # Over depths that differ by more than a step: at one depth, rounding is no noise.
    depths = depth + np.linspace(-0.5, 0.5, 40) * 0.02 * depth
    errors = np.concatenate([see(one) - one for one in depths])
    assert np.nanstd(errors) * 1e3 == pytest.approx(sigma_mm, rel=0.08)
    assert abs(np.nanmean(errors)) * 1e3 < 0.15 * sigma_mm


def test_at_the_far_end_the_error_is_two_centimetres() -> None:
    errors = see(3.8) - 3.8
    assert np.nanstd(errors) == pytest.approx(1.425e-3 * 3.8**2, rel=0.2)


@pytest.mark.parametrize(("depth", "step_mm"), [(1.0, 2.9), (2.0, 11.4)])
def test_depths_come_in_steps(depth: float, step_mm: float) -> None:
    values = np.unique(see(depth))
    steps = np.diff(values[np.isfinite(values)])
    assert steps.min() * 1e3 == pytest.approx(step_mm, rel=0.05)


def test_the_shadow_beside_a_box_at_1_m_before_a_wall_at_2_m_is_11_pixels_wide() -> None:
    depth = np.full(SHAPE, 2.0)
    depth[60:180, 120:200] = 1.0
    seen = np.isfinite(see(depth, replace(CONFIG, lateral_noise=0.0, edge_dropout=0.0)))
    assert seen[:, :100].all()
    assert seen[:, 200:].all()
    widths = (~seen[60:180, :200]).sum(axis=1)
    # f b (1 / Zn - 1 / Zf) = 10.8, to a whole pixel.
    assert widths.mean() == pytest.approx(10.8, abs=0.9)
    assert not seen[60:180, 110:119].any()


@pytest.mark.parametrize(
    ("depth", "share"), [(0.45, 0.0), (0.49, 0.0), (0.52, 1.0), (3.6, 1.0), (4.5, 0.0)]
)
def test_it_is_blind_below_half_a_metre_and_beyond_four(depth: float, share: float) -> None:
    assert np.isfinite(see(depth)).mean() == pytest.approx(share, abs=0.01)


def test_what_is_looked_at_at_more_than_80_degrees_is_not_seen() -> None:
    rays = PINHOLE.directions()
    across = rays[:, 0].reshape(SHAPE)
    for degrees in (45.0, 70.0, 78.0):
        normal = np.array([-np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees))])
        cosine = (rays @ normal / np.linalg.norm(rays, axis=1)).reshape(SHAPE)
        angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
        depth = tilted(degrees, 1.5)
        inside = (depth > 0.6) & (depth < 3.5) & (across > -0.5)
        seen = np.isfinite(see(depth))
        assert seen[inside & (angle < 79.0)].mean() > 0.99
        assert not seen[inside & (angle > 81.0)].any()


def test_a_border_wanders_by_half_a_pixel_and_a_plane_keeps_its_axial_noise() -> None:
    depth = np.full(SHAPE, 2.0)
    depth[:, 200:] = 1.0
    light = camera(replace(CONFIG, edge_dropout=0.0))
    near = np.stack([light.see(cast(depth)) < 1.5 for _ in range(40)])
    assert not near[:, :, :198].any()
    assert near[:, :, 203:].all()
    wanders = near[:, :, 200:202].mean()
    assert 0.7 < wanders < 0.97
    sloping = tilted(60.0, 1.2)
    inside = (sloping > 0.8) & (sloping < 1.6)
    errors = 21.6525 / see(sloping) - 21.6525 / sloping
    assert np.nanstd(errors[inside]) == pytest.approx(CONFIG.disparity_noise, rel=0.1)


def test_some_pixels_at_borders_are_missing() -> None:
    depth = np.full(SHAPE, 2.0)
    depth[:, 200:] = 1.0
    light = camera(replace(CONFIG, lateral_noise=0.0))
    missing = np.stack([np.isnan(light.see(cast(depth))) for _ in range(60)])
    assert missing[:, :, 200].mean() == pytest.approx(0.015, abs=0.005)
    assert not missing[:, :, 201:].any()


@pytest.mark.parametrize(
    ("key", "value"),
    [("baseline", 0.0), ("nearest", 5.0), ("disparity_noise", 0.01), ("steepest", 2.0)],
)
def test_a_camera_that_cannot_be_is_refused_by_its_key(key: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"structured_light.{key} cannot be"):
        replace(CONFIG, **{key: value})  # type: ignore[arg-type]


def test_the_robot_nao_carries_this_camera() -> None:
    table = load_robot("nao").file.camera
    assert table.structured_light is not None
    assert replace(CONFIG, **table.structured_light.model_dump()) == CONFIG
