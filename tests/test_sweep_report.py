"""The page on a sweep: counts by line, failures with reasons and commands, and where they were."""

import json
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
from run_folders import plain_run
from test_reporting import HOSTILE, Page

from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.reporting import course_plan
from treadwell.reporting.report import report
from treadwell.reporting.sweep_data import EpisodeRow, is_sweep, read_sweep
from treadwell.reporting.sweep_section import sweep_section


def row(seed: int, **changes: Any) -> dict[str, Any]:  # noqa: ANN401
    return {
        "scenario": "slalom", "robot": "qrio", "variant": "", "seed": seed,
        "outcome": "goal_reached", "reason": None, "passed": True,
        "end_position": [2.0, 0.1, 0.0], "simulated_seconds": 20.0 + seed, "folder": None,
    } | changes  # fmt: skip


def fell(seed: int, **changes: Any) -> dict[str, Any]:  # noqa: ANN401
    facts = {"outcome": "fell", "reason": "fell: over a box", "passed": False}
    return row(seed, **facts | {"end_position": [0.5, 0.2]} | changes)


def sweep(folder: Path, rows: Any, asked: Any = None) -> Path:  # noqa: ANN401
    folder.mkdir(exist_ok=True)
    (folder / "results.json").write_text(json.dumps({"episodes": rows}))
    (folder / "sweep.json").write_text(json.dumps(asked or {}))
    return folder


def test_lines_are_counted_and_failures_listed_with_their_reasons(tmp_path: Path) -> None:
    rows = [row(0), fell(1), row(2), fell(3, variant="navigation.planner=voronoi")]
    asked = {
        "lines": [
            {"scenario": "slalom", "robot": "qrio", "variant": "", "settings": []},
            {
                "scenario": "slalom", "robot": "qrio", "variant": "navigation.planner=voronoi",
                "settings": ["navigation.planner=voronoi"],
            },
        ]
    }  # fmt: skip
    folder = sweep(tmp_path / "sweep", rows, asked)
    found = Page(report([folder]).read_text())
    assert found.texts[1] == "Sweep sweep" or "Sweep sweep" in found.texts
    assert any("2 of 4 episodes succeeded" in text for text in found.texts)
    assert "2\u202fof\u202f3" in found.texts
    assert found.texts.count("fell: over a box") == 2
    commands = [shlex.split(text) for text in found.texts if text.startswith("treadwell run")]
    plain = ["treadwell", "run", "slalom", "--robot", "qrio", "--seed"]
    assert commands[0] == [*plain, "1"]
    assert commands[1] == [*plain, "3", "--set", "navigation.planner=voronoi"]


def test_ends_are_drawn_on_the_course(tmp_path: Path) -> None:
    data = read_sweep(
        sweep(tmp_path / "sweep", [fell(s, end_position=[0.1 * s, 0.0]) for s in range(5)])
    )
    plan = course_plan.course_plan(data.rows)
    assert plan.count('class="end') == 5
    assert plan.count('class="course"') >= 3
    assert plan.count('class="goal"') == 1
    assert "course of seed 0" in plan
    strange = [fell(0, scenario="gone", end_x=1.0, end_y=2.0, end_position=None)]
    plan = course_plan.course_plan(read_sweep(sweep(tmp_path / "sweep", strange)).rows)
    assert plan.count('class="end') == 1
    assert "not known here" in plan


def test_a_refusal_that_is_justified_is_no_failure(tmp_path: Path) -> None:
    rows = [fell(0, outcome="refused", passed=False, success=True), fell(1)]
    section = sweep_section(read_sweep(sweep(tmp_path / "s", rows)), "sweep-1", tmp_path / "r.html")
    assert section.successes == 1
    assert [failure.seed for failure in section.failures] == ["1"]


@pytest.mark.slow
def test_a_kept_run_is_linked_and_nothing_outside_the_folder(tmp_path: Path) -> None:
    folder = sweep(
        tmp_path / "sweep", [fell(0, folder="kept"), fell(1, folder="../plain"), fell(2)]
    )
    shutil.copytree(plain_run(), folder / "kept")
    shutil.copytree(plain_run(), tmp_path / "plain")
    found = Page(report([folder]).read_text())
    assert [each for each in found.addresses() if not each.startswith("data:")] == ["kept/"]
    report([folder / "kept"])
    found = Page(report([folder]).read_text())
    assert "kept/report.html" in found.addresses()


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [{}],
        [{"seed": None, "end_position": "x", "passed": "yes", "simulated_seconds": 10**400}],
        [{"scenario": 3, "variant": {"a": 1}, "end_position": [1e300, float("nan")]}],
        [{"end_x": 1e300, "end_y": 0.0, "folder": "\x00"}],
    ],
)
def test_keys_may_be_absent_or_strange(tmp_path: Path, rows: list[dict[str, Any]]) -> None:
    assert "episodes succeeded" in report([sweep(tmp_path / "sweep", rows)]).read_text()


def test_a_sweep_that_has_only_begun_says_so(tmp_path: Path) -> None:
    (tmp_path / "sweep.json").write_text("{}")
    assert is_sweep(tmp_path)
    found = Page(report([tmp_path]).read_text())
    assert found.where("results.json is missing") < found.where("no episode is done yet")


def test_what_was_done_before_a_sweep_was_stopped_is_shown(tmp_path: Path) -> None:
    asked = {"lines": [{"scenario": "slalom", "robot": "qrio", "variant": "", "seeds": [0, 1, 2]}]}
    folder = sweep(tmp_path / "sweep", [row(0)], asked)
    (folder / "journal.jsonl").write_text(f"{json.dumps(row(0))}\n{json.dumps(row(1))}\n{{")
    found = Page(report([folder]).read_text())
    assert any("2 of 2 episodes succeeded" in text for text in found.texts)
    assert any("2 of 3 episodes are done" in text for text in found.texts)


def test_the_command_has_the_file_and_the_robot_as_they_were_given(tmp_path: Path) -> None:
    line = {"scenario": "slalom", "robot": "mine", "variant": "", "settings": [], "seeds": [1]}
    given = {"file": "/home/me/slalom.toml", "robot_given": "../mine"}
    folder = sweep(tmp_path / "a", [fell(1, robot="mine")], {"lines": [line | given]})
    section = sweep_section(read_sweep(folder), "a", tmp_path / "r.html")
    wanted = "treadwell run /home/me/slalom.toml --robot ../mine --seed 1"
    assert section.failures[0].command == wanted
    given = {"file": "slalom", "robot_given": None}
    folder = sweep(tmp_path / "b", [fell(1, robot="mine")], {"lines": [line | given]})
    section = sweep_section(read_sweep(folder), "b", tmp_path / "r.html")
    assert section.failures[0].command == "treadwell run slalom --seed 1"


def test_the_median_time_is_the_median(tmp_path: Path) -> None:
    data = read_sweep(sweep(tmp_path / "s", [row(0), row(10)]))
    lines = sweep_section(data, "s", tmp_path / "r.html").lines
    assert lines.rows[0][lines.columns.index("median time (s)")] == "25.0"


@pytest.mark.parametrize("content", ["", "{", '{"episodes": 3}', "[1, 2]", "\udcff", "[" * 100_000])
def test_garbage_is_bad_input(tmp_path: Path, content: str) -> None:
    (tmp_path / "results.json").write_bytes(content.encode("utf-8", "surrogateescape"))
    with pytest.raises(InputError, match=r"results\.json"):
        read_sweep(tmp_path)
    assert execute(["report", str(tmp_path)]) == 2


def test_what_others_wrote_stays_text(tmp_path: Path) -> None:
    rows = [
        fell(
            0,
            scenario=HOSTILE,
            robot=HOSTILE,
            variant=HOSTILE,
            outcome=HOSTILE,
            reason="\ud800" + HOSTILE,
        )
    ]
    found = Page(report([sweep(tmp_path / "sweep", rows)]).read_text())
    assert not [tag for tag, _ in found.tags if tag in ("script", "img")]
    assert any(HOSTILE in text for text in found.texts)


@pytest.mark.slow
def test_a_sweep_and_a_run_share_a_page(tmp_path: Path) -> None:
    folder = sweep(tmp_path / "sweep", [row(0)])
    text = report([folder, plain_run()], tmp_path / "all.html").read_text()
    assert "1 run and 1 sweep" in text
    assert 'id="sweep-1"' in text
    assert 'id="run-2"' in text


def test_a_row_knows_its_line() -> None:
    made = EpisodeRow("a", "b", "c", "1", "fell", "", False, None, None, (), None, None)
    assert made.line == ("a", "b", "c")


@pytest.mark.slow
def test_a_finished_sweep_shows_its_variants_side_by_side_and_how_to_repeat_it(
    tmp_path: Path,
) -> None:
    folder = tmp_path / "planners"
    vary = "navigation.planner=a_star,voronoi"
    words = ["sweep", "open_floor", "--episodes", "1", "--set", "time_limit=0.3", "--vary", vary]
    assert execute([*words, "--keep", "1", "--workers", "1", "--out", str(folder)]) == 1
    found = Page(report([folder]).read_text())
    assert "Comparison" in found.texts
    assert "Against navigation.planner=a_star" in found.texts
    again = next(text for text in found.texts if text.startswith("treadwell sweep"))
    assert shlex.split(again) == ["treadwell", *words]
