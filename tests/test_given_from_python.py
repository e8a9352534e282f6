"""What Python gives that the command line cannot: numpy's numbers, lists, wrong types; reprs."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import treadwell
from treadwell import mapping
from treadwell.errors import CoreError, InputError
from treadwell.protocols import Decision, Goal, Plan, Scan, Segmentation, Staircase

POINTS = np.random.default_rng(0).uniform(-1.0, 1.0, (40, 3))


def occupied(points: object) -> list[list[float]]:
    tree = mapping.Octree(0.1)
    tree.insert(points, (0.0, 0.0, 0.0))  # type: ignore[arg-type]
    centres, _ = tree.occupied()
    return sorted(centres.tolist())


@pytest.mark.parametrize(
    "points",
    [
        POINTS.astype(np.float32),
        POINTS.tolist(),
        np.asfortranarray(POINTS),
        np.repeat(POINTS, 2, axis=0)[::2],
    ],
)
def test_an_octree_takes_points_of_any_type_and_stride(points: object) -> None:
    assert occupied(points) == occupied(POINTS)


@pytest.mark.parametrize(
    ("points", "got"),
    [(POINTS[:, :2], "float64 (40, 2)"), ("abc", "str"), (None, "None"), ([1, 2, 3], "list")],
)
def test_what_are_no_points_is_told(points: object, got: str) -> None:
    tree = mapping.Octree(0.1)
    for call in (tree.occupy, tree.log_odds, lambda given: tree.cast_rays(given, POINTS)):
        with pytest.raises(InputError, match=re.escape(f"must be numbers (n, 3), got {got}")):
            call(points)  # type: ignore[operator]


def test_numbers_of_numpy_are_numbers() -> None:
    made = treadwell.Episode("open_floor", seed=np.int64(3))  # type: ignore[arg-type]
    assert made.scenario.seed == 3
    assert treadwell.Episode("open_floor", overrides=None).scenario.seed == 0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"out": 5}, "out: found 5; must be the path of a folder"),
        ({"record": "no"}, "record: found 'no'; must be True or False"),
        ({"view": "no"}, "view: found 'no'; must be True or False"),
        ({"user_code": "no"}, "user_code: found 'no'; must be True or False"),
        ({"planner": "a_start"}, r"planner: found 'a_start'; .* did you mean 'a_star'\?"),
        ({"planner": 3}, "planner: int has no method plan"),
    ],
)
def test_what_cannot_be_is_told_by_its_own_name(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        treadwell.run("open_floor", **given)


def test_a_whole_number_is_asked_for_in_words() -> None:
    with pytest.raises(InputError, match=r"cells: .*`90.0`, expected a whole number"):
        mapping.Map("fog", overrides={"fog.cells": 90.0})


def ended(**part: object) -> str:
    episode = treadwell.Episode("open_floor", **part)
    with pytest.raises(CoreError) as error:
        for _ in episode:
            pass
    return str(error.value)


@pytest.mark.parametrize("answer", [np.zeros((3, 2)), (1.0, 2.0), "ahead", 3, None])
def test_a_part_that_returns_something_else_is_told_what_it_must_return(answer: object) -> None:
    class Bare:
        def plan(self, *_: object) -> object:
            return answer

        def next(self, *_: object) -> object:
            return answer

    assert "plan() must return a Plan, got " in ended(planner=Bare())
    assert "next() must return a Decision, got " in ended(behaviour=Bare())


@pytest.mark.parametrize("outcome", ["finished", "goal reached", ": why", "two words: why"])
def test_an_outcome_is_the_goal_or_a_refusal_in_its_form(outcome: str) -> None:
    class Done:
        def next(self, *_: object) -> Decision:
            return Decision("done", outcome=outcome)

    assert "outcome must be None, goal_reached, or why it refuses" in ended(behaviour=Done())


@pytest.mark.parametrize(
    ("ground", "turn", "message"),
    [
        (7, 1.0, "ground must be one of the 1 regions that floor_heights has"),
        (0, 2.0, "pose must have a rotation in its first three rows"),
        (0, -1.0, "pose must have a rotation in its first three rows"),
    ],
)
def test_a_segmentation_that_cannot_be_is_told(ground: int, turn: float, message: str) -> None:
    class Odd:
        def segment(self, scan: Scan) -> Segmentation:
            pose = np.eye(4)
            pose[:3, :3] *= turn
            labels = np.zeros(scan.depth.size, np.uint16)
            return Segmentation(labels, [0.0], pose, ground, reliable=True)

    assert message in ended(segmenter=Odd())


def test_products_are_a_line_each_at_the_prompt() -> None:
    seen: list[object] = []

    class Watching:
        def begin(self, setup: object) -> None:
            seen.append(setup)

        def plan(self, view: object, stairs: object, _start: object, goal: object) -> Plan:
            seen.extend((view, stairs, goal))
            return Plan(np.zeros((500, 2)))

        def segment(self, scan: Scan) -> None:
            seen.append(scan)

    with pytest.raises(CoreError):
        for _ in treadwell.Episode("open_floor", planner=Watching(), segmenter=Watching()):
            pass
    view = mapping.floor_view(np.zeros((10, 12)), cell=0.1)
    way = mapping.plan(view, (0.2, 0.2, 0.0), (0.6, 0.6))
    seen += [Plan(np.zeros((500, 2))), Goal((1.0, 2.0), 0.15), Staircase(), view, way]
    for one in seen:
        assert len(repr(one)) < 250, repr(one)
        assert "\n" not in repr(one)
        assert " object at 0x" not in repr(one)
    assert repr(view) == "<FloorView of 10 x 12 cells of 0.1 m: 120 floor, 0 obstacle>"


def test_a_map_shows_its_picture_in_a_notebook() -> None:
    camera = mapping.Camera(width=64, height=48, fx=50.0, fy=50.0, cx=31.5, cy=23.5)
    world = mapping.Map("elevation", camera)
    assert world._repr_png_() is None
    down = np.diag([1.0, -1.0, -1.0, 1.0])
    down[2, 3] = 1.0
    world.insert(np.full((48, 64), 1.0), down)
    picture = world._repr_png_()
    assert picture is not None
    assert picture.startswith(b"\x89PNG")


def test_the_tab_key_offers_the_library() -> None:
    assert {"mapping", "costs", "protocols", "run"} <= set(dir(treadwell))
    assert treadwell.mapping is mapping


@pytest.mark.parametrize("file", ["mine_alone.py", "mine_alone/planners.py"])
def test_a_module_in_the_working_folder_is_pointed_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str
) -> None:
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).write_text("class Mine: ...\n")
    monkeypatch.chdir(tmp_path)
    named = f"{file.removesuffix('.py').replace('/', '.')}:Mine"
    message = r"^--set navigation.planner: .* mine_alone is here: with PYTHONPATH=\. it is found"
    with pytest.raises(InputError, match=message):
        treadwell.Episode("open_floor", overrides=[f"navigation.planner={named}"])
