"""Claims about the plugin: scenario files are tests, and a failed one leaves its run."""

from pathlib import Path

import pytest
from episode_builders import result, scenario

import treadwell
from treadwell.data import data_folder
from treadwell.pytest_plugin import ScenarioFailedError, free_folder, is_scenario, run_scenario
from treadwell.runner import Run
from treadwell.scenario.model import Expect

pytest_plugins = ["pytester"]
SCENARIO = 'schema = 1\nname = "small"\n[start]\n[goal]\nposition = [1.0, 0.0]\n'


@pytest.fixture
def outcome(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The outcome that every run now has; the physics is left out."""
    chosen = ["goal_reached"]

    def run(_: str | Path, *, out: Path, **options: object) -> Run:
        out.mkdir(parents=True)
        (out / "result.json").write_text("{}")
        made = result(scenario(), outcome=chosen[0], seed=int(str(options.get("seed", 0))))
        return Run(made.judged_by(Expect()), out)

    monkeypatch.setattr(treadwell, "run", run, raising=False)
    return chosen


def test_a_scenario_that_passes_leaves_nothing(tmp_path: Path, outcome: list[str]) -> None:
    assert outcome == ["goal_reached"]
    found = run_scenario("small", tmp_path, seed=4)
    assert found.seed == 4
    assert list(tmp_path.iterdir()) == []


def test_a_scenario_that_fails_leaves_its_run_and_names_it(
    tmp_path: Path, outcome: list[str]
) -> None:
    outcome[0] = "fell"
    with pytest.raises(ScenarioFailedError) as caught:
        run_scenario(Path("somewhere/small.toml"), tmp_path)
    assert "expected goal_reached" in str(caught.value)
    assert str(tmp_path / "small") in str(caught.value)
    assert (tmp_path / "small" / "result.json").is_file()


def test_a_second_failure_overwrites_nothing(tmp_path: Path) -> None:
    first = free_folder(tmp_path, "small")
    first.mkdir()
    assert free_folder(tmp_path, "small") == tmp_path / "small-2"


def test_only_scenario_files_are_collected(tmp_path: Path) -> None:
    made, other = tmp_path / "a.toml", tmp_path / "b.toml"
    made.write_text(SCENARIO)
    other.write_text('[project]\nname = "something"\n')
    assert is_scenario(made)
    assert not is_scenario(other)
    suites = sorted((data_folder("scenarios") / "suites").glob("*.toml"))
    assert suites
    assert not any(map(is_scenario, suites))
    assert not is_scenario(tmp_path / "missing.toml")


@pytest.mark.slow
def test_a_scenario_file_is_a_test_and_a_broken_one_fails_with_its_message(
    pytester: pytest.Pytester,
) -> None:
    pytester.makefile(".toml", broken=SCENARIO + "speed = 3\n")
    done = pytester.runpytest_subprocess("-q")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["*speed*"])
    assert "Traceback" not in done.stdout.str()
