"""The figure of a comparison: the same bytes every time, text as text, and what is not there said.

What it looks like nobody tests: look at it.
"""

import json
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import pytest
from defusedxml.ElementTree import parse
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from sweep_builders import row, short

from treadwell.cli.app import execute
from treadwell.comparing.comparison import Candidate, compared
from treadwell.comparing.figure import COLUMN_INCHES, PAGE_INCHES, draw_figure, shown_differences
from treadwell.comparing.figure_file import SUFFIXES, check_figure
from treadwell.comparing.panels import ALL
from treadwell.comparing.styles import MOST_STYLES, short_names, styles
from treadwell.comparing.ways import NO_WAYS, common_ways
from treadwell.errors import InputError, RecordingError
from treadwell.recording.scenario_file import write_scenario
from treadwell.scenario.loading import load_scenario
from treadwell.sweeps.request import SCHEMA

FAILED = {"outcome": "fell", "passed": False, "success": False, "falls": 1}
WAY = "0.0 0 0 0 0 0 0 1\n1.0 0.5 0.1 0 0 0 0 1\n2.0 0.9 0 0 0 0 0 1\n"


def two() -> list[Candidate]:
    fast = Candidate("fast", tuple(row(i) for i in range(8)))
    slow = tuple(replace(one, simulated_seconds=40.0 + 1.5 * one.seed) for one in fast.rows)
    return [fast, Candidate("slow", slow)]


def drawn(sides: list[Candidate], path: Path) -> bytes:
    draw_figure(path, sides, compared(sides))
    return path.read_bytes()


def texts(path: Path) -> set[str]:
    """What an SVG file shows as text."""
    return {
        "".join(node.itertext()).strip() for node in parse(path).iter() if node.tag.endswith("text")
    }


def inches(path: Path) -> tuple[float, float]:
    with Image.open(path) as picture:
        return picture.width / 300, picture.height / 300


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_figure_has_the_same_bytes_whatever_else_is_set(suffix: str, tmp_path: Path) -> None:
    first = drawn(two(), tmp_path / f"a{suffix}")
    with mpl.rc_context({"font.size": 30, "svg.fonttype": "path", "text.parse_math": True}):
        assert drawn(two(), tmp_path / f"b{suffix}") == first
        assert mpl.rcParams["font.size"] == 30
    begins = {".pdf": b"%PDF", ".svg": b"<?xml", ".png": b"\x89PNG"}
    assert first.startswith(begins[suffix])
    assert b"dc:date" not in first
    if suffix == ".pdf":
        assert b"/FontFile2" in first  # TrueType, embedded
        assert b"CreationDate" not in first


def test_names_are_text_and_never_markup_or_mathematics(tmp_path: Path) -> None:
    names = ["<b>&", "$x_{$ 設定", "navigation.planner=a, fog.cell=1"]
    sides = [replace(two()[0], name=name) for name in names]
    drawn(sides, tmp_path / "x.svg")
    shown = texts(tmp_path / "x.svg")
    assert {"A  <b>&", "B  $x_{$ 設定", "C  planner=a, cell=1", "8 of 8"} <= shown


def test_it_is_as_wide_as_a_column_or_as_a_page(tmp_path: Path) -> None:
    drawn(two(), tmp_path / "column.png")
    assert inches(tmp_path / "column.png")[0] == pytest.approx(COLUMN_INCHES, abs=0.01)
    both = [replace(one, rows=(*one.rows, row(0, scenario="doorway"))) for one in two()]
    drawn(both, tmp_path / "page.png")
    assert inches(tmp_path / "page.png")[0] == pytest.approx(PAGE_INCHES, abs=0.01)


def test_several_scenarios_are_rows_below_all_of_them(tmp_path: Path) -> None:
    names = [f"course_{k}" for k in range(12)]
    sides = [
        Candidate(side, tuple(row(s, scenario=n, **FAILED) for n in names for s in range(3)))
        for side in ("a", "b")
    ]
    drawn(sides, tmp_path / "x.svg")
    assert {ALL, *names, "success (%)", "B − A"} <= texts(tmp_path / "x.svg")


def test_more_sides_than_styles_are_rows_of_their_own(tmp_path: Path) -> None:
    sides = [
        Candidate(f"s{k}", tuple(row(i, scenario=n) for n in ("x", "y") for i in range(3)))
        for k in range(MOST_STYLES + 1)
    ]
    drawn(sides, tmp_path / "x.svg")
    shown = texts(tmp_path / "x.svg")
    assert {"I  s8", "6 of 6", "I − A"} <= shown
    assert ALL not in shown


def test_what_is_not_there_is_said(tmp_path: Path) -> None:
    path = tmp_path / "x.pdf"
    alone = [Candidate("a", (row(0),)), Candidate("b", (row(1),))]
    told = draw_figure(path, alone, compared(alone))
    assert "no pairs" in told.note
    assert NO_WAYS in told.note
    assert "(b)" not in told.caption
    single = two()[:1]
    assert draw_figure(path, single, compared(single)).note == NO_WAYS
    with pytest.raises(InputError, match="no episode"):
        draw_figure(path, [Candidate("a", ())], compared([Candidate("a", ())]))


def test_only_what_differs_is_drawn_of_differences_and_success() -> None:
    shown = shown_differences(compared(two()))
    assert [metric.name for metric in shown] == ["success", "time"]


def test_little_is_shown_in_thousandths(tmp_path: Path) -> None:
    errors = [0.001 * i for i in range(8)]
    near = [
        row(i, translation_error_mean=e, heading_error_mean=9 * e) for i, e in enumerate(errors)
    ]
    far = [replace(one, translation_error_mean=0.5, heading_error_mean=0.5) for one in near]
    drawn([Candidate("a", tuple(row(i, translation_error_mean=0.0) for i in range(8))),
           Candidate("b", tuple(near))], tmp_path / "near.svg")  # fmt: skip
    drawn([Candidate("a", tuple(near)), Candidate("b", tuple(far))], tmp_path / "far.svg")
    assert "place off (mm)" in texts(tmp_path / "near.svg")
    assert {"place off (m)", "heading off (rad)"} <= texts(tmp_path / "far.svg")


def test_eight_sides_differ_in_marker_and_in_line() -> None:
    chosen = styles([f"s{k}" for k in range(MOST_STYLES)])
    for looks in (
        [s.marker for s in chosen],
        [s.dashes for s in chosen],
        [s.letter for s in chosen],
    ):
        assert len(set(looks)) == MOST_STYLES


@given(st.lists(st.text("ab.=_, $", max_size=60), unique=True, max_size=6))
def test_names_that_differ_stay_different(names: list[str]) -> None:
    short = short_names(names)
    assert len(set(short)) == len(names)


@pytest.fixture
def recorded(tmp_path: Path) -> list[Candidate]:
    """Two sides: seed 0 was kept of the first, seed 1 of both; the second failed there."""
    sides = []
    for name, seeds, facts in (("a", (0, 1), {}), ("b", (1,), FAILED)):
        folder = tmp_path / name
        for seed in seeds:
            kept = folder / "episodes" / str(seed)
            kept.mkdir(parents=True)
            write_scenario(kept / "scenario.toml", load_scenario(short(tmp_path), seed=seed))
            (kept / "trajectory_truth.tum").write_text(WAY)
        rows = [row(s, **facts, folder=f"episodes/{s}" if s in seeds else None) for s in range(3)]
        sides.append(Candidate(name, tuple(rows), folder))
    return sides


def test_ways_are_of_the_seed_that_most_sides_have(
    recorded: list[Candidate], tmp_path: Path
) -> None:
    found = common_ways(recorded)
    assert found is not None
    assert (found.scenario, found.seed, sorted(found.ways), found.note) == ("slalom", 1, [0, 1], "")
    assert found.ways[0].places.tolist() == [[0.0, 0.0], [0.5, 0.1], [0.9, 0.0]]
    assert [found.ways[k].success for k in (0, 1)] == [True, False]
    assert found.sketch is not None
    assert found.sketch.goal[:2] == (1.0, 0.0)
    told = draw_figure(tmp_path / "x.svg", recorded, compared(recorded))
    assert "a cross ends a failure" in told.caption
    assert {"start", "goal", "(c) ways: slalom, seed 1"} <= texts(tmp_path / "x.svg")


def test_what_lacks_of_a_way_is_named_and_none_is_fetched_from_elsewhere(
    recorded: list[Candidate], tmp_path: Path
) -> None:
    third = Candidate("c", (row(1, folder="../a/episodes/1"),), tmp_path / "b")
    found = common_ways([*recorded, third])
    assert found is not None
    assert found.note == "no recording of slalom seed 1 by c"
    for side in ("a", "b"):
        (tmp_path / side / "episodes/1/scenario.toml").write_text("schema = 1\nname = 3\n")
    broken = common_ways(recorded)
    assert broken is not None
    assert broken.sketch is None
    assert "the course cannot be drawn" in broken.note
    draw_figure(tmp_path / "x.pdf", recorded, compared(recorded))
    (tmp_path / "b/episodes/1/trajectory_truth.tum").write_text("no\n")
    found = common_ways(recorded)
    assert found is not None
    assert "line 1: must be eight finite numbers" in found.note
    assert common_ways(two()) is None


def test_the_command_draws_and_refuses_what_it_cannot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [row(i, variant=v).document() for v in ("x=1", "x=2") for i in range(3)]
    lines = [{"variant": "x=1"}, {"variant": "x=2"}]
    document = {"schema": SCHEMA, "lines": lines, "episodes": rows}
    (tmp_path / "sweep").mkdir()
    (tmp_path / "sweep" / "results.json").write_text(json.dumps(document))
    asked, figure = ["compare", str(tmp_path / "sweep"), "--json", "--figure"], tmp_path / "f.PDF"
    figure.write_text("an older one")
    assert execute([*asked, str(figure)]) == 0
    shown = capsys.readouterr()
    assert json.loads(shown.out)["schema"] == "treadwell.comparison/1"
    assert figure.read_bytes().startswith(b"%PDF")
    assert f"figure: {figure} ({NO_WAYS})" in shown.err
    assert "caption: (a) Share of successes of 3 episodes" in shown.err
    for name, told in (
        ("f.jpg", "must end with .pdf, .svg, .png"),
        ("f", "must end with"),
        ("no/f.pdf", "there is no folder"),
    ):
        assert execute([*asked, str(tmp_path / name)]) == 2
        error = json.loads(capsys.readouterr().out)["error"]
        assert error.startswith("--figure: ")
        assert told in error
        with pytest.raises(InputError, match=told):
            check_figure(tmp_path / name)
    (tmp_path / "d.svg").mkdir()
    with pytest.raises(RecordingError, match=r"d\.svg: Is a directory"):
        draw_figure(tmp_path / "d.svg", two(), compared(two()))
