"""Suites: frozen lists whose scenario files have not changed since."""

from pathlib import Path

import pytest
from sweep_builders import short

from treadwell.errors import InputError
from treadwell.scenario.loading import find_scenario
from treadwell.sweeps.suite import file_hash, find_suite, suite_names

TEXT = """
schema = 1
name = "mine"
[[entry]]
scenario = "{scenario}"
seeds = [3, 5]
hash = "{hash}"
[[entry]]
scenario = "{scenario}"
robot = "nao"
seeds = [1]
hash = "{hash}"
"""


def written(folder: Path, wrong: str = "") -> Path:
    scenario = Path(short(folder))
    path = folder / "mine.suite"
    path.write_text(TEXT.format(scenario=scenario, hash=wrong or file_hash(scenario)))
    return path


@pytest.mark.parametrize("name", suite_names())
def test_the_projects_own_suites_are_as_they_were_frozen(name: str) -> None:
    suite = find_suite(name)
    assert suite.name == name
    for entry in suite.entry:
        assert file_hash(find_scenario(entry.scenario)) == entry.hash, entry.scenario


def test_there_is_a_leaderboard() -> None:
    assert "leaderboard" in suite_names()


def test_a_suite_is_a_sweep_of_its_own_seeds_and_robots(tmp_path: Path) -> None:
    request = find_suite(str(written(tmp_path))).request(vary=["physics.friction=0.7,0.8"])
    named = [(line.robot, line.seeds, line.variant) for line in request.lines]
    low, high = "physics.friction=0.7", "physics.friction=0.8"
    assert named == [
        ("qrio", (3, 5), low), ("qrio", (3, 5), high), ("nao", (1,), low), ("nao", (1,), high),
    ]  # fmt: skip
    assert len(request.keys()) == 6


def test_a_scenario_that_changed_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not what it was"):
        find_suite(str(written(tmp_path, wrong="0" * 64))).request()


def test_what_is_no_suite_is_bad_input(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="leaderboard"):
        find_suite("leaderbord")
    broken = tmp_path / "broken.toml"
    broken.write_text('schema = 1\nname = "x"\n[[entry]]\nscenario = "slalom"\nseeds = []\nhash=""')
    with pytest.raises(InputError, match=r"entry.0.seeds"):
        find_suite(str(broken))


def test_a_suite_with_a_seed_twice_is_bad_input(tmp_path: Path) -> None:
    path = written(tmp_path)
    path.write_text(path.read_text().replace("seeds = [3, 5]", "seeds = [3, 3]"))
    with pytest.raises(InputError, match="each seed may be there once"):
        find_suite(str(path))


def test_a_course_of_another_file_is_part_of_what_is_frozen(tmp_path: Path) -> None:
    scenario, other = Path(short(tmp_path)), tmp_path / "other.toml"
    other.write_text('[[course]]\nkind = "box"\nposition = [2.0, 2.0]\nsize = [0.2, 0.2, 0.2]\n')
    text = scenario.read_text()
    scenario.write_text(text.replace("schema = 1", 'schema = 1\ncourse_of = "other.toml"'))
    before = file_hash(scenario)
    other.write_text(other.read_text().replace("0.2, 0.2]", "0.2, 0.3]"))
    assert file_hash(scenario) != before
