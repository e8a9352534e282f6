"""The picture of what was known of each step."""

import math
from pathlib import Path

import pytest
from episode_builders import result, scenario

from treadwell.errors import RecordingError
from treadwell.experiments.stairs import STAIRS
from treadwell.experiments.stairs_pictures import draw_steps, stairs_pictures
from treadwell.measuring.step_watch import StepError
from treadwell.runner import Run

STEPS = (
    StepError(1.0, 0.03, 0.001, -0.004, 0.01),
    StepError(2.0, -0.03, -0.002, 0.006, 0.0),
    StepError(3.0, 0.03, math.nan, math.nan, math.nan),  # nobody knew of it
)


def test_the_steps_of_all_runs_make_one_picture(tmp_path: Path) -> None:
    run = Run(result(scenario()), tmp_path, steps=STEPS)
    (picture,) = STAIRS.pictures({"stairs_up": [run], "stairs_down": [run]}, tmp_path)
    assert picture.path.read_bytes().startswith(b"\x89PNG")
    assert picture.markdown().endswith("(steps.png)\n")


def test_where_no_step_was_known_nothing_is_drawn(tmp_path: Path) -> None:
    assert stairs_pictures({}, tmp_path) == []
    unknown = Run(result(scenario()), tmp_path, steps=STEPS[2:])
    assert stairs_pictures({"stairs_up": [unknown]}, tmp_path) == []
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"x\.png: cannot be written"):
        draw_steps(tmp_path / "no" / "x.png", STEPS[:1])
