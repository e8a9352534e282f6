"""Maps side by side."""

from pathlib import Path

import numpy as np
import pytest
from episode_builders import grid, result, scenario

from treadwell.errors import RecordingError
from treadwell.experiments import fog_cases as cases
from treadwell.experiments.fog_pictures import draw_panels, fog_pictures
from treadwell.map_memory import FLOOR, RememberedMap
from treadwell.runner import Run

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
    draw_panels(tmp_path / "x.png", [("a map", grid())] * count, BOUNDS)
    assert (tmp_path / "x.png").stat().st_size > 1000


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"x\.png: cannot be written"):
        draw_panels(tmp_path / "no" / "x.png", [("a map", grid())], BOUNDS)
