"""Claims about the table at the end of `robot check --walk`."""

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from robot_builders import qrio_copy

from treadwell.cli.app import execute
from treadwell.robot.load import load_robot
from treadwell.trials.stairs import STEPS, Climber, elements, levels
from treadwell.trials.table import Row, table
from treadwell.trials.world import Size, World


@pytest.fixture(scope="module")
def size() -> Size:
    return Size.of(load_robot("qrio"))


def test_the_size_is_the_robots(size: Size) -> None:
    assert size.scale == 1.0
    assert size.mass_kg == pytest.approx(7.0)
    assert size.stance_m == pytest.approx(0.085, abs=1e-3)
    assert size.sole_m == pytest.approx(0.105)


@pytest.mark.parametrize("rise", [0.03, -0.03])
def test_steps_begin_where_the_toes_are_and_are_as_high_as_asked(size: Size, rise: float) -> None:
    found = levels(size, rise)
    assert len(found) == STEPS + 1
    assert found[0].back > 0.5 * size.sole_m
    heights = [after.height - before.height for before, after in itertools.pairwise(found)]
    assert heights == pytest.approx([rise] * STEPS)
    assert min(level.height for level in found) == pytest.approx(0.0)
    assert all(level.front == before.back for before, level in itertools.pairwise(found))
    assert len(elements(found, size.scale)) == STEPS
    assert Climber(found, size).count >= STEPS


def test_a_robot_that_stands_has_not_fallen_and_one_that_is_thrown_over_has() -> None:
    world = World(load_robot("qrio"), [], 0)
    for _ in range(20):
        world.tick(None)
    assert world.fall() is None
    for _ in range(200):
        world.tick(None, (200.0, 0.0))
        if world.fall():
            break
    assert world.fall() is not None


def test_a_row_is_plain_data() -> None:
    row = Row("turns", "none", passed=False, why="falls")
    assert row.plain() == {"task": "turns", "result": "none", "passed": False, "why": "falls"}


@pytest.mark.slow
def test_walk_ends_with_a_table_of_what_qrio_does_and_why_it_does_no_more(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[dict[str, Any]] = []

    def kept(folder: Path, tell: Callable[[str], None]) -> list[dict[str, Any]]:
        made.extend(table(folder, tell))
        return made

    monkeypatch.setattr("treadwell.trials.table.table", kept)
    assert execute(["robot", "check", str(qrio_copy(tmp_path)), "--walk"]) == 0
    captured = capsys.readouterr()
    rows = {row["task"]: row for row in made}
    said = [line.removesuffix(" ...") for line in captured.err.splitlines()]
    assert [line for line in said if line in rows] == list(rows)
    assert "why no more" in captured.out
    for task, row in rows.items():
        assert task in captured.out
        assert row["result"] in captured.out
    for task in ("walks ahead", "walks back", "walks sideways", "turns", "stops"):
        assert rows[task]["passed"], rows[task]
        assert rows[task]["result"].startswith("3 of 3")
    assert float(rows["is pushed as it walks"]["result"].split()[0]) >= 1.0
    # Published: steps of 50 mm.
    assert float(rows["steps up"]["result"].split()[0]) >= 50.0
    assert "mm: " in rows["steps up"]["why"]
    assert json.loads(json.dumps(rows)) == rows
