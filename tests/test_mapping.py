"""The library: maps, stairs and ways of pictures that nobody of this project took."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from boxes_seen import CAMERA, Floats, flight, looking, seen
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import DTypeLike, NDArray

from treadwell import mapping
from treadwell._core import Goal, Planes, Scan, Staircase
from treadwell.errors import CoreError, InputError
from treadwell.protocols import Plan, Pose, Segmentation, Setup

STAIRS = flight(rise=0.03, tread=0.2, steps=3)
FAR = (5000.0, 3000.0, 20.0)


def noisy(picture: Floats, rng: np.random.Generator) -> Floats:
    return picture + rng.normal(0.0, 0.002, picture.shape) * picture**2


def world_of_stairs(
    model: object = "fog", at: tuple[float, ...] = (0, 0, 0), **more: object
) -> mapping.Map:
    world = mapping.Map(model, CAMERA, robot="qrio", **more)
    rng, there = np.random.default_rng(0), np.eye(4)
    there[:3, 3] = at
    for k in range(8):
        pose = looking(0.02 * k, 0.0, 0.5)
        found = world.insert(noisy(seen(STAIRS, pose), rng), there @ pose)
        assert found.used
        assert found.reason is None
    return world


def height_at(view: mapping.FloorView, x: float, y: float) -> float:
    col, row = np.floor((np.array((x, y)) - view.origin) / view.cell).astype(int)
    assert view.kind[row, col] == 1
    return float(view.height[row, col])


@pytest.mark.parametrize("model", ["fog", "elevation", "averaging", "octree", "multi_level"])
@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), FAR])
def test_any_world_model_has_the_treads_at_their_heights(
    model: str, at: tuple[float, float, float]
) -> None:
    view = world_of_stairs(model, at).view()
    for x, height in ((0.45, 0.0), (0.7, 0.03), (0.9, 0.06), (1.1, 0.09)):
        assert height_at(view, at[0] + x, at[1]) == pytest.approx(at[2] + height, abs=0.006)
    assert view.sightings.max() > 1


@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), FAR])
def test_stairs_are_found_with_their_measures_and_climbed(at: tuple[float, float, float]) -> None:
    world = world_of_stairs(at=at)
    stairs = mapping.find_stairs(world)
    assert len(stairs) == 3
    for k, stair in enumerate(stairs):
        assert stair.rise == pytest.approx(0.03, abs=0.004)
        assert stair.height == pytest.approx(at[2] + 0.03 * (k + 1), abs=0.005)
        assert stair.front[0][0] == pytest.approx(at[0] + 0.6 + 0.2 * k, abs=0.015)
        assert stair.width == pytest.approx(0.6, abs=0.04)
        assert stair.reason is None
    assert [stair.tread for stair in stairs[:2]] == pytest.approx([0.2, 0.2], abs=0.015)
    assert stairs[0].edge_sigma is not None
    x, y, z = at
    way = mapping.plan(world, start=(x, y, 0.0), goal=(x + 1.3, y, z + 0.09))
    assert way.reason is None
    assert way.path is not None
    assert way.end == "goal"
    assert sum(len(climb.steps) for climb in way.climbs) == 3
    assert np.hypot(*(way.path[-1] - (x + 1.3, y))) < 0.11


def test_a_stair_that_is_too_high_says_so() -> None:
    world = mapping.Map("fog", CAMERA, robot="qrio")
    for k in range(6):
        pose = looking(0.02 * k, 0.0, 0.5)
        world.insert(seen(flight(0.07, 0.25, 2), pose), pose)
    reasons = [stair.reason for stair in mapping.find_stairs(world)]
    assert reasons
    assert all(reason is not None and reason.startswith("step_too_high: ") for reason in reasons)


def test_a_frame_says_why_it_was_not_used_or_why_nothing_came_of_it() -> None:
    world = mapping.Map("fog", CAMERA)
    nothing = world.insert(np.zeros((120, 160)), looking(0.0, 0.0, 0.5))
    assert (nothing.used, nothing.reason) == (False, "nothing was seen")
    up = world.insert(np.full((120, 160), 1.0), looking(0.0, 0.0, 0.5, down=-0.1))
    assert (up.used, up.reason) == (True, "no level surface was found")
    good = world.insert(seen(STAIRS, looking(0.0, 0.0, 0.5)), looking(0.0, 0.0, 0.5))
    assert good.reason is None
    assert good.planes is not None
    assert len(good.planes.regions) >= 3


@given(
    st.sampled_from([np.float16, np.float32, np.float64, ">f4"]),
    st.sampled_from(["C", "F", "strided", "reversed"]),
)
def test_any_float_type_and_stride_gives_the_same_map(dtype: DTypeLike, layout: str) -> None:
    pose = looking(0.0, 0.0, 0.5)
    exact = np.nan_to_num(seen(STAIRS, pose)).astype(np.float16)
    given_as: NDArray[Any] = exact.astype(dtype)
    if layout == "F":
        given_as = np.asfortranarray(given_as)
    elif layout == "strided":
        given_as = np.repeat(given_as, 2, axis=1)[:, ::2]
    elif layout == "reversed":
        given_as = given_as[::-1].copy()[::-1]
    heights = []
    for picture in (exact.astype(np.float32), given_as):
        world = mapping.Map("elevation", CAMERA)
        world.insert(picture, pose)
        heights.append(world.view().height)
    np.testing.assert_array_equal(*heights)


class Last:
    """A world model that keeps the last frame's points as heights."""

    def __init__(self, cell: float = 0.05) -> None:
        self.cell, self.height = cell, np.full((80, 80), np.nan)

    def insert(self, planes: Planes, pose: Pose) -> bool:
        points = planes.points_in_robot[np.isfinite(planes.points_in_robot).all(axis=1)]
        x, y, z, yaw = pose
        along = x + np.cos(yaw) * points[:, 0] - np.sin(yaw) * points[:, 1]
        across = y + np.sin(yaw) * points[:, 0] + np.cos(yaw) * points[:, 1]
        col, row = (np.floor(np.array((along, across)) / self.cell) + 40).astype(int)
        inside = (row >= 0) & (row < 80) & (col >= 0) & (col < 80)
        self.height[row[inside], col[inside]] = z + points[inside, 2]
        return True

    def view(self) -> mapping.FloorView:
        half = -40 * self.cell
        return mapping.floor_view(self.height, cell=self.cell, origin=(half, half))


@pytest.mark.parametrize("given_as", ["class", "object", "name"])
def test_a_world_model_of_ones_own_is_as_good_as_a_built_in(given_as: str) -> None:
    model: Any = {"class": Last, "object": Last(), "name": f"{__name__}:Last"}[given_as]
    world = world_of_stairs(
        model, overrides={"Last": {"cell": 0.04}} if given_as != "object" else {}
    )
    view = world.view()
    assert view.cell == (0.05 if given_as == "object" else 0.04)
    assert height_at(view, 0.9, 0.0) == pytest.approx(0.06, abs=0.02)
    assert len(mapping.find_stairs(world)) == 3


def test_what_a_world_model_of_ones_own_has_wrong_is_named() -> None:
    class Wrong(Last):
        def view(self) -> mapping.FloorView:
            class View:
                origin, cell = (0.0, 0.0), 0.05
                kind = np.zeros((4, 4), np.int64)
                height = np.zeros((4, 4), np.float32)

            return cast("mapping.FloorView", View())

    world, pose = mapping.Map(Wrong, CAMERA), looking(0.0, 0.0, 0.5)
    wanted = r"view\(\)\.kind must be uint8 \(rows, cols\), got int64 \(4, 4\)"
    with pytest.raises(CoreError, match=rf"world_model: Wrong: .*{wanted}"):
        world.insert(seen(STAIRS, pose), pose)


class Seeing:
    """A segmenter that takes all that it sees for the ground, and keeps what it was given."""

    def __init__(self) -> None:
        self.scans: list[Scan] = []

    def segment(self, scan: Scan) -> Segmentation:
        self.scans.append(scan)
        labels = np.isfinite(scan.depth).ravel().astype(np.uint16)
        return Segmentation(labels, [0.0], scan.robot_from_camera, ground=0, reliable=True)


@pytest.mark.parametrize(
    "camera",
    [
        CAMERA,
        mapping.Camera(width=160, height=120, fx=150.0, fy=148.0, cx=110.0, cy=30.0),
        mapping.Camera(width=161, height=121, fx=150.0, fy=160.0, cx=60.0, cy=75.5),
    ],
)
def test_a_segmenters_points_lie_on_the_floor_wherever_the_optical_axis_is(
    camera: mapping.Camera,
) -> None:
    part, pose = Seeing(), looking(0.0, 0.0, 0.5)
    world = mapping.Map("fog", camera, segmenter=part)
    for _ in range(6):
        found = world.insert(seen([], pose, camera), pose)
    assert found.reason is None
    scan = part.scans[-1]
    rows, cols = np.indices((scan.height, scan.width))
    x, y, depth = np.moveaxis(scan.points_in_camera.astype(float), -1, 0)
    np.testing.assert_allclose(x, (cols - scan.cx) / scan.fx * depth, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(y, (rows - scan.cy) / scan.fy * depth, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(scan.disparity, scan.fx * scan.baseline / scan.depth, rtol=1e-5)
    placed = scan.points_in_camera @ scan.robot_from_camera[:3, :3].T
    placed = placed + scan.robot_from_camera[:3, 3]
    near = np.isfinite(depth) & (depth < 1.2)
    assert near.sum() > 2000
    # Half a pixel, which is what a picture may be laid off by.
    assert np.abs(placed[near][:, 2]).max() < 0.6 / scan.fx * 1.2
    view = world.view()
    assert (view.kind == 1).sum() > 100
    assert np.nanmax(np.abs(view.height)) < 1e-3


def test_what_a_segmenter_of_ones_own_has_wrong_is_named() -> None:
    class Wrong:
        def segment(self, _: Scan) -> None:
            return None

    world, pose = mapping.Map("fog", CAMERA, segmenter=Wrong), looking(0.0, 0.0, 0.5)
    with pytest.raises(CoreError, match=r"segmenter: Wrong: .*must return a Segmentation, got N"):
        world.insert(seen(STAIRS, pose), pose)


def test_stairs_are_found_by_the_surfaces_of_ones_own_segmenter() -> None:
    class Levels(Seeing):
        def segment(self, scan: Scan) -> Segmentation:
            pose = scan.robot_from_camera
            height = (scan.points_in_camera @ pose[:3, :3].T + pose[:3, 3])[..., 2].ravel()
            labels = np.zeros(height.shape, np.uint16)
            for k in range(4):
                labels[np.abs(height - 0.03 * k) < 0.004] = k + 1
            return Segmentation(labels, [0.0, 0.03, 0.06, 0.09], pose, ground=0, reliable=True)

    assert len(mapping.find_stairs(world_of_stairs(segmenter=Levels))) == 3


def test_a_floor_that_leans_is_told_with_what_is_up() -> None:
    assert world_of_stairs().notes == ()
    lean = math.radians(12.0)
    tilt = np.eye(4)
    tilt[:3, :3] = [
        [math.cos(lean), 0, math.sin(lean)],
        [0, 1, 0],
        [-math.sin(lean), 0, math.cos(lean)],
    ]
    world = mapping.Map("elevation", CAMERA)
    assert world.notes == ()
    pose = looking(0.0, 0.0, 0.5)
    world.insert(seen(STAIRS, pose), tilt @ pose)
    (note,) = world.notes
    degrees = float(note.split("leans by ")[1].split(" degrees")[0])
    up = [float(one) for one in note.split("(")[1].split(")")[0].split(",")]
    assert abs(degrees - 12.0) < 0.5
    assert np.allclose(up, tilt[:3, 2], atol=0.01)


def box_in_the_way(top: float) -> mapping.FloorView:
    height = np.zeros((60, 80))
    height[20:40, 35:45] = top
    return mapping.floor_view(height, cell=0.04)


class Straight:
    """A planner that only goes straight, where it may."""

    def begin(self, setup: Setup) -> None:
        self.radius = setup.robot["body"]["radius"]

    def plan(self, view: mapping.FloorView, _: Staircase, start: Pose, goal: Goal) -> Plan:
        points = np.linspace(start[:2], goal.position, 50)
        col, row = np.floor((points - view.origin) / view.cell).astype(int).T
        free = view.passable(start[2], 0.015, self.radius)[row, col].all()
        return Plan(points) if free else Plan(None, "blocked: not straight ahead")


def test_ways_go_around_a_flat_top_and_over_a_mat() -> None:
    start, goal = (0.4, 1.2, 0.0), (2.8, 1.2)
    way = mapping.plan(box_in_the_way(0.3), start, goal)
    assert way.path is not None
    col, row = np.floor(way.path / 0.04).astype(int).T
    assert not ((row >= 20) & (row < 40) & (col >= 35) & (col < 45)).any()
    over = mapping.plan(box_in_the_way(0.01), start, goal)
    assert over.cost < way.cost
    assert mapping.plan(box_in_the_way(0.3), start, goal, planner=Straight).path is None
    assert mapping.plan(box_in_the_way(0.01), start, goal, planner=Straight()).path is not None
    for planner in ("voronoi", "field_d_star", "ara_star"):
        assert mapping.plan(box_in_the_way(0.3), start, goal, planner=planner).path is not None


def test_where_there_is_no_way_the_reason_is_given() -> None:
    height = np.zeros((60, 80))
    height[:, 40:44] = 0.5
    way = mapping.plan(mapping.floor_view(height, cell=0.04), (0.4, 1.2, 0.0), (2.8, 1.2))
    assert way.path is None
    assert way.reason is not None
    assert ": " in way.reason
    assert math.isinf(way.cost)


CLOUD = np.random.default_rng(1).uniform((-1, -1, 0), (1, 1, 0.001), (2000, 3))


def test_a_cloud_is_mapped_from_where_its_sensor_was() -> None:
    world = mapping.Map("elevation")
    above = np.eye(4)
    above[2, 3] = 1.0
    assert world.insert_points(CLOUD - (0, 0, 1.0), above).used
    view = world.view()
    assert np.nanmedian(view.height) == pytest.approx(0.0, abs=0.01)
    assert mapping.plan(world, (-0.5, 0.0, 0.0), (0.5, 0.0)).path is not None


AWAY = (0.4, 1.2, 0.0), (2.8, 1.2)


class Nothing:
    def plan(self, *_: object) -> None: ...


MILLIMETRES = np.full((120, 160), 1500, np.uint16)
SKEW = np.diag([2.0, 1.0, 1.0, 1.0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mapping.Camera(0, 10, 1.0, 1.0, 0.0, 0.0), "Camera: width must be"),
        (lambda: mapping.Camera(10, 10, math.nan, 1.0, 0.0, 0.0), "Camera: fx must be"),
        (lambda: mapping.Camera(10, 10, 1.0, 1.0, math.inf, 0.0), "Camera: cx must be"),
        (lambda: mapping.Map("fogg", CAMERA), r"world_model: .*fogg.*fog"),
        (lambda: mapping.Map("fog", CAMERA, overrides={"fog.cel": 1}), "cel"),
        (lambda: mapping.Map("fog", CAMERA, overrides={"fgo": {"cell": 1}}), "fgo"),
        (lambda: mapping.Map("fog", CAMERA, overrides=["fog.cell"]), "KEY=VALUE"),
        (lambda: mapping.Map("fog", CAMERA, overrides=cast("Any", [1])), "must be KEY=VALUE"),
        (lambda: mapping.Map(object, CAMERA), "has no method insert, view"),
        (lambda: mapping.Map("fog", CAMERA, segmenter=object), "has no method segment"),
        (lambda: mapping.Map("fog", CAMERA, segmenter="scan_lin"), "scan_line"),
        (lambda: mapping.Map("fog", CAMERA).view(), "no frame was taken in yet"),
        (lambda: mapping.Map("fog").insert(np.ones((2, 2)), np.eye(4)), "without a camera"),
        (lambda: mapping.Map("fog", CAMERA).insert(np.ones((2, 2)), np.eye(4)), r"\(120, 160\)"),
        (lambda: mapping.Map("fog", CAMERA).insert(MILLIMETRES, np.eye(4)), "divide by its units"),
        (lambda: mapping.Map("fog", CAMERA).insert(1e5 * np.ones((120, 160)), np.eye(4)), "metres"),
        (lambda: mapping.Map("fog", CAMERA).insert(np.ones((120, 160)), SKEW), "a rotation and"),
        (lambda: mapping.Map("fog", CAMERA).insert(np.ones((120, 160)), [1]), r"\(4, 4\) matrix"),
        (
            lambda: mapping.Map("fog").insert_points(CLOUD, np.eye(4)),
            "finds its floors in pictures",
        ),
        (lambda: mapping.Map("elevation").insert_points([1.0], np.eye(4)), r"numbers \(n, 3\)"),
        (lambda: mapping.find_stairs(mapping.Map("fog", CAMERA)), "needs a camera and a robot"),
        (lambda: mapping.floor_view([1.0], cell=0.1), r"height must be numbers \(rows"),
        (lambda: mapping.floor_view([[1.0]], cell=-1.0), "cell must be finite and > 0"),
        (lambda: mapping.floor_view([[1.0]], cell=1.0, kind=[[7]]), "kind must be 0, 1 or 2"),
        (lambda: mapping.floor_view([[1.0]], cell=1.0, kind=[[-1]]), "from 0 to 255"),
        (lambda: mapping.floor_view([[1.0]], cell=1.0, kind=[[1.5]]), "whole numbers"),
        (lambda: box_in_the_way(0.3).passable(0.0, -1.0, 0.1), "rise must be"),
        (lambda: mapping.plan(box_in_the_way(0.3), (0, 0), (1, 1)), "start must be 3 finite"),
        (lambda: mapping.plan(box_in_the_way(0.3), (0, 0, 0), (1, math.nan)), "goal must be 2"),
        (lambda: mapping.plan(box_in_the_way(0.3), (0, 0, 0), (1, 1), planner="a_sta"), "a_star"),
        (lambda: mapping.plan(box_in_the_way(0.3), (0, 0, 0), (1, 1), robot="qro"), "qrio"),
        (lambda: mapping.plan(box_in_the_way(0.3), *AWAY, planner=Nothing), "a Plan, got None"),
        (
            lambda: mapping.plan(object(), (0, 0, 0), (1, 1)),
            r"view\(\) must return a FloorMap, got object",
        ),
    ],
)
def test_what_cannot_be_is_refused_by_its_name(call: Callable[[], object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        call()


def test_floats_of_millimetres_are_refused_and_a_few_far_pixels_are_not() -> None:
    """By the rule of `treadwell map`: no depth camera sees half of a picture beyond 100 m."""
    world = mapping.Map("fog", CAMERA)
    far = np.full((120, 160), np.nan)
    far[:, :80] = 1.5
    far[:, 80:159] = 1500.0
    assert world.insert(far, np.eye(4)).used
    far[:, 70:] = 1500.0
    with pytest.raises(InputError, match=r"beyond 100, its median at 1500, .*1000 for millimetres"):
        world.insert(far.astype(np.float16), np.eye(4))


def test_paths_may_be_strings_or_not(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=str(tmp_path)):
        mapping.find_stairs(_stairs_of(tmp_path))


def _stairs_of(robot: Path) -> mapping.Map:
    world = mapping.Map("fog", CAMERA, robot=robot)
    world.insert(seen(STAIRS, looking(0.0, 0.0, 0.5)), looking(0.0, 0.0, 0.5))
    return world
