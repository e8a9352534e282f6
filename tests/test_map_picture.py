"""Claims about map.png: it is a picture of what is known, whatever that is."""

from pathlib import Path

import numpy as np
import pytest
from episode_builders import BOX, STEP, flight, grid, result, world
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from treadwell.footstep_plan import FootstepPlan, PlannedFootstep
from treadwell.judging.result import CollisionEntry
from treadwell.map_memory import FLOOR, OBSTACLE
from treadwell.poses import pose_matrix
from treadwell.recording.map_picture import caption_of, draw_map
from treadwell.recording.stair_memory import StairMemory
from treadwell.recording.step_memory import StepMemory
from treadwell.recording.trajectory import Trajectory
from treadwell.trace import Sole

LATER = """
[[event]]
at = 1.0
do = "add"
element = { kind = "box", position = [1.5, 0.5], yaw = 0.0, size = [0.2, 0.2, 0.4] }
"""


def way(offset: float) -> Trajectory:
    trajectory = Trajectory()
    for i in range(20):
        trajectory.add(80_000_000 * i, pose_matrix(0.1 * i, offset, 0.0, 0.0))
    return trajectory


def climbs() -> StairMemory:
    """Stairs ahead, of which the robot is on the way up in the second half of `way`."""
    memory = StairMemory()
    for i in range(20):
        memory.update(flight(), climbing=i > 9)
    return memory


def pixels(path: Path) -> np.ndarray:
    return imread(path)[..., :3]


def has(picture: np.ndarray, colour: tuple[float, float, float]) -> int:
    return int((np.abs(picture - np.array(colour)).max(axis=-1) < 0.03).sum())


def test_obstacles_floors_and_the_unknown_are_to_be_seen(tmp_path: Path) -> None:
    made = world(BOX + STEP + LATER)
    remembered = grid()
    remembered.kind[20:30, 10:60] = FLOOR
    remembered.height[20:30, 10:60] = np.linspace(0.0, 0.03, 50)
    remembered.kind[25, 20:25] = OBSTACLE
    told = result(made.scenario, outcome="refused", reason="too_narrow: a sentence", falls=1)
    draw_map(
        tmp_path / "map.png",
        made.course,
        caption_of(told),
        remembered,
        way(0.02),
        way(0.0),
        climbs(),
    )
    picture = pixels(tmp_path / "map.png")
    assert picture.shape[0] > 400
    assert picture.shape[1] > 600
    assert has(picture, (0.09, 0.09, 0.11)) > 100
    assert has(picture, (0.80, 0.80, 0.82)) > 10_000
    for colour in ("#7ff0ff", "#ffbe00", "#00b7ff", "#7d3cd7"):  # stairs, edges, climbed
        assert has(picture, to_rgb(colour)) > 50, colour


def test_soles_are_drawn_where_they_were_planned_and_where_they_came_down(tmp_path: Path) -> None:
    step = PlannedFootstep(
        "left", 0.5, 0.04, 0.3, 0.03, (0.0, 0.0), (-0.05, 0.05), 0.8, "careful", 1.2, 0.1, 0.0, 0.2
    )
    plan = FootstepPlan((step,), cost=1.5, whole_cost=4.0, expanded=7)
    memory = StepMemory()
    memory.plan(plan)
    soles = (Sole(0.9, 0.2, 0.03, (1.0, 0.0)), Sole(0.9, -0.2, 0.03, (1.0, 0.0)))
    for time, landed, left in ((1.0, 0, True), (1.5, 0, False), (2.0, 1, True)):
        touch = (left, True)
        memory.frame(plan, time, landed=landed, listed=True, soles=soles, touch=touch)
    memory.frame(plan, 2.5, landed=1, listed=False, soles=soles, touch=(True, True))
    assert (memory.landed, len(memory.planned), len(memory.taken)) == (1, 1, 1)
    (entry,) = memory.plans
    assert (entry.time, entry.steps, entry.careful_steps, entry.expanded) == (1.0, 1, 1, 7)
    assert (entry.careful, entry.walked, entry.unseen) == (1.2, 0.0, 2.5)
    made = world(STEP)
    draw_map(
        tmp_path / "map.png",
        made.course,
        caption_of(result(made.scenario)),
        grid(),
        way(0.0),
        way(0.0),
        climbs(),
        (memory, (0.105, 0.075)),
    )
    assert has(pixels(tmp_path / "map.png"), to_rgb("#ff8c00")) > 20


def test_no_line_joins_places_between_which_the_robot_cannot_have_walked(tmp_path: Path) -> None:
    made, found = world(), Trajectory()
    for i in range(40):  # it believes to walk along y = 0.5, and finds itself at y = -0.5
        place = (0.02 * i, 0.5) if i < 20 else (0.02 * (i - 20), -0.5)
        found.add(80_000_000 * i, pose_matrix(*place, 0.0, 0.0))

    def pink(stride: float) -> np.ndarray:
        draw_map(
            tmp_path / "map.png",
            made.course,
            caption_of(result(made.scenario)),
            grid(),
            found,
            found,
            StairMemory(),
            (StepMemory(), (stride, 0.075)),
        )
        picture = pixels(tmp_path / "map.png")
        rows = np.nonzero(np.abs(picture - np.array(to_rgb("#ff5fa2"))).max(axis=-1) < 0.03)[0]
        return np.unique(rows[rows < 0.8 * picture.shape[0]])  # not the legend's

    joined, broken = pink(10.0), pink(0.1)
    assert np.diff(joined).max() < 5
    assert np.diff(broken).max() > 100


def test_where_the_robot_knew_that_it_was_lost_no_believed_way_is_drawn(tmp_path: Path) -> None:
    made = world()

    def pink(*, lost: bool) -> int:
        memory = StairMemory()
        for i in range(20):
            memory.update((), climbing=False, lost=lost and i < 19)
        picture = tmp_path / "map.png"
        told = caption_of(result(made.scenario))
        draw_map(picture, made.course, told, grid(), way(0.1), way(-0.5), memory)
        return has(pixels(picture)[: int(0.8 * len(pixels(picture)))], to_rgb("#ff5fa2"))

    assert pink(lost=False) > 500
    assert pink(lost=True) == 0


@pytest.mark.parametrize("outcome", ["error", "interrupted"])
def test_an_episode_that_ended_at_once_has_a_picture(tmp_path: Path, outcome: str) -> None:
    made = world()
    hit = CollisionEntry(time=0.0, robot_part="head", element="box", impulse=1.0)
    told = result(made.scenario, outcome=outcome, collisions=[hit])
    empty = grid(rows=0, cols=0)
    draw_map(
        tmp_path / "map.png",
        made.course,
        caption_of(told),
        empty,
        Trajectory(),
        Trajectory(),
        StairMemory(),
    )
    assert pixels(tmp_path / "map.png").size > 0


def test_the_same_run_gives_the_same_picture(tmp_path: Path) -> None:
    made = world(STEP)
    for name in ("a.png", "b.png"):
        draw_map(
            tmp_path / name,
            made.course,
            caption_of(result(made.scenario)),
            grid(),
            way(0.0),
            way(0.0),
            climbs(),
        )
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
