"""Whether there is a way: the true course, the robot's published limits."""

import math
import re
from pathlib import Path

import pytest
from episode_builders import qrio, scenario

from treadwell.course.build import build_course
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.solving.robot_limits import Limits, limits_of
from treadwell.solving.solvable import is_solvable
from treadwell.solving.true_ground import TrueGround, edges_of

ROOT = Path(__file__).parents[1]
WALLS = """
[[course]]
kind = "wall"
from = [-1.0, {y}]
to = [3.0, {y}]
height = 0.6
[[course]]
kind = "wall"
from = [-1.0, -{y}]
to = [3.0, -{y}]
height = 0.6
[[course]]
kind = "wall"
from = [-1.0, -{y}]
to = [-1.0, {y}]
height = 0.6
"""


def solvable(course: str, goal: str = "position = [2.0, 0.0]", walls: float = 0.5) -> bool | None:
    made = scenario(WALLS.format(y=walls) + course, goal)
    return is_solvable(made, build_course(made, qrio()), qrio())


def stairs(rise: float = 0.03, tread: float = 0.12, width: float = 0.9, steps: int = 3) -> str:
    return f"""
[[course]]
kind = "stairs"
position = [0.6, 0.0]
steps = {steps}
rise = {rise}
tread = {tread}
width = {width}
landing = 1.5
"""


def gap(width: float) -> str:
    y = 0.5 - width
    return f'[[course]]\nkind = "wall"\nfrom = [1.0, {-0.5}]\nto = [1.0, {y}]\nheight = 0.5\n'


def test_a_gap_wider_than_the_robot_is_a_way_and_a_narrower_one_is_none() -> None:
    """Its cylinder is 28 cm across; the grid's cells are 3 cm."""
    assert solvable("")
    assert solvable(gap(0.38))
    assert not solvable(gap(0.26))


def test_a_beam_above_the_head_is_a_way_and_one_below_is_none() -> None:
    beam = '[[course]]\nkind = "box"\nposition = [1.0, 0.0]\nsize = [0.1, 1.0, 0.1]\nbase = {}\n'
    assert solvable(beam.format(0.62))
    assert not solvable(beam.format(0.5))


def test_a_ceiling_over_a_landing_or_over_the_steps_leaves_a_way_or_none() -> None:
    """The robot's 0.58 m above the landing at 0.09 m, or above the second of three steps."""
    over = '[[course]]\nkind = "box"\nposition = [{x}, 0.0]\n'
    over += "size = [{long}, 1.0, 0.1]\nbase = {base}\n"
    goal = "position = [1.9, 0.0]"
    for x, long, clear, barred in [(1.9, 1.0, 0.70, 0.65), (0.9, 0.1, 0.69, 0.62)]:
        assert solvable(stairs() + over.format(x=x, long=long, base=clear), goal)
        assert not solvable(stairs() + over.format(x=x, long=long, base=barred), goal)


def test_a_post_before_the_steps_bars_those_it_stands_before() -> None:
    post = '[[course]]\nkind = "cylinder"\nposition = [0.55, {y}]\nradius = 0.03\nheight = 0.3\n'
    for y, way in [((0.0,), True), ((-0.3, -0.15, 0.0, 0.15, 0.3), False)]:
        posts = "".join(post.format(y=each) for each in y)
        assert solvable(stairs() + posts, "position = [1.9, 0.0]") is way


def slope(degrees: float, rise: float, *, width: float = 1.1) -> str:
    """A ramp across the corridor up to a floor that is as high, which ends in a drop to neither."""
    length = rise / math.tan(math.radians(degrees))
    keys = f"length = {length}\nwidth = {width}\nrise = {rise}\n"
    top = f"position = [{2.0 + length}, 0.0]\nsize = [2.0, 1.1, {rise}]\n"
    ramp = f'[[course]]\nkind = "ramp"\nposition = [1.0, 0.0]\n{keys}'
    return f'{ramp}[[course]]\nkind = "platform"\n{top}'


@pytest.mark.parametrize("robot", ["qrio", "nao"])
@pytest.mark.parametrize(
    ("degrees", "rise", "way"),
    [(3.0, 0.06, True), (10.0, 0.2, True), (10.0, 0.06, True), (13.0, 0.2, False),
     (12.5, 0.06, False), (20.0, 0.06, False)],
)  # fmt: skip
def test_a_slope_of_10_degrees_is_a_way_and_one_of_more_than_12_is_none(
    robot: str, degrees: float, rise: float, way: bool
) -> None:
    """A top 60 mm high has no edge that could be climbed instead."""
    body = load_robot(robot)
    made = scenario(WALLS.format(y=0.5) + slope(degrees, rise), "position = [2.7, 0.0]")
    assert is_solvable(made, build_course(made, body), body) is way


def test_the_floor_beside_a_high_slope_is_a_way() -> None:
    """The box around the slope is 15 cm high; the slope itself is not, where it begins."""
    assert solvable(slope(9.0, 0.15, width=0.5), "position = [1.3, -0.34]", walls=0.7)


@pytest.mark.parametrize("rise", [0.008, 0.016])
@pytest.mark.parametrize("robot", ["qrio", "nao"])
def test_a_threshold_with_bevels_is_a_way_though_no_sole_finds_a_level_place(
    robot: str, rise: float
) -> None:
    body, length = load_robot(robot), rise / math.tan(math.radians(9.5))
    ramp = '[[course]]\nkind = "ramp"\nwidth = 1.1\nposition = [{}, 0.0]\n'
    ramp += "yaw = {}\nlength = {}\nrise = {}\n"
    course = f'[[course]]\nkind = "platform"\nposition = [1.0, 0.0]\nsize = [0.05, 1.1, {rise}]\n'
    course += ramp.format(0.975 - length, 0.0, length, rise)
    course += ramp.format(1.025 + length, 3.14159265, length, rise)
    made = scenario(WALLS.format(y=0.5) + course)
    assert is_solvable(made, build_course(made, body), body) is True


DOOR = """
[[course]]
kind = "door"
name = "door"
position = [1.0, 0.0]
width = 0.5
height = {height}
wall = [0.3, 0.3, 1.0]
open = {open}
"""
SET = '[[event]]\nat = 5.0\ndo = "set_door"\nname = "door"\nopen = {}\n'


@pytest.mark.parametrize(
    ("keys", "then", "way"),
    [
        ({}, None, True),
        ({"open": 0.0}, None, False),
        ({"open": 0.2}, None, False),
        ({"height": 0.5}, None, False),
        ({}, 0.0, False),
        ({"open": 0.0}, 1.0, True),
    ],
)
def test_a_door_is_a_way_as_its_last_event_leaves_it(
    keys: dict[str, float], then: float | None, way: bool
) -> None:
    event = "" if then is None else SET.format(then)
    course = DOOR.format(**{"height": 0.7, "open": 1.0, **keys})
    assert solvable(course + event) is way


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "way"),
    [
        ({}, True),
        ({"rise": 0.052}, True),
        ({"rise": 0.054}, False),
        ({"tread": 0.095}, True),
        ({"tread": 0.07}, False),
        ({"width": 0.26}, True),
        ({"width": 0.17}, False),
    ],
)
def test_stairs_are_a_way_within_the_limits_of_rise_tread_and_width(
    changes: dict[str, float], way: bool
) -> None:
    assert solvable(stairs(**changes), "position = [1.9, 0.0]") is way  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_drop_is_no_way_and_a_way_around_it_is() -> None:
    high = '[[course]]\nkind = "platform"\nposition = [0.0, 0.0]\nsize = [1.2, 0.96, 0.2]\n'
    assert not solvable(high)
    down = stairs(rise=0.05, steps=4).replace("[0.6, 0.0]", "[1.1, 0.0]\nyaw = 3.1415926")
    assert solvable(high + down.replace("landing = 1.5", "landing = 0.15"))


def test_a_point_to_pass_has_to_be_reached_too() -> None:
    made = "position = [2.0, 0.0]\nvia = [[1.0, {}]]\nradius = 0.1"
    assert solvable("", made.format(0.2))
    assert not solvable("", made.format(0.48))


def test_what_may_be_gone_keeps_nobody_from_a_way() -> None:
    closed = gap(0.1).replace("height", 'name = "door"\nheight')
    assert not solvable(closed)
    assert solvable(closed + '[[event]]\nat = 1.0\ndo = "remove"\nname = "door"\n')


def test_of_a_robot_that_is_carried_elsewhere_nothing_is_said() -> None:
    assert solvable('[[event]]\nat = 1.0\ndo = "kidnap"\nposition = [1.0, 0.0]\n') is None


@pytest.mark.parametrize(
    ("name", "way"),
    [
        ("slalom", True),
        ("boxed_in", False),
        ("basin", True),
        ("basin_narrow", False),
        ("stairs_spiral", True),
        ("slope_down", True),
        ("stairs_too_high", False),
        ("narrow_passage", True),
    ],
)
def test_the_scenarios_are_solvable_or_not_as_they_were_made(name: str, way: bool) -> None:
    made = load_scenario(name)
    robot = load_robot(made.robot)
    assert is_solvable(made, build_course(made, robot), robot) is way


@pytest.mark.slow
def test_most_random_courses_are_solvable_for_both_robots() -> None:
    for robot in (qrio(), load_robot("nao")):
        for name in ("random_flat", "random_stairs"):
            made = [load_scenario(name, seed=seed, robot=robot.name) for seed in range(6)]
            found = [is_solvable(one, build_course(one, robot), robot) for one in made]
            assert found.count(True) >= 5, (name, robot.name)


def test_the_limits_are_the_cores_own_where_a_robot_publishes_none() -> None:
    source = (ROOT / "rust" / "stairs" / "src" / "climbing" / "config.rs").read_text()
    up, _, rest = source.partition("fn descend() -> Self")
    down, _, defaults = rest.partition("pub struct ClimbingConfig")
    limits = limits_of(scenario(), qrio())

    def core(text: str, key: str) -> float:
        found = re.search(rf"\b{key}: (?:f64 = )?(-?[\d.]+)", text)
        assert found
        return float(found[1])

    assert limits.floor_max == core(defaults, "floor_max")
    assert limits.tolerance == core(defaults, "tolerance")
    assert limits.side_room == core(defaults, "side_room")
    assert limits.up.highest == core(up, "step_max_z")
    assert limits.down.highest == -core(down, "step_min_z")
    for one, text in ((limits.up, up), (limits.down, down)):
        assert one.front_x_limit == core(text, "front_x_limit")
        assert one.back_x_limit == core(text, "back_x_limit")


def test_a_robot_that_walks_sideways_needs_less_width() -> None:
    made, robot = load_scenario("narrow_passage"), load_robot("nao")
    assert limits_of(made, robot).radius == pytest.approx(0.115)
    assert limits_of(scenario(), robot).radius == robot.file.body.radius
    assert isinstance(limits_of(made, robot), Limits)


def test_the_ground_knows_surfaces_above_each_other_and_what_lies_on_them() -> None:
    made = scenario(
        '[[course]]\nkind = "platform"\nposition = [1.0, 0.0]\nsize = [0.6, 1.0, 0.03]\n'
        '[[course]]\nkind = "box"\nposition = [1.0, 0.3]\nsize = [0.2, 0.2, 0.4]\n'
    )
    ground = TrueGround(
        build_course(made, qrio()), [(0.0, 0.0)], radius=0.14, tall=0.58, steepest=0.175
    )
    row, column = ground.index(1.0, -0.1)
    assert ground.height[1, row, column] == pytest.approx(0.03)
    assert not ground.free[0, row, column]
    assert ground.free[1, row, column]
    assert not ground.free[:, ground.index(1.0, 0.3)[0], column].any()
    x, y = ground.centre(row, column)
    assert (x, y) == pytest.approx((1.0, -0.1), abs=ground.cell)
    assert [abs(normal).max() for _, _, normal in edges_of(ground.tops[0])] == [1.0] * 4


def test_over_stones_for_one_foot_or_slabs_it_cannot_tell_where_it_finds_no_way() -> None:
    """Its feet go side by side; where they find a way all the same, there is one."""
    for name in ("stepping_stones", "slabs"):
        for robot in (qrio(), load_robot("nao")):
            for seed in range(3):
                made = load_scenario(name, seed=seed)
                assert is_solvable(made, build_course(made, robot), robot) is not False
    stones = """
[[course]]
kind = "platform"
position = [0.9, 0.0]
size = [{size}, {size}, 0.09]
[[course]]
kind = "wall"
from = [1.2, -0.5]
to = [1.2, 0.5]
"""
    assert solvable(stones.format(size=0.18)) is None
    assert solvable(stones.format(size=0.3)) is False, "both feet have room on it"
    assert solvable(stones.format(size=0.09)) is False, "no sole has room on it"
    assert solvable(stones.format(size=0.18).partition('[[course]]\nkind = "wall"')[0]) is True
