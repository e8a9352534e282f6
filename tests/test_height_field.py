"""A height field is judged by its true surface: what stands on it, what is in the way, the way."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from treadwell.course.build import build_course
from treadwell.course.course import Course
from treadwell.course.height_field import FieldTop, HeightField
from treadwell.course.static_map import static_map
from treadwell.episode import Episode
from treadwell.errors import InputError
from treadwell.judging.contacts import Collision, Contacts, Touch
from treadwell.judging.ground_truth import GroundTruth
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.solving.solvable import is_solvable

Heights = NDArray[np.float64]
ROBOT = load_robot("qrio")
HEAD = 'schema = 1\nname = "hill"\ntime_limit = 25.0\n'
HALF_X, HALF_Y = 1.5, 1.0
ROWS, COLUMNS = 41, 61
X = np.linspace(-HALF_X, HALF_X, COLUMNS)
"""Along a field, from its middle, m."""


def across(profile: Heights) -> Heights:
    """A field whose height is the same all across it, (rows, columns) m."""
    return np.tile(profile, (ROWS, 1))


def write(folder: Path, heights: Heights, *, turn: str = "0 0 0", more: str = "") -> Path:
    """Write a world with a field of heights above 0, its middle at (1, 0), and a scenario in it."""
    low = heights.min()
    most = max(0.001, heights.max() - low)  # MuJoCo stretches what it reads over all of this
    shares = " ".join(f"{share:.6f}" for share in ((heights - low) / most).ravel())
    rows, columns = heights.shape
    (folder / "hill.xml").write_text(
        f'<mujoco><asset><hfield name="h" nrow="{rows}" ncol="{columns}" elevation="{shares}" '
        f'size="{HALF_X} {HALF_Y} {most:.6f} {low + 0.05:.6f}"/></asset><worldbody>'
        f'<geom name="hill" type="hfield" hfield="h" pos="1 0 {low:.6f}" euler="{turn}"/>'
        f"{more}</worldbody></mujoco>"
    )
    path = folder / "hill.toml"
    path.write_text(
        f'{HEAD}[start]\n[goal]\nposition = [0.6, 0.0]\n[[course]]\nkind = "mjcf"\n'
        'name = "hill"\nfile = "hill.xml"\n'
    )
    return path


def course_of(path: Path, *settings: str) -> Course:
    return build_course(load_scenario(path, overrides=settings), ROBOT)


def ray_height(course: Course, x: float, y: float) -> float:
    data = mujoco.MjData(course.model)
    mujoco.mj_kinematics(course.model, data)
    down = mujoco.mj_ray(
        course.model, data, np.array([x, y, 5.0]), np.array([0.0, 0.0, -1.0]), None, 1, -1,
        np.zeros(1, np.int32),
    )  # fmt: skip
    return 5.0 - down


PLATEAU = across(np.full(COLUMNS, 0.12))


@pytest.mark.parametrize("turn", ["0 0 0", "0 0 25"])
def test_its_height_is_that_at_which_a_ray_meets_it(tmp_path: Path, turn: str) -> None:
    generator = np.random.default_rng(4)
    rough = generator.uniform(0.02, 0.2, (7, 5))
    rough[3, 2:4] = 0.1
    path = write(tmp_path, rough, turn=turn)
    course = course_of(path, "start.position=[-4.0, 0.0]")
    points = np.array([1.0, 0.0]) + generator.uniform(-0.8, 0.8, (200, 2))
    met = [ray_height(course, x, y) for x, y in points]
    np.testing.assert_allclose(course.height_at(points), met, atol=1e-5)
    assert course.height_at(np.array([[-3.0, 0.0]]))[0] == 0.0


def test_it_is_one_surface_and_the_ground_below_is_none(tmp_path: Path) -> None:
    course = course_of(write(tmp_path, PLATEAU))
    (element,) = course.elements
    (top,) = element.tops
    assert isinstance(top, FieldTop)
    assert top.height == pytest.approx(0.12)
    assert element.walkable
    assert course.levels_at(0.5, 0.3) == [pytest.approx(0.12)]
    assert course.levels_at(-1.0, 0.3) == [0.0]
    assert course.start.height == pytest.approx(0.12)
    assert course.goal_height == pytest.approx(0.12)


def test_who_stands_low_on_it_is_not_inside_of_it(tmp_path: Path) -> None:
    """The box around it reaches up to its highest place, and over the whole of it."""
    valley = across(np.where(np.abs(X + 1.0) < 0.6, 0.05, 0.4))
    path = write(tmp_path, valley)
    assert course_of(path).start.height == pytest.approx(0.05)
    with pytest.raises(InputError, match="over a void"):
        course_of(path, "start.position=[0.6, 0.0]")


def test_a_tilted_one_is_an_obstacle_as_a_tilted_box_is(tmp_path: Path) -> None:
    course = course_of(write(tmp_path, PLATEAU, turn="0 20 0"), "start.position=[-4.0, 0.0]")
    assert not course.elements[0].walkable


def looked_at(course: Course, ahead: float, up: float) -> tuple[Touch, list[Collision]]:
    """Put the robot, as it stands, to a place, and look at its contacts once."""
    data = mujoco.MjData(course.model)
    data.qpos[:] = course.qpos
    data.qpos[:3] += (ahead, 0.0, up)
    mujoco.mj_forward(course.model, data)
    soles = GroundTruth(course.model, ROBOT).sole_bodies
    contacts = Contacts(course.model, course, ROBOT, soles)
    return contacts.look(data, 0.0, 0.01), contacts.collisions()


def test_a_touch_is_a_stand_a_fall_or_a_collision_by_where_it_is(tmp_path: Path) -> None:
    wall = across(np.where(X > -0.5, 0.5, 0.1))  # from x = 0.5 on
    course = course_of(write(tmp_path, wall))
    assert looked_at(course, 0.0, -0.001) == (Touch(left=True, right=True, fallen_part=None), [])
    lying, _ = looked_at(course, 0.0, -0.2)
    assert lying.fallen_part is not None
    touch, hits = looked_at(course, 0.5, -0.001)
    assert touch.left
    assert hits
    assert {hit.element for hit in hits} == {"hill"}
    assert touch.fallen_part is None


@pytest.mark.scenario
def test_soles_stand_on_it_and_nothing_collides(tmp_path: Path) -> None:
    """Before, every step on it was a collision with a box, and no sole ever stood."""
    slope = np.clip(0.08 + 0.05 * (X + 0.85), 0.08, 0.11)
    episode = Episode(write(tmp_path, across(slope)), seed=1)
    stood = 0
    while episode.verdict is None:
        episode.tick()
        stood += episode.judge.touch.left or episode.judge.touch.right
    assert episode.verdict.outcome == "goal_reached", episode.verdict.reason
    assert episode.judge.collisions == []
    assert episode.judge.falls == 0
    assert stood > 0.95 * 1e-7 * episode.simulation.time_ns
    x, y = episode.judge.frame[:2]
    true = episode.course.height_at(np.array([[x, y]]))[0]
    assert episode.judge.frame.z == pytest.approx(true, abs=0.004)
    assert episode.judge.stairs_climbed == 0  # a slope is no stair


def test_whether_there_is_a_way_is_asked_of_its_surface(tmp_path: Path) -> None:
    profiles = {
        "level": (np.full(COLUMNS, 0.12), True),
        "gentle": (np.clip(0.1 + 0.1 * (X + 0.8), 0.1, 0.15), True),
        "steep": (np.clip(0.1 + 0.4 * (X + 0.8), 0.1, 0.25), False),
        "a wall across": (np.where(np.abs(X + 0.7) < 0.06, 0.5, 0.1), False),
        "a hill behind": (np.where(X > 0.5, 0.5, 0.1), True),
    }
    for name, (profile, there_is) in profiles.items():
        path = write(tmp_path, across(profile))
        scenario = load_scenario(path)
        assert is_solvable(scenario, build_course(scenario, ROBOT), ROBOT) is there_is, name


def test_a_hill_beside_the_way_leaves_as_much_room_as_there_is(tmp_path: Path) -> None:
    y = np.linspace(-HALF_Y, HALF_Y, ROWS)
    for gap, there_is in ((0.5, True), (0.2, False)):
        walls = np.where(np.abs(y) < gap / 2, 0.1, 0.6)[:, None] * np.ones(COLUMNS)
        walls[:, np.abs(X + 1.0) < 0.5] = 0.1
        path = write(tmp_path, walls)
        scenario = load_scenario(path, overrides=("goal.position=[1.5, 0.0]",))
        found = is_solvable(scenario, build_course(scenario, ROBOT), ROBOT)
        assert found is there_is, gap


def test_the_map_that_a_robot_is_told_has_it(tmp_path: Path) -> None:
    """MuJoCo ends the process where a ray is asked of a height field as of a simple shape."""
    steps = across(np.where(X < 0.0, 0.06, 0.3))
    tree = static_map(course_of(write(tmp_path, steps)), 0.04, "hill")
    for x, z, solid in ((0.5, 0.02, True), (0.5, 0.1, False), (1.5, 0.1, True), (1.5, 0.34, False)):
        there = tree.log_odds(np.array([[x, 0.3, z]]))[0] > 0.0
        assert bool(there) is solid, (x, z)


def test_the_highest_within_a_radius_is_found_to_within_a_block() -> None:
    generator = np.random.default_rng(7)
    heights = generator.uniform(0.0, 1.0, (30, 40))
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    field = HeightField(heights, np.array([2.0, -1.0]), turn, np.array([0.5, 0.4]), -0.1)
    columns, rows = np.meshgrid(np.linspace(-0.5, 0.5, 40), np.linspace(-0.4, 0.4, 30))
    places = np.column_stack([columns.ravel(), rows.ravel()])
    world = places @ turn.T + field.middle
    np.testing.assert_allclose(field.surface(world), heights.ravel(), atol=1e-12)
    radius, block = 0.2, 0.2 / 6
    for point in field.middle + generator.uniform(-0.2, 0.2, (50, 2)):
        away = np.hypot(*(world - point).T)
        found = field.highest(point[None], radius)[0]
        assert found >= heights.ravel()[away <= radius - 2 * block].max()
        assert found <= heights.ravel()[away <= radius + 2 * block].max()


def test_it_is_as_steep_as_its_triangles_are() -> None:
    heights = np.array([[0.0, 0.1, 0.1], [0.0, 0.2, 0.1]])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])  # its x is the world's y
    field = HeightField(heights, np.zeros(2), turn, np.array([0.2, 0.1]), 0.0)
    step = 1e-6
    points = np.random.default_rng(3).uniform([-0.09, -0.19], [0.09, 0.19], (200, 2))
    rises = [
        (field.surface(points + way) - field.surface(points - way)) / (2 * step)
        for way in (np.array([step, 0.0]), np.array([0.0, step]))
    ]
    expected = 1.0 / np.sqrt(1.0 + rises[0] ** 2 + rises[1] ** 2)
    np.testing.assert_allclose(field.upward(points), expected, atol=1e-6)
