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
