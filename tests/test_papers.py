"""What the pages of the papers name is there, and how the project is cited is true."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

from treadwell.experiments.catalogue import EXPERIMENTS
from treadwell.reference.parameters import find_parameters
from treadwell.scenario.loading import scenario_names

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs" / "papers").glob("*.md"))
CASES = {case.name for made in EXPERIMENTS.values() for case in made.cases}
TABLES = {row.key.split(".")[1]: row for row in find_parameters() if row.key.count(".") > 1}


def named(text: str) -> list[str]:
    """The settings that a page names in full, as in `fog.p_occ`."""
    found = re.findall(r"`([a-z_]+)\.([a-z_]+(?:\.[a-z_]+)*)(?: = [^`]*)?`", text)
    return [f"{table}.{key}" for table, key in found if table in TABLES and key != "rs"]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_scenarios_cases_and_settings_of_a_page_exist(page: Path) -> None:
    text = page.read_text()
    scenarios = set(re.findall(r"treadwell run (\w+)", text)) - {"SCENARIO"}
    assert scenarios <= set(scenario_names())
    assert set(re.findall(r"--only (\w+)", text)) <= CASES
    experiments = set(re.findall(r"treadwell experiment (\w+)", text))
    assert experiments <= set(EXPERIMENTS)
    keys = {row.key.partition(".")[2] for row in find_parameters()}
    missing = [
        one for one in named(text) if not any(k == one or k.startswith(f"{one}.") for k in keys)
    ]
    assert missing == []


def test_pages_name_settings_and_one_that_is_not_there_would_be_found() -> None:
    assert len(named((ROOT / "docs" / "papers" / "floor_map.md").read_text())) > 10
    assert named("`fog.nothing = 0` and `fog.p_occ`, not `result.json`") == [
        "fog.nothing",
        "fog.p_occ",
    ]


def test_the_bibliography_and_the_citation_name_the_same_four() -> None:
    page = (ROOT / "docs" / "papers" / "README.md").read_text()
    entries = re.findall(r"^  title +=\s*\{(.*)\}", page, re.MULTILINE)
    titles = {title.replace("{", "").replace("}", "") for title in entries}
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert len(titles) == 4
    assert titles == {reference["title"] for reference in cited["references"]}


def test_the_citation_is_of_this_version() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]
    assert cited["version"] == workspace["package"]["version"]
    assert {"cff-version", "message", "title", "authors"} <= cited.keys()
