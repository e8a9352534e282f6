"""Claims about depth images that others took: `TREADWELL_DATA` says where they are."""

import os
from pathlib import Path

import numpy as np
import pytest
import real_data
from real_frames import TABLES, RealFrame, labelled_table, room, simulated_scan, through_stereo

from treadwell.measuring.regions import RegionCounts
from treadwell.senses.depth import Pinhole

DATA = os.environ.get("TREADWELL_DATA")
needs_data = pytest.mark.skipif(DATA is None, reason="TREADWELL_DATA does not say where data are")


def data() -> Path:
    assert DATA is not None
    return Path(DATA)


@pytest.fixture(scope="module")
def table() -> RealFrame:
    return labelled_table(data())


@pytest.fixture(scope="module")
def scan() -> RealFrame:
    return simulated_scan(data())


def wedge() -> RealFrame:
    """Two planes that meet at a vertical crease, seen by the Kinect."""
    pinhole = Pinhole(640, 480, 525.0)
    x = np.abs(pinhole.directions()[:, 0])
    depth = (1.0 / (1.0 + 0.3 * x)).reshape(480, 640)
    truth = np.where(pinhole.directions()[:, 0] < 0.0, 1, 2).reshape(480, 640)
    return RealFrame(depth, truth, pinhole, 0.06)


def test_a_frame_through_the_robots_eyes_shows_the_same_with_the_robots_noise() -> None:
    frame = wedge()
    seen = through_stereo(frame, 3)
    assert seen.depth.shape == (72, 88)
    exact = 1.0 / (1.0 + 0.3 * np.abs(seen.pinhole.directions()[:, 0])).reshape(72, 88)
    off = seen.pinhole.focal * 0.06 * (1.0 / seen.depth - 1.0 / exact)
    off = off[np.isfinite(off)]
    assert off.size > 4000
    assert 0.08 < np.median(np.abs(off)) / 0.6745 < 0.16
    np.testing.assert_array_equal(through_stereo(frame, 3).depth, seen.depth)
    assert not np.array_equal(through_stereo(frame, 4).depth, seen.depth, equal_nan=True)


def test_ransac_finds_the_plane_that_most_points_lie_on() -> None:
    random = np.random.default_rng(1)
    points = random.uniform(-1.0, 1.0, (900, 3))
    points[:600, 2] = 0.0
    points[:, 2] += 2.0
    normal, distance = real_data.ransac_plane(points)
    assert normal @ [0.0, 0.0, -1.0] > 0.9999
    assert distance == pytest.approx(2.0, abs=2e-3)


@needs_data
def test_one_plane_by_ransac_is_the_table_as_it_is_said_of_the_data(table: RealFrame) -> None:
    assert real_data.ransac_alone(table) == pytest.approx(0.997, abs=0.001)


@needs_data
def test_the_table_is_found_at_full_resolution(table: RealFrame) -> None:
    pose = real_data.table_pose(table)
    for name in ("scan_line", "scan_line_adaptive"):
        iou, _ = real_data.support_plane(name, table, real_data.KINECT, pose)
        assert iou > 0.993, name


@needs_data
def test_the_table_is_found_by_the_robots_eyes_up_to_half_a_matching_window(
    table: RealFrame,
) -> None:
    pose = real_data.table_pose(table)
    frames = [through_stereo(table, seed) for seed in range(60)]
    rows = [real_data.support_plane("scan_line", frame, real_data.ROBOT, pose) for frame in frames]
    everywhere, away_from_edges = np.array(rows).T
    # One noise in thirty cuts the table in pieces: 9 of 300, and 11 with the noise of before.
    assert np.mean(away_from_edges > 0.98) >= 0.9
    assert np.median(everywhere) > 0.945


@needs_data
def test_the_table_is_found_whatever_the_camera_believes_within_the_gate(table: RealFrame) -> None:
    frame = through_stereo(table, 0)
    points = real_data.points_of(table)
    normal, height = real_data.ransac_plane(points[np.isfinite(points[:, 2])])
    for degrees in ((1e-6, 0.0), (5.0, 0.0), (-5.0, 0.0), (0.0, 5.0), (0.0, -5.0), (4.0, -4.0)):
        for rise in (-0.01, 0.01):
            turn = np.radians([*degrees, 0.0])
            pose = real_data.pose_above(normal, height, turn, rise)
            iou, _ = real_data.support_plane("scan_line", frame, real_data.ROBOT, pose)
            assert iou > 0.94, (degrees, rise)


@needs_data
@pytest.mark.parametrize("name", TABLES)
def test_the_table_under_clutter_is_the_ground_of_a_single_picture(name: str) -> None:
    full = labelled_table(data(), name)
    points = real_data.points_of(full)
    normal, height = real_data.ransac_plane(points[np.isfinite(points[:, 2])])
    found = []
    for seed in range(5):
        frame, pose = through_stereo(full, seed), real_data.wrong_pose(normal, height, seed)
        found.append(real_data.support_plane("scan_line", frame, real_data.ROBOT, pose)[0])
    assert sum(iou > real_data.FOUND for iou in found) >= 4, found
    assert all(iou > 0.85 for iou in found if iou > real_data.FOUND), found


@needs_data
def test_nine_tenths_of_the_scans_planes_are_correct_and_none_are_merged(scan: RealFrame) -> None:
    name, settings = "scan_line_adaptive", real_data.SCANNER
    as_it_is = real_data.regions(name, scan, settings)
    assert as_it_is == RegionCounts(true=10, correct=10)
    cases = (real_data.regions(name, frame, settings) for frame in real_data.turned(scan))
    counts = sum(cases, RegionCounts())
    assert counts.true == 80
    assert 10 * counts.correct >= 9 * counts.true
    assert (counts.under, counts.missed, counts.noise) == (0, 0, 0)


@needs_data
def test_of_all_segmenters_the_adaptive_one_finds_most_planes_of_the_scan(scan: RealFrame) -> None:
    counts = {
        name: real_data.regions(name, scan, real_data.SCANNER) for name in real_data.SEGMENTERS
    }
    ours = counts.pop("scan_line_adaptive")
    assert all(ours.correct >= other.correct + 3 for other in counts.values()), counts


@needs_data
@pytest.mark.parametrize("name", ["scan_line_adaptive", "ransac"])
def test_planes_explain_a_real_room_to_within_its_noise(name: str) -> None:
    frame = room(data())
    planes = real_data.segment(name, frame, real_data.KINECT, real_data.LENGTHWISE)
    fit = real_data.fit_of(frame, planes)
    assert fit["share"] > 0.95
    assert fit["residual_px"] < 0.25


@needs_data
def test_frames_are_read_as_their_files_say(table: RealFrame, scan: RealFrame) -> None:
    assert table.depth.shape == (480, 640)
    assert (table.truth == 1).sum() == 160296
    assert np.nanmin(table.depth) == pytest.approx(0.493, abs=1e-3)
    counted = [int((scan.truth == plane).sum()) for plane in (14, 18, 44)]
    assert counted == pytest.approx([2305, 3068, 1161], rel=0.05)
    assert np.isfinite(room(data()).depth).mean() == pytest.approx(0.853, abs=1e-3)
