"""The pages of docs/results: made from their JSON, and what measuring commands write into it."""

import argparse
import json
import re
from pathlib import Path
from typing import Any

import into_results
import pytest
from documents import rows_of
from pages import FOLDER, Subject, load, markdown, subjects
from results import LONGEST_PAGE, index, main, record, wrong_pages

from treadwell.experiments.catalogue import EXPERIMENTS

ROOT = Path(__file__).resolve().parent.parent


def table(title: str = "Falls", **changed: Any) -> dict[str, Any]:  # noqa: ANN401
    made = {
        "title": title,
        "command": "make falls",
        "commit": "0123abc",
        "date": "2026-11-20",
        "seeds": "0-9",
        "rows": [{"what": "`turn`", "measured": "1 of 10", "wanted": "0"}],
    }
    return made | changed


def subject(folder: Path, *tables: dict[str, Any]) -> Path:
    page = {"schema": "treadwell.results/1", "subject": "walks", "title": "Walks", "about": "Legs."}
    path = folder / "walks.json"
    path.write_text(json.dumps(page | {"tables": list(tables)}))
    return path


@pytest.mark.parametrize("name", subjects())
def test_a_page_is_what_its_json_says_and_short(name: str) -> None:
    made = markdown(load(name))
    assert (FOLDER / f"{name}.md").read_text() == made
    assert len(made.splitlines()) <= LONGEST_PAGE


@pytest.mark.parametrize("name", subjects())
def test_every_row_has_command_and_commit_or_a_reason_why_not(name: str) -> None:
    for one in load(name).tables:
        for row in one.rows:
            command, commit = row.command or one.command, row.commit or one.commit
            assert (command and commit) or one.missing, (one.title, row.what)


def test_the_index_links_every_page_and_the_readme_the_index() -> None:
    text = (FOLDER / "README.md").read_text()
    assert text == index()
    assert set(re.findall(r"\| \[[^\]]+\]\((\w+)\.md\)", text)) == set(subjects())
    assert "(docs/results/README.md)" in (ROOT / "README.md").read_text()
    assert wrong_pages() == []


def test_no_two_subjects_tell_the_same_figure_of_the_same_thing() -> None:
    said = [
        (row.what, json.dumps(row.measured), one.command)
        for name in subjects()
        for one in load(name).tables
        for row in one.rows
    ]
    assert len(said) == len(set(said))


def test_the_tests_and_scenarios_that_the_papers_tests_name_exist() -> None:
    page = load("papers_tests")
    cells = [
        row.measured["where it is tested"]
        for one in page.tables
        for row in one.rows
        if isinstance(row.measured, dict)
    ]
    assert len(cells) == 55
    named = {name for cell in cells for name in re.findall(r"`([a-z_0-9]+)`", cell)}
    sources = [*(ROOT / "rust").rglob("*.rs"), *(ROOT / "tests").glob("*.py")]
    code = "\n".join(path.read_text() for path in sources)
    tests = set(re.findall(r"\b(?:fn|def) (\w+)", code))
    scenarios = {path.stem for path in (ROOT / "scenarios").glob("*.toml")}
    cases = {case.name for made in EXPERIMENTS.values() for case in made.cases}
    assert named <= tests | scenarios | cases, named - tests - scenarios - cases


def test_a_table_replaces_the_one_of_its_title_and_keeps_what_was_wanted(tmp_path: Path) -> None:
    path = subject(tmp_path, table("Pushes"), table(note="Old."), table("Turns"))
    rows = [{"what": "`turn`", "measured": "0 of 20"}, {"what": "`side`", "measured": "0 of 20"}]
    record("walks", "Falls", "make falls", "20-39", rows, commit="7654321", folder=tmp_path)
    tables = {one["title"]: one for one in json.loads(path.read_text())["tables"]}
    assert list(tables) == ["Pushes", "Falls", "Turns"]
    assert tables["Falls"]["rows"] == [{"wanted": "0"} | rows[0], rows[1]]
    assert (tables["Falls"]["commit"], tables["Falls"]["seeds"]) == ("7654321", "20-39")
    assert "note" not in tables["Falls"]
    assert wrong_pages(tmp_path) == []


def test_what_is_measured_now_has_the_commit_that_is_checked_out(tmp_path: Path) -> None:
    subject(tmp_path)
    record("walks", "New", "make new", None, [{"what": "a", "measured": "b"}], folder=tmp_path)
    (made,) = load("walks", tmp_path).tables
    assert re.fullmatch(r"[0-9a-f]{7,}( with uncommitted changes)?", made.commit or "")
    assert made.date is not None


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (table(commit=None), "needs command and commit"),
        (table(rows=[]), "rows"),
        (table(date="yesterday"), "date"),
        (table(colour="red"), "colour"),
    ],
)
def test_a_table_that_does_not_say_where_it_is_from_is_refused(
    bad: dict[str, Any], words: str, tmp_path: Path
) -> None:
    subject(tmp_path, bad)
    with pytest.raises(ValueError, match=words):
        load("walks", tmp_path)


def test_a_subject_that_is_not_there_is_refused_before_anything_is_measured() -> None:
    parser = argparse.ArgumentParser()
    into_results.add_options(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["--results", "no_such_subject"])
    assert parser.parse_args(["--results", "walking"]).results.subject == "walking"


def test_the_command_that_is_noted_has_no_path_and_not_where_results_go() -> None:
    script = str(ROOT / "benches" / "episodes.py")
    words = [script, "slalom", "--results", "the_loop", "--json=/x/y.json", "--seeds", "1-2"]
    assert into_results.repeated(words) == "python benches/episodes.py slalom --seeds 1-2"
    assert into_results.repeated(["x.py", "/a/b", "--table", "T"]) == "python x.py b"


def test_columns_that_would_be_empty_are_left_out() -> None:
    rows = [{"what": "a", "measured": {"up": "1", "down": "2"}}, {"what": "b", "measured": "3|4"}]
    page = {"schema": "treadwell.results/1", "subject": "s", "title": "T", "about": "A."}
    text = markdown(Subject.model_validate(page | {"tables": [table(rows=rows)]}))
    assert "| what | up | down | measured |\n" in text
    assert "| b | - | - | 3\\|4 |\n" in text


EXPERIMENT = {
    "experiment": "fog",
    "interrupted": False,
    "seeds": 2,
    "first_seed": 7,
    "tables": [{"title": "T", "header": ["", "ours", "wanted"], "rows": [["a", "1", "2"]]}],
}


def test_what_an_experiment_wrote_becomes_a_table() -> None:
    taken = rows_of(EXPERIMENT, "T")
    assert taken.rows == [{"what": "a", "measured": {"ours": "1"}, "wanted": "2"}]
    assert taken.command == "treadwell experiment fog --seeds 2 --first-seed 7"
    assert taken.seeds == "7-8"
    with pytest.raises(ValueError, match="no table 'U'; there are 'T'"):
        rows_of(EXPERIMENT, "U")
    with pytest.raises(ValueError, match="interrupted"):
        rows_of(EXPERIMENT | {"interrupted": True}, "T")


def test_what_a_bench_and_a_sweep_wrote_become_tables() -> None:
    times = {"p50": 1.0, "worst": 2.0, "ratio": 4.0, "bindings_share": 0.01}
    bench = {"benches": [{"bench": "step", "frames": "room", "modes": {"exact": times}}]}
    (row,) = rows_of(bench, "any").rows
    assert row["what"] == "step, room, `exact`"
    assert row["measured"]["median"] == "1.000 ms"
    line = {"scenario": "slalom", "robot": "qrio", "variant": "", "successes": 3, "episodes": 4}
    line |= {"justified": 1, "falls": 0, "collisions": 0, "simulated_seconds_median": None}
    sweep = {"summary": [line], "lines": [{"seeds": [0, 1, 2, 3]}], "command": "treadwell sweep"}
    taken = rows_of(sweep, "any")
    assert taken.rows[0]["measured"]["successes"] == "3 of 4"
    assert (taken.command, taken.seeds) == ("treadwell sweep", "0-3")


def test_what_is_no_document_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "x.json"
    path.write_text("{}")
    assert main(["take", "walking", "T", "--from", str(path)]) == 2
    assert "neither" in capsys.readouterr().err
