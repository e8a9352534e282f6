"""Maps side by side."""

from pathlib import Path

import numpy as np
import pytest
from episode_builders import BOX, grid, result, scenario, world
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from treadwell.errors import RecordingError
from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog_pictures import Panel, draw_panels, fog_pictures, true_outlines
from treadwell.map_memory import FLOOR, RememberedMap
from treadwell.runner import Run

RUBBLE = """
[[course]]
kind = "rubble"
position = [0.5, 0.3]
yaw = 0.3
size = [0.3, 0.2]
amplitude = 0.04
"""
TRUTH = np.array(to_rgb("#e4572e"))
BOUNDS = (0.0, 1.0, -0.5, 0.5)


def seen() -> RememberedMap:
    made = grid()
    made.kind[20:40, 20:40] = FLOOR
    made.height[20:40, 20:40] = np.linspace(0.0, 0.06, 20)
    return made


def test_every_case_that_was_run_is_drawn_once_with_all_its_models(tmp_path: Path) -> None:
    run = Run(result(scenario()), tmp_path, remembered=seen())
    results = {cases.course(model): [run, run] for model in cases.WORLD_MODELS}
    pictures = fog_pictures(results, tmp_path)
    assert [one.path.name for one in pictures] == ["course.png"]
    assert pictures[0].path.read_bytes().startswith(b"\x89PNG")
    assert pictures[0].markdown().endswith("(course.png)\n")


def test_of_what_was_not_run_there_is_no_picture(tmp_path: Path) -> None:
    assert fog_pictures({}, tmp_path) == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("count", [1, 2, 3])
def test_panels_are_drawn_also_of_a_map_that_knows_nothing(tmp_path: Path, count: int) -> None:
    draw_panels(tmp_path / "x.png", [Panel("a map", grid())] * count, BOUNDS)
    assert (tmp_path / "x.png").stat().st_size > 1000


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"x\.png: cannot be written"):
        draw_panels(tmp_path / "no" / "x.png", [Panel("a map", grid())], BOUNDS)


def test_axes_have_units_and_the_truth_is_drawn(tmp_path: Path) -> None:
    box = np.array([[0.2, -0.2], [0.6, -0.2], [0.6, 0.2], [0.2, 0.2]])
    for name, outlines in (("with", [box]), ("without", [])):
        draw_panels(tmp_path / f"{name}.png", [Panel("a map", grid(), outlines)], BOUNDS)
    orange = [
        int((np.abs(imread(tmp_path / f"{name}.png")[..., :3] - TRUTH).max(axis=-1) < 0.03).sum())
        for name in ("with", "without")
    ]
    assert orange[0] > 500
    assert orange[1] == 0


def test_the_outlines_of_a_run_are_those_of_its_course() -> None:
    made = world(BOX)
    (outline,) = true_outlines(result(made.scenario))
    assert np.allclose(outline, made.course.elements[0].pieces[0].outline)


def test_rubble_has_one_outline_around_all_its_stones() -> None:
    made = world(RUBBLE)
    assert len(made.course.elements[0].pieces) > 10
    (outline,) = true_outlines(result(made.scenario))
    every = np.vstack([piece.outline for piece in made.course.elements[0].pieces])
    assert np.allclose([outline.min(axis=0), outline.max(axis=0)], [every.min(0), every.max(0)])
