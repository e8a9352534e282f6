"""Claims about the note on a floor that leans: how exact it is in what a noisy camera saw."""

import math

import numpy as np
import pytest

from treadwell import mapping
from treadwell.map_making.leaning import Leaning
from treadwell.map_making.request import MapTable
from treadwell.sources.frame import Floats, PinholeCamera, RangeFrame

CAMERA = mapping.Camera(width=88, height=72, fx=100.0, fy=100.0, cx=43.5, cy=35.5)
HIGH_M, BASELINE_M, OFF_PIXELS = 0.5, 0.075, 0.25
DOWN = math.radians(40.0)
LEVEL = MapTable().level_within


def level_camera(heading: float) -> Floats:
    """(4, 4) world from camera, which looks down at a level floor at z = 0."""
    c, s = math.cos(DOWN), math.sin(DOWN)
    # Columns: right, down, ahead.
    turn = np.array([[0.0, -s, c], [-1.0, 0.0, 0.0], [0.0, -c, -s]])
    h, k = math.cos(heading), math.sin(heading)
    pose = np.eye(4)
    pose[:3, :3] = np.array([[h, -k, 0.0], [k, h, 0.0], [0.0, 0.0, 1.0]]) @ turn
    pose[2, 3] = HIGH_M
    return pose


def tilted(angle: float) -> Floats:
    """(4, 4) a world that leans sideways by this, rad."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.eye(4)
    turn[:3, :3] = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return turn


def looked(angle: float, camera: PinholeCamera = CAMERA, off: float = OFF_PIXELS) -> Leaning:
    """What 40 pictures of a narrow stereo pair show of a floor in a world that leans."""
    draws, leaning = np.random.default_rng(0), Leaning()
    rows, _ = np.indices((camera.height, camera.width))
    sines = np.sin(DOWN) + np.cos(DOWN) * (rows - camera.cy) / camera.fy
    with np.errstate(divide="ignore"):
        true = np.where(sines > 0.1, HIGH_M / sines, np.nan)
    for number in range(40):
        disparity = camera.fx * BASELINE_M / true + draws.normal(0.0, off, true.shape)
        depth = (camera.fx * BASELINE_M / disparity).astype(np.float32)
        pose = tilted(angle) @ level_camera(0.15 * number)
        leaning.insert(RangeFrame(float(number), pose, camera, depth, None, "picture"), pose)
    return leaning


def test_the_noise_of_a_stereo_pair_makes_no_level_floor_lean() -> None:
    found = looked(0.0).found()
    assert found is not None
    assert found.angle < 0.5 * LEVEL
    assert looked(0.0).of_poses(MapTable()) == ()


@pytest.mark.parametrize("degrees", [6.0, -12.0, 25.0])
def test_a_lean_is_told_to_a_degree_or_two_through_the_noise(degrees: float) -> None:
    found = looked(math.radians(degrees)).found()
    assert found is not None
    up = tilted(math.radians(degrees))[:3, 2]
    assert math.degrees(math.acos(float(up @ found.up))) < 1.5
    assert looked(math.radians(degrees)).of_poses(MapTable())


def test_without_noise_it_is_exact_wherever_the_axis_is() -> None:
    askew = mapping.Camera(width=88, height=72, fx=100.0, fy=100.0, cx=30.0, cy=20.0)
    found = looked(0.2, askew, off=0.0).found()
    assert found is not None
    assert found.angle == pytest.approx(0.2, abs=1e-3)


def test_pictures_smaller_than_a_block_tell_nothing() -> None:
    tiny = mapping.Camera(width=7, height=7, fx=10.0, fy=10.0, cx=3.0, cy=3.0)
    leaning = Leaning()
    depth = np.ones((7, 7), np.float32)
    leaning.insert(RangeFrame(0.0, np.eye(4), tiny, depth, None, "picture"), np.eye(4))
    assert leaning.found() is None
