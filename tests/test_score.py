"""Claims about the score: cells and surfaces against the truth, errors of the estimate."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from episode_builders import BOX, STEP, grid, qrio, world

from treadwell.course.build import build_course
from treadwell.map_memory import FLOOR, OBSTACLE, RememberedMap
from treadwell.measuring.measures import PoseErrors, timing
from treadwell.measuring.score import map_counts, surfaces, true_cells
from treadwell.poses import pose_matrix
from treadwell.scenario.loading import load_scenario

CURTAIN = """
[[course]]
kind = "box"
name = "curtain"
position = [0.5, 0.0]
size = [0.2, 0.6, 0.3]
base = BASE
"""


def perfect(course: str) -> tuple[RememberedMap, object, object]:
    made = world(course)
    remembered = grid()
    truth = true_cells(made.course, remembered, 0.58)
    remembered.kind[:] = np.where(truth.obstacle, OBSTACLE, FLOOR)
    remembered.height[:] = truth.height
    remembered.sightings[:] = 5
    return remembered, made.course, truth


def test_a_perfect_map_is_all_right() -> None:
    remembered, _, truth = perfect(BOX + STEP)
    counts = map_counts(remembered, truth)
    assert counts.floor_cells_right == 1.0
    assert counts.obstacle_cells_right == 1.0
    assert counts.floor_called_obstacle == counts.obstacle_called_floor == 0.0
    assert counts.obstacle_cells == 25
    assert counts.floor_cells > 3000


def test_wrong_cells_are_counted_as_what_they_are_called() -> None:
    remembered, _, truth = perfect(BOX)
    row, col = np.argwhere(truth.obstacle)[0]
    remembered.kind[row, col] = FLOOR
    remembered.kind[0, 0] = OBSTACLE
    remembered.height[0, 1] = 0.1
    counts = map_counts(remembered, truth)
    assert counts.obstacle_called_floor == pytest.approx(1 / 25)
    assert counts.floor_called_obstacle == pytest.approx(1 / counts.floor_cells)
    assert counts.floor_cells_right == pytest.approx(1 - 2 / counts.floor_cells)


def test_a_cell_that_lies_in_an_obstacle_with_its_centre_alone_is_no_whole_one() -> None:
    remembered, _, truth = perfect(BOX)
    border = truth.obstacle & ~truth.whole
    assert 0 < truth.whole.sum() < truth.obstacle.sum()
    remembered.kind[border] = FLOOR
    counts = map_counts(remembered, truth)
    assert counts.obstacle_called_floor == pytest.approx(border.sum() / truth.obstacle.sum())
    assert counts.whole_obstacle_cells == truth.whole.sum()
    assert counts.whole_obstacle_called_floor == 0.0
    remembered.kind[truth.whole] = FLOOR
    assert map_counts(remembered, truth).whole_obstacle_called_floor == 1.0


def test_a_floor_at_the_height_of_a_boxes_lid_is_right_and_at_any_other_is_not() -> None:
    remembered, _, truth = perfect(BOX)
    remembered.kind[truth.obstacle] = FLOOR
    for height, wrong in ((0.3, 0.0), (0.31, 0.0), (0.28, 1.0), (0.0, 1.0)):
        remembered.height[truth.obstacle] = height
        counts = map_counts(remembered, truth)
        assert counts.obstacle_called_floor == wrong
        assert counts.obstacle_cells_right == 1.0 - wrong


DECK = """
<mujoco><worldbody>
<geom name="deck" type="box" pos="0.5 0 0.7" size="0.3 0.3 0.02"/>
</worldbody></mujoco>
"""


def test_below_a_deck_the_road_is_right_and_so_is_the_deck_itself(tmp_path: Path) -> None:
    """Of levels above each other the map has the one that the robot is on."""
    (tmp_path / "deck.xml").write_text(DECK)
    file = tmp_path / "bridge.toml"
    file.write_text(
        'schema = 1\nname = "bridge"\n[start]\nposition = [-1.0, 0.0]\n[goal]\n'
        '[[course]]\nkind = "mjcf"\nname = "bridge"\nfile = "deck.xml"\n'
    )
    course = build_course(load_scenario(file), qrio())
    remembered = grid()
    remembered.kind[:] = FLOOR
    remembered.sightings[:] = 5
    for height, estimate in ((0.0, None), (0.72, 0.72), (0.36, None)):
        remembered.height[:] = 0.0
        over = true_cells(course, grid(), 0.58).height > 0.5
        remembered.height[over] = height
        right = map_counts(remembered, true_cells(course, remembered, 0.58))
        assert (right.floor_cells_right == 1.0) == (height != 0.36)
        found = surfaces(course, remembered, np.array([[0.5, 0.0]]))
        if height != 0.36:
            assert found[0].estimate == (None if estimate is None else pytest.approx(estimate))


def test_rubble_has_no_lid() -> None:
    rubble = (
        '[[course]]\nkind = "rubble"\nposition = [0.5, 0.0]\nsize = [0.3, 0.3]\namplitude = 0.1'
    )
    remembered, _, truth = perfect(rubble)
    remembered.kind[truth.obstacle] = FLOOR
    for height in (0.02, 0.05, 0.1):
        remembered.height[truth.obstacle] = height
        assert map_counts(remembered, truth).obstacle_called_floor == 1.0


def test_what_was_seen_twice_only_does_not_count() -> None:
    remembered, _, truth = perfect(BOX)
    remembered.sightings[:] = 2
    assert map_counts(remembered, truth).floor_cells == 0


def test_cells_on_an_edge_are_neither_floor_nor_obstacle() -> None:
    made = world(BOX)
    truth = true_cells(made.course, grid(), 0.58)
    assert not (truth.floor & truth.obstacle).any()
    assert (~truth.floor & ~truth.obstacle).any()


@pytest.mark.parametrize(("base", "obstacle"), [(0.3, True), (0.57, True), (0.6, False)])
def test_what_hangs_is_an_obstacle_where_the_robot_would_hit_it(
    base: float, obstacle: bool
) -> None:
    made = world(CURTAIN.replace("BASE", str(base)))
    truth = true_cells(made.course, grid(), 0.58)
    assert bool(truth.obstacle.any()) is obstacle


def test_an_element_counts_where_it_is_now() -> None:
    made = world(BOX)
    truth = true_cells(made.course, grid(), 0.58, {"box": np.array([0.4, 0.2, 0.0])})
    centre = grid().centres()[truth.obstacle].mean(axis=0)
    assert centre == pytest.approx([0.9, 0.2], abs=0.03)
    assert not true_cells(made.course, grid(), 0.58, {}).obstacle.any()


def test_a_surface_has_the_mean_of_its_interior_cells() -> None:
    remembered, course, _ = perfect(STEP)
    remembered.height[remembered.height > 0.02] += 0.002
    (entry,) = surfaces(course, remembered, np.zeros((0, 2)))
    assert (entry.element, entry.part) == ("step", "top")
    assert entry.truth == pytest.approx(0.03)
    assert entry.estimate == pytest.approx(0.032, abs=1e-6)
    assert 14 * 23 <= entry.cells <= 15 * 25


def test_a_top_without_cells_is_listed_only_where_the_robot_passed() -> None:
    remembered, course, _ = perfect(STEP)
    blind = replace(remembered, kind=np.zeros_like(remembered.kind))
    assert surfaces(course, blind, np.array([[0.0, 0.0]])) == []
    (entry,) = surfaces(course, blind, np.array([[0.0, 0.0], [1.0, 0.1]]))
    assert entry.estimate is None
    assert entry.cells == 0


STAIRS = """
[[course]]
kind = "stairs"
name = "stairs"
position = [0.61, 0.0]
descent = true
"""
SILL = """
[[course]]
kind = "sill"
name = "sill"
position = [0.61, 0.0]
"""
SLAB = """
[[course]]
kind = "platform"
name = "slab"
position = [0.79, 0.0]
size = [0.12, 0.33, 0.068]
"""


def test_every_step_of_a_staircase_is_listed_with_its_height() -> None:
    remembered, course, _ = perfect(STAIRS)
    entries = surfaces(course, remembered, np.zeros((0, 2)))
    heights = [0.03, 0.06, 0.09, 0.12, 0.09, 0.06, 0.03]
    assert [entry.truth for entry in entries] == pytest.approx(heights)
    # Cells that reach over an edge would show the mean of two steps.
    assert [entry.estimate for entry in entries] == pytest.approx(heights, abs=1e-6)
    assert all(entry.cells >= 12 for entry in entries)


@pytest.mark.parametrize("x", np.arange(0.6, 0.64, 0.005))
def test_a_sill_less_deep_than_a_sole_has_cells_wherever_it_lies(x: float) -> None:
    remembered, course, _ = perfect(SILL.replace("0.61", f"{x:.3f}"))
    (entry,) = surfaces(course, remembered, np.zeros((0, 2)))
    assert entry.cells >= 20
    assert entry.estimate == pytest.approx(0.038, abs=1e-6)


def test_a_step_under_a_slab_counts_no_more_but_the_slab_does() -> None:
    remembered, course, _ = perfect(STAIRS + SLAB)
    entries = surfaces(course, remembered, np.array([[0.79, 0.0]]))
    assert len(entries) == 7
    assert ("stairs", "step 2") not in {(entry.element, entry.part) for entry in entries}
    assert entries[-1].element == "slab"
    assert entries[-1].estimate == pytest.approx(0.068, abs=1e-6)


def test_pose_errors_are_distances_and_angles() -> None:
    errors = PoseErrors()
    assert errors.errors() is None
    truth = pose_matrix(1.0, 2.0, 0.0, 3.1)
    errors.add(pose_matrix(1.03, 2.04, 0.0, -3.1), pose_matrix(1.1, 2.0, 0.0, 3.1), truth)
    errors.add(truth, truth, truth)
    found = errors.errors()
    assert found is not None
    assert found.translation_error.mean == pytest.approx(0.025)
    assert found.translation_error.max == pytest.approx(0.05)
    assert found.heading_error.max == pytest.approx(2 * np.pi - 6.2)
    assert found.odometry_translation_error.max == pytest.approx(0.1)


def test_errors_of_level_poses_are_those_of_their_matrices() -> None:
    flat, general = PoseErrors(), PoseErrors()
    rng = np.random.default_rng(0)
    for _ in range(100):
        believed, counted, true = ((*row,) for row in rng.uniform(-4.0, 4.0, (3, 4)).tolist())
        flat.add_level(believed, counted, true)
        general.add(pose_matrix(*believed), pose_matrix(*counted), pose_matrix(*true))
    assert flat.errors() == general.errors()


def test_stages_that_did_not_run_have_no_time() -> None:
    assert timing([]).count == 0
    table = timing([0.001, float("nan"), 0.003])
    assert (table.count, table.median, table.max) == (2, pytest.approx(2.0), pytest.approx(3.0))
