"""Claims about the plugin: scenario files are tests, and a failed one leaves its run."""

from pathlib import Path

import pytest
from episode_builders import result, scenario

import treadwell
from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.pytest_plugin import (
    ScenarioFailedError,
    free_folder,
    is_scenario,
    read_seeds,
    run_scenario,
)
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
        made = result(scenario(), outcome=chosen[0], seed=int(str(options.get("seed") or 0)))
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


@pytest.mark.parametrize(
    ("text", "seeds"),
    [
        ("5", (5,)),
        ("0,3,7", (0, 3, 7)),
        ("0-4", (0, 1, 2, 3, 4)),
        ("7, 2 - 3,3", (7, 2, 3)),
        ("0-9999", tuple(range(10_000))),
    ],
)
def test_seeds_are_one_several_or_a_range(text: str, seeds: tuple[int, ...]) -> None:
    assert read_seeds(text) == seeds


@pytest.mark.parametrize(
    "text", ["", "a", "4-0", "-1", "0-", "1,,2", "0-10000", "1-2-3", "1.5", "９", "9" * 16]
)
def test_what_names_no_seeds_is_refused_with_what_does(text: str) -> None:
    with pytest.raises(InputError, match=r"found .*(as in 5, 0,3,7 or 0-4|more than 10000 seeds)"):
        read_seeds(text)


def test_each_scenario_runs_once_a_seed_and_a_failed_one_leaves_its_own_folder(
    pytester: pytest.Pytester, outcome: list[str]
) -> None:
    pytester.makefile(".toml", small=SCENARIO)
    done = pytester.runpytest_inprocess("-v", "--treadwell-seeds", "0-1,7")
    done.assert_outcomes(passed=3)
    done.stdout.fnmatch_lines([f"small.toml::small?seed-{seed}? PASSED*" for seed in (0, 1, 7)])
    outcome[0] = "fell"
    done = pytester.runpytest_inprocess("-q", "--treadwell-seeds", "3", "-k", "seed-3")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["*outcome: fell, expected goal_reached", "run: *small-3"])
    assert (pytester.path / "runs" / "pytest" / "small-3" / "result.json").is_file()


@pytest.mark.usefixtures("outcome")
def test_the_ini_names_seeds_too_and_the_option_beats_it(pytester: pytest.Pytester) -> None:
    pytester.makefile(".toml", small=SCENARIO)
    pytester.makeini("[pytest]\ntreadwell_seeds = 0-3\n")
    pytester.runpytest_inprocess("-q").assert_outcomes(passed=4)
    pytester.runpytest_inprocess("-q", "--treadwell-seeds", "2").assert_outcomes(passed=1)


@pytest.mark.usefixtures("outcome")
def test_without_seeds_a_scenario_is_one_test_of_its_own_seed(pytester: pytest.Pytester) -> None:
    pytester.makefile(".toml", small=SCENARIO)
    done = pytester.runpytest_inprocess("-v")
    done.assert_outcomes(passed=1)
    done.stdout.fnmatch_lines(["small.toml::small PASSED*"])


@pytest.mark.usefixtures("outcome")
def test_the_python_that_a_scenario_names_is_said_before_it_runs(
    pytester: pytest.Pytester,
) -> None:
    code = pytester.makepyfile(
        own_part="class Mine:\n    def plan(self, view, stairs, start, goal): ...\n"
    )
    pytester.syspathinsert()
    own = SCENARIO + '[navigation]\nplanner = "own_part:Mine"\n'
    pytester.makefile(".toml", small=SCENARIO, own=own)
    said = f"*own.toml: runs planner own_part:Mine ({code})"
    done = pytester.runpytest_inprocess("--treadwell-seeds", "0-1")
    done.stdout.fnmatch_lines([said, "", "*.toml *"], consecutive=True)
    assert done.stdout.str().count("runs planner") == 1
    done = pytester.runpytest_inprocess("--treadwell-no-user-code")
    done.stdout.no_fnmatch_line("*runs planner*")


@pytest.mark.parametrize(("option", "ini"), [(["--treadwell-seeds", "4-0"], ""), ([], "x")])
def test_bad_seeds_end_pytest_with_one_line(
    pytester: pytest.Pytester, option: list[str], ini: str
) -> None:
    pytester.makeini(f"[pytest]\ntreadwell_seeds = {ini}\n")
    done = pytester.runpytest_inprocess(*option)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines(["ERROR: *treadwell?seeds: found *; must be seeds from 0 on*"])


@pytest.mark.usefixtures("outcome")
def test_the_fixture_runs_a_scenario_with_a_seed(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        import pytest

        @pytest.mark.parametrize("seed", range(2))
        def test_it(treadwell_scenario, seed):
            assert treadwell_scenario("slalom", seed=seed).seed == seed
        """
    )
    pytester.runpytest_inprocess("-q").assert_outcomes(passed=2)


@pytest.mark.slow
def test_a_scenario_file_is_a_test_and_a_broken_one_fails_with_its_message(
    pytester: pytest.Pytester,
) -> None:
    pytester.makefile(".toml", broken=SCENARIO + "speed = 3\n")
    done = pytester.runpytest_subprocess("-q")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["*speed*"])
    assert "Traceback" not in done.stdout.str()
