"""Sweeps and comparisons from Python: as the commands, with tables, and shown in notebooks."""

import json
import subprocess
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from sweep_builders import short

import treadwell
from treadwell.cli.app import execute
from treadwell.comparing.compare import Comparison
from treadwell.errors import InputError
from treadwell.experiments.experiment import Table
from treadwell.sweeps.row import COLUMNS
from treadwell.sweeps.sweep import Sweep, chosen_engine

VARY = {"navigation.planner": ["a_star", "voronoi"]}
CLOCK = {"wall_seconds", "core_ms", "folder", "reproduced"}


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Sweep:
    place = tmp_path_factory.mktemp("python")
    return treadwell.sweep(
        Path(short(place)), episodes=1, vary=VARY, keep=0, workers=2, out=place / "out"
    )


@pytest.mark.slow
def test_a_sweep_is_the_same_as_the_commands(
    swept: Sweep, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = swept.document["lines"][0]["file"]
    asked = [scenario, "--episodes", "1", "--vary", "navigation.planner=a_star,voronoi"]
    assert swept.document["command"].split()[2:] == asked
    assert execute(["sweep", *asked, "--out", str(swept.folder), "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["summary"] == swept.document["summary"]
    assert not swept.passed
    again = treadwell.sweep(scenario, episodes=1, vary=VARY, out=str(swept.folder))
    assert again.document == swept.document


@pytest.mark.slow
def test_its_table_is_the_file(swept: Sweep) -> None:
    table = swept.table()
    assert tuple(table.column_names) == COLUMNS
    assert table.equals(pq.read_table(swept.folder / "episodes.parquet"))
    assert repr(swept) == f"<Sweep {swept.folder}: 0 of 2 episodes succeeded>"
    assert "<td>short qrio navigation.planner=voronoi</td>" in swept._repr_html_()


@pytest.mark.slow
def test_a_comparison_is_the_same_as_the_commands(
    swept: Sweep, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, figure = tmp_path / "c.md", tmp_path / "c.svg"
    found = treadwell.compare(swept, out=out, figure=str(figure))
    assert isinstance(found, Comparison)
    assert execute(["compare", str(swept.folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == found.document
    assert "## Comparison" in out.read_text()
    assert figure.read_bytes().startswith(b"<?xml")
    assert "(a) Share of successes" in found.draw(tmp_path / "d.pdf").caption
    table = found.table()
    assert table.num_rows == len(found.document["differences"])
    assert table.column("verdict").to_pylist()[0] == "too few pairs"
    assert table.column("p").null_count > 0
    figures = found.figures()
    assert figures.column("side").to_pylist()[0] == "navigation.planner=a_star"
    assert figures.column("high").to_pylist()[0] == pytest.approx(0.7935, abs=1e-4)
    assert repr(found).startswith("<Comparison of navigation.planner=a_star, navigation.planner=")
    assert found._repr_html_().count("<table>") >= 2


@pytest.mark.slow
def test_a_program_needs_no_guard_and_its_own_class_is_refused(tmp_path: Path) -> None:
    scenario = short(tmp_path)
    program = tmp_path / "program.py"
    program.write_text(
        "import treadwell\n"
        "print('once')\n"
        f"print(treadwell.sweep({scenario!r}, episodes=1, keep=0, out='out'))\n"
        "class Mine:\n    def plan(self, view, stairs, start, goal): ...\n"
        f"treadwell.sweep({scenario!r}, episodes=1, out='no', planner=Mine)\n"
    )
    done = subprocess.run(
        [sys.executable, str(program)], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.stdout.splitlines() == ["once", "<Sweep out: 0 of 1 episodes succeeded>"]
    assert "Mine is defined in the program that runs" in done.stderr.splitlines()[-1]
    assert not (tmp_path / "no").exists()


def test_what_is_shown_in_a_notebook_is_escaped() -> None:
    table = Table("<b>", ("a&", "b"), (("<script>", "{0}"),), ("x < y",))
    assert table.html() == (
        "<table><caption>&lt;b&gt;</caption><thead><tr><th>a&amp;</th><th>b</th></tr></thead>"
        "<tbody><tr><td>&lt;script&gt;</td><td>{0}</td></tr></tbody></table><p>x &lt; y</p>"
    )


def test_bad_arguments_are_refused_before_anything_is_written(tmp_path: Path) -> None:
    scenario, out = short(tmp_path), tmp_path / "out"
    for arguments, told in (
        ({}, "--episodes N is missing"),
        ({"episodes": 0}, "episodes: found 0; must be a whole number from 1 on"),
        ({"episodes": True}, "episodes: found true"),
        ({"episodes": 1, "workers": 0.5}, "workers: found 0.5"),
        ({"episodes": 1, "engine": "cloud"}, "engine: found .*must be one of local, ray"),
        ({"episodes": 1, "timeout": float("nan")}, "found nan"),
        ({"episodes": 1, "planner": "no_such:Planner"}, "navigation.planner: no_such:Planner"),
        ({"episodes": 1, "planner": "sweep_builders:Odd", "user_code": False}, "user's"),
    ):
        with pytest.raises(InputError, match=told):
            treadwell.sweep(scenario, out=out, **arguments)
    assert not out.exists()
    with pytest.raises(InputError, match="there is no scenario"):
        treadwell.sweep([], episodes=1, out=out)
    for sweeps, told in (((), "there is no sweep"), (([out],), "each by itself")):
        with pytest.raises(InputError, match=told):
            treadwell.compare(*sweeps)
    with pytest.raises(InputError, match="must end with"):
        treadwell.compare(out, figure="x.gif")
    assert callable(chosen_engine("local", 1))
