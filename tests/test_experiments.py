"""Experiments: which there are, what their tables say of results, and one small one in full."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from episode_builders import result, scenario

from treadwell.cli import experiment as cli_experiment
from treadwell.cli.app import execute
from treadwell.errors import InputError
from treadwell.experiments import conduct as conducting
from treadwell.experiments.catalogue import EXPERIMENTS, find_experiment
from treadwell.experiments.conduct import conduct
from treadwell.experiments.experiment import NOTHING, Case, Experiment, Table, middle, share
from treadwell.experiments.stairs import PHASES, STAIRS, phase_seconds, stairs_tables
from treadwell.experiments.stairs_cases import CLAIMS
from treadwell.judging.result import Result, StateEntry
from treadwell.measuring.step_watch import KnownTop, StepError
from treadwell.runner import Run
from treadwell.scenario.elements import Stairs
from treadwell.scenario.loading import load_scenario, scenario_names

ROOT = Path(__file__).parents[1]
MADE = scenario()
SHORT = """
schema = 1
name = "short"
time_limit = 0.2
[start]
position = [0.0, 0.0]
[goal]
position = [1.0, 0.0]
"""


def lane(**seconds: float) -> list[StateEntry]:
    """States one after the other; a name may end in _2 where it comes again."""
    time, entries = 0.0, []
    for name, length in seconds.items():
        entries.append(StateEntry(time=time, state=re.sub(r"_\d$", "", name)))
        time += length
    return entries


def climbed(**changes: object) -> Result:
    facts: dict[str, Any] = {
        "passed": True,
        "stairs_climbed": 4,
        "simulated_seconds": 44.0,
        "behaviour": lane(look_around=4, turn=1, align=5, approach=5, climb=24, finish=5),
    }
    return result(MADE, **facts | changes)


def runs(*results: Result, **facts: Any) -> list[Run]:  # noqa: ANN401 - as `Run` takes them
    return [Run(one, Path("folder"), **facts) for one in results]


def table(results: dict[str, list[Run]], title: str) -> dict[str, tuple[str, ...]]:
    """The table whose title begins so, its rows by their first cell."""
    made = next(one for one in stairs_tables(results) if one.title.startswith(title))
    assert all(len(row) == len(made.header) for row in made.rows)
    return {row[0]: row[1:] for row in made.rows}


def test_every_experiments_scenarios_are_there() -> None:
    for made in EXPERIMENTS.values():
        named = {case.scenario for case in made.cases if isinstance(case.scenario, str)}
        assert named <= set(scenario_names())
        names = [case.name for case in made.cases]
        assert len(names) == len(set(names))
        assert made is find_experiment(made.name)


@pytest.mark.parametrize("name", ["stair", "frog", "", "Stairs"])
def test_an_experiment_that_is_not_there_is_bad_input(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    allowed = "allowed are fog, footsteps, indoor, models, nao, robots, stairs, world"
    with pytest.raises(InputError, match=allowed):
        find_experiment(name)
    assert execute(["experiment", name]) == 2
    assert "there is no experiment" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["--seeds", "0"], ["--seeds", "x"], ["--sed", "1"]])
def test_options_that_make_no_sense_are_bad_input(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["experiment", "stairs", *arguments]) == 2
    assert capsys.readouterr().out == ""


def test_as_many_steps_are_expected_as_the_scenarios_have() -> None:
    for claim in CLAIMS:
        name = claim.case.scenario
        if claim.changes is None or not isinstance(name, str):
            continue
        up, down = claim.changes
        made = load_scenario(name, overrides=claim.case.overrides)
        if made.expect.outcome == "refused":
            assert (up, down) == (0, 0), name
            continue
        assert up + down > 0, name
        flights = [e for e in made.course if isinstance(e, Stairs)]
        if [e.kind for e in made.course if e.kind not in ("wall", "box", "cylinder")] == ["stairs"]:
            assert up == flights[0].steps, name
            assert down == flights[0].steps * flights[0].descent, name


def test_the_phases_of_a_climb_are_those_of_the_paper() -> None:
    assert phase_seconds(climbed()) == {
        "search": 5.0, "align": 5.0, "approach": 5.0, "climb": 24.0, "finish": 5.0, "other": 0.0,
    }  # fmt: skip
    assert sum(paper for _, paper in PHASES.values()) == 44.0


def test_what_comes_between_steps_is_no_finish_and_what_comes_after_them_is() -> None:
    way = lane(search=2, climb=6, stop=3, climb_2=6, walk=4, look_around=1, arrive=1)
    seconds = phase_seconds(climbed(behaviour=way, simulated_seconds=23.0))
    assert seconds["climb"] == 12.0
    assert seconds["other"] == 3.0
    assert seconds["finish"] == 6.0
    assert sum(seconds.values()) == 23.0


def test_every_state_of_the_core_counts_for_a_phase() -> None:
    known = {state for states, _ in PHASES.values() for state in states}
    for part in ("walking", "climbing"):
        source = (ROOT / "rust" / "behaviour" / "src" / part / "state.rs").read_text()
        states = set(re.findall(r'Self::\w+ => "(\w+)"', source))
        assert states
        assert states <= known


def test_successes_falls_and_steps_are_counted() -> None:
    fell = climbed(passed=False, outcome="fell", falls=1)
    rows = table(
        {"stairs_up": runs(climbed(), climbed(stairs_climbed=3), fell)}, "What was climbed"
    )
    assert set(rows) == {"stairs_up"}
    assert rows["stairs_up"][2:] == ("2 of 3", "1", "0", "2 of 3 (4 up, 0 down)", "44.0")


def test_times_are_of_the_runs_that_went_as_expected() -> None:
    slow = climbed(passed=False, behaviour=lane(climb=100), simulated_seconds=100.0)
    rows = table({"stairs_up": runs(climbed(), slow), "stairs_down": []}, "Seconds")
    assert rows["climb"][:2] == ("24", "24.0")
    assert rows["climb, a step"][:2] == ("6", "6.0")
    assert rows["in all"] == ("44", "44.0", NOTHING)


def test_refusals_have_their_words_and_surprises_too() -> None:
    refused = runs(
        climbed(outcome="refused", reason="step_too_high: 55 mm"),
        climbed(outcome="refused", reason="step_too_high: 56 mm", seed=1),
    )
    lost = climbed(outcome="refused", reason="lost: gone", passed=False, seed=7)
    tables = stairs_tables({"step_55_mm": refused, "sill": runs(lost, climbed())})
    found = next(one for one in tables if one.title.startswith("What was refused")).rows
    assert found == (
        ("step_55_mm", "2", "step_too_high: 55 mm", NOTHING),
        ("sill", "1", "lost: gone", "7"),
    )


def test_what_was_known_of_steps_is_counted_against_what_is_asked() -> None:
    def step(height: float = 0.0, edge: float = 0.0, heading: float = 0.0) -> StepError:
        return StepError(1.0, 0.03, height, edge, heading)

    steps = (step(), step(height=0.0031), step(edge=-0.011), step(heading=0.06), step(math.nan))
    rows = table({"sill": runs(climbed(), steps=steps)}, "Each step")
    assert rows["sill"] == rows["all"]
    assert rows["sill"][0] == "4 of 5"
    assert rows["sill"][4:] == ("3 of 5", "2 of 5")


def test_the_width_of_a_basin_is_that_of_the_surface_in_it() -> None:
    tops = (
        KnownTop(0.2, 0.0, 0.0, 0.9),
        KnownTop(0.66, 0.1, 0.002, 0.124),
        KnownTop(0.665, 0, 0.03, 1),
    )
    rows = table({"basin_130_mm": runs(climbed(), tops=tops), "basin_150_mm": []}, "The measured")
    assert rows["basin_130_mm"] == ("1", "-6.0 ± 0.0")
    assert rows["basin_150_mm"] == ("0", NOTHING)


def test_of_what_was_not_run_there_is_no_table() -> None:
    assert stairs_tables({}) == []
    titles = [made.title for made in stairs_tables({"sill": runs(climbed())})]
    assert titles == [
        "What was climbed and what was refused",
        "Segmentation, recognition and behaviour, ms a frame",
    ]


def test_a_table_is_markdown_whatever_its_cells_hold() -> None:
    text = Table("T", ("a", "b"), (("x|y", "1"),), ("A note.",)).markdown()
    assert text == "## T\n\n| a | b |\n| --- | --- |\n| x\\|y | 1 |\n\nA note.\n"
    assert (middle([]), share(0, 0)) == (NOTHING, NOTHING)


@pytest.fixture
def small(tmp_path: Path) -> Experiment:
    """An experiment of two episodes that are over at once."""
    files = [tmp_path / name for name in ("short.toml", "again.toml")]
    for file in files:
        file.write_text(SHORT)
    cases = tuple(Case(file.stem, str(file)) for file in files)
    return replace(STAIRS, name="small", cases=cases)


def test_an_experiment_leaves_its_report_and_the_runs(
    small: Experiment,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out = tmp_path / "out"
    monkeypatch.setitem(EXPERIMENTS, "small", small)
    one = ["experiment", "small", "--seeds", "1", "--workers", "1", "--out", str(out), "--json"]
    assert execute(one) == 1
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    assert document == json.loads((out / "experiment.json").read_text())
    assert document["schema"] == "treadwell.experiment/1"
    assert [run["folder"] for run in document["runs"]] == ["short-0", "again-0"]
    assert {run["outcome"] for run in document["runs"]} == {"timed_out"}
    assert not document["passed"]
    assert "2 of 2: again seed 0" in captured.err
    for run in document["runs"]:
        assert (out / run["folder"] / "result.json").is_file()
    assert "## Segmentation, recognition" in (out / "experiment.md").read_text()
    with pytest.raises(InputError, match="exists already"):
        conduct(small, range(1), out)


@pytest.mark.parametrize("between", [False, True])
def test_an_interrupted_experiment_reports_what_there_is(
    between: bool,
    small: Experiment,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The second run is interrupted, as by Ctrl-C, or what is before and after it."""
    outcomes = iter(("timed_out", "interrupted"))

    def run(*_: object, **__: object) -> Any:  # noqa: ANN401 - as much of a run as is asked for
        made = climbed(outcome=next(outcomes))
        if between and made.outcome == "interrupted":
            raise KeyboardInterrupt
        return Run(made, tmp_path)

    monkeypatch.setattr(conducting, "run_episode", run)
    out = tmp_path / "out"
    monkeypatch.setitem(EXPERIMENTS, "small", small)
    one = ["experiment", "small", "--seeds", "1", "--workers", "1", "--out", str(out), "--json"]
    assert execute(one) == 130
    document = json.loads(capsys.readouterr().out)
    assert document["interrupted"]
    assert not document["passed"]
    assert len(document["runs"]) == 1


@pytest.mark.parametrize(
    ("changes", "status"),
    [({}, 0), ({"passed": False}, 1), ({"passed": False, "outcome": "error"}, 3)],
)
def test_the_exit_status_says_how_it_went(
    changes: dict[str, Any], status: int, small: Experiment, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    made = climbed(**changes)
    done = Run(made, tmp_path)
    monkeypatch.setitem(EXPERIMENTS, "small", small)
    monkeypatch.setattr(conducting, "run_episode", lambda *_, **__: done)
    out = tmp_path / "out"
    code = cli_experiment.experiment(
        "small", only=(), seeds=range(1), workers=1, out=out, as_json=False
    )
    assert code == status
    shown = capsys.readouterr()
    assert "Segmentation, recognition" in shown.out
    assert "experiment.md" in shown.err
    notes = [note for table in stairs_tables({"short": [done]}) for note in table.notes]
    assert notes
    assert all(note in shown.err for note in notes)


@pytest.mark.slow
def test_processes_side_by_side_give_the_same_report(small: Experiment, tmp_path: Path) -> None:
    reports = [
        conduct(small, range(3, 5), tmp_path / str(workers), workers=workers).document()
        for workers in (1, 2)
    ]
    for document in reports:
        document.pop("folder")
        document.pop("tables")  # they hold times of the clock
    assert reports[0] == reports[1]
    assert [run["seed"] for run in reports[0]["runs"]] == [3, 4, 3, 4]


def test_only_some_cases_are_run_and_an_unknown_one_is_bad_input(
    small: Experiment, capsys: pytest.CaptureFixture[str]
) -> None:
    assert [case.name for case in small.narrowed(["again"]).cases] == ["again"]
    assert small.narrowed(()) is small
    assert execute(["experiment", "stairs", "--only", "stares_up"]) == 2
    told = capsys.readouterr().err
    assert "allowed are stairs_up, " in told
    assert "did you mean 'stairs_up'?" in told


def test_recordings_of_the_runs_are_kept_when_they_are_asked_for(
    small: Experiment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def run(*_: object, record: bool, **__: object) -> Run:
        asked.append(record)
        return Run(climbed(), tmp_path)

    monkeypatch.setattr(conducting, "run_episode", run)
    monkeypatch.setitem(EXPERIMENTS, "small", small)
    for number, more in enumerate(((), ("--record",))):
        out = tmp_path / str(number)
        words = ["experiment", "small", "--seeds", "1", "--workers", "1", "--out", str(out)]
        assert execute([*words, *more]) == 0
    assert asked == [False, False, True, True]


def test_a_case_may_ask_for_more_seeds_or_fewer() -> None:
    assert Case("x", "y", share=5.0).seeds(range(20, 40)) == range(20, 120)
    assert Case("x", "y", share=0.1).seeds(range(20, 23)) == range(20, 21)
