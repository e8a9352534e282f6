"""Comparisons: figures, pairs by scenario and seed, and differences that a test has to show."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from sweep_builders import row

from treadwell.cli.app import execute
from treadwell.comparing.comparison import (
    MOST_EACH,
    TOO_FEW,
    Candidate,
    compared,
    differences,
    figure,
)
from treadwell.comparing.intervals import share_interval
from treadwell.comparing.metrics import METRICS
from treadwell.comparing.sides import candidates
from treadwell.comparing.statistics import DRAWS, LEVEL, holm
from treadwell.comparing.tables import comparison_tables
from treadwell.errors import InputError
from treadwell.sweeps.request import SCHEMA
from treadwell.sweeps.row import Row

BY_NAME = {metric.name: metric for metric in METRICS}
NAN = float("nan")
FAILED = {"outcome": "fell", "passed": False, "success": False, "falls": 1}


def side(name: str, *rows: Row) -> Candidate:
    return Candidate(name, rows)


def test_of(found: list[dict[str, Any]], metric: str) -> dict[str, Any]:
    return next(one for one in found if one["metric"] == metric)


test_of.__test__ = False  # type: ignore[attr-defined]


def test_figures_are_of_those_that_have_them() -> None:
    rows = [row(0), row(1), row(2, **FAILED)]
    success = figure(BY_NAME["success"], rows)
    assert (success["yes"], success["count"]) == (2, 3)
    assert success["low"] < 2 / 3 < success["high"]
    assert figure(BY_NAME["time"], rows) == {"value": 30.5, "count": 2}
    assert figure(BY_NAME["fall"], rows)["yes"] == 1
    assert figure(BY_NAME["core_ms"], rows) == {"value": None, "count": 0}


def test_a_justified_refusal_is_a_success_without_a_time() -> None:
    refused = row(0, outcome="refused", passed=False, justified=True)
    assert figure(BY_NAME["success"], [refused])["yes"] == 1
    assert figure(BY_NAME["time"], [refused])["count"] == 0


def test_an_episode_that_ended_by_an_error_has_only_failed() -> None:
    gone = row(0, outcome="error", passed=False, success=False, translation_error_mean=0.001)
    for name, metric in BY_NAME.items():
        assert figure(metric, [gone])["count"] == (name == "success"), name
    falling = side("a", *(row(i, **FAILED) for i in range(20)))
    erring = side("b", *(replace(gone, seed=i) for i in range(20)))
    assert {one["verdict"] for one in differences([falling, erring])} == {"no difference shown"}


def test_two_robots_on_scenarios_of_their_own_pair_with_one_on_both() -> None:
    mixed = side("a", row(0), row(1), row(0, scenario="two_levels", robot="nao"))
    other = side("b", *(replace(one, robot="nao") for one in mixed.rows))
    assert test_of(differences([mixed, other]), "success")["pairs"] == 3


def test_sides_without_a_pair_are_told() -> None:
    a, b = side("a", row(0), row(1)), side("b", row(5), row(6))
    tables = comparison_tables(compared([a, b]))
    assert any("No scenario and seed in common with the first: b" in n for n in tables[0].notes)
    tables = comparison_tables(compared([a, replace(a, name="b")]))
    assert not any("in common" in note for table in tables for note in table.notes)


def test_a_clear_difference_is_called_one_and_its_direction() -> None:
    first = side("a", *(row(i, path_efficiency=0.9) for i in range(20)))
    slower = side(
        "b", *(row(i, simulated_seconds=33.0 + i, path_efficiency=0.9) for i in range(20))
    )
    found = differences([first, slower])
    assert test_of(found, "time")["verdict"] == "worse"
    assert test_of(found, "time")["difference"] == pytest.approx(3.0)
    assert test_of(differences([slower, first]), "time")["verdict"] == "better"
    assert {one["verdict"] for one in found if one["metric"] != "time"} == {"no difference shown"}
    assert test_of(found, "height_error")["p"] is None


def test_failures_that_could_be_chance_are_no_difference() -> None:
    first = side("a", *(row(i) for i in range(30)))

    def failing(count: int) -> Candidate:
        return side("b", *(row(i, **FAILED) if i < count else row(i) for i in range(30)))

    few = test_of(differences([first, failing(4)]), "success")
    assert few["p"] == pytest.approx(0.125)
    assert few["verdict"] == "no difference shown"
    many = test_of(differences([first, failing(12)]), "success")
    assert many["verdict"] == "worse"
    assert many["p_corrected"] > many["p"]


def test_a_difference_has_its_interval_and_three_pairs_have_none() -> None:
    first = side("a", *(row(i) for i in range(30)))
    second = side("b", *(row(i, **FAILED) if i < 12 else row(i) for i in range(30)))
    success = test_of(differences([first, second]), "success")
    assert (success["low"], success["high"]) == share_interval(18, 12, 0, 0)
    time = test_of(differences([first, second]), "time")
    assert (time["low"], time["high"]) == (0.0, 0.0)
    slower = side("b", *(row(i, simulated_seconds=300.0) for i in range(3)))
    few = test_of(differences([first, slower]), "time")
    assert few["low"] is few["high"] is None
    shown = comparison_tables(compared([first, slower]))[-1]
    assert ("b", "time s", "+269.0", "-", "3") in [cells[:5] for cells in shown.rows]


def test_each_is_held_against_each_and_all_are_corrected_together() -> None:
    base = [row(i) for i in range(12)]
    sides = [
        side(name, *(replace(one, simulated_seconds=30.0 + one.seed + late) for one in base))
        for name, late in (("a", 0.0), ("b", 0.0), ("c", 2.0), ("d", 9.0))
    ]
    found = [one for one in differences(sides) if one["metric"] == "time"]
    assert [one["first"] + one["other"] for one in found] == ["ab", "ac", "ad", "bc", "bd", "cd"]
    assert {one["p"] for one in found[1:]} == {2 / 2**12}
    tested = [one for one in differences(sides) if one["p"] is not None]
    together = holm([one["p"] for one in tested])
    assert [one["p_corrected"] for one in tested] == together
    matrix = comparison_tables(compared(sides))[-1]
    assert matrix.title == "Each against each: time s"
    assert matrix.rows == (
        ("A  a", "-", "+0.0", "-2.0 better", "-9.0 better"),
        ("B  b", "+0.0", "-", "-2.0 better", "-9.0 better"),
        ("C  c", "+2.0 worse", "+2.0 worse", "-", "-7.0 better"),
        ("D  d", "+9.0 worse", "+9.0 worse", "+7.0 worse", "-"),
    )
    assert matrix.markdown().count("worse than that") == 1
    titles = [table.title for table in comparison_tables(compared(sides))]
    assert titles == ["Comparison", "Against a", "Each against each: success", matrix.title]


def test_pairs_that_could_never_have_shown_a_difference_are_called_too_few() -> None:
    """Three pairs and a difference of ninety times are no sign that there is none."""
    first = side("a", *(row(i, simulated_seconds=1.0 + 0.1 * i) for i in range(3)))
    slower = side("b", *(row(i, simulated_seconds=90.0 + i) for i in range(3)))
    found = differences([first, slower])
    time, tests = test_of(found, "time"), sum(one["p"] is not None for one in found)
    assert time["p"] == 2 / 2**3
    assert time["verdict"] == TOO_FEW
    limit = LEVEL / tests
    assert 2.0 ** (1 - time["pairs_least"]) < limit <= 2.0 ** (2 - time["pairs_least"])
    assert time["pairs_for_power"] >= time["pairs_least"]
    table = comparison_tables(compared([first, slower]))[-1]
    # A difference as clear as this takes no more than the least, which is said once.
    assert time["pairs_for_power"] == time["pairs_least"]
    assert table.rows[0][-2:] == (TOO_FEW, f"{time['pairs_least']} at least")
    told = " ".join(table.notes)
    assert f"Too few pairs: 3 cannot show a difference beside {tests - 1} other tests" in told
    assert "in 80 % of cases" not in told


def test_more_pairs_than_the_least_are_told_beside_it_and_what_about_means() -> None:
    first = side("a", *(row(i) for i in range(4)))
    steps = (9.0, -3.0, 5.0, -2.0)
    other = side("b", *(row(i, simulated_seconds=30.0 + i + s) for i, s in enumerate(steps)))
    time = test_of(differences([first, other]), "time")
    table = comparison_tables(compared([first, other]))[-1]
    assert time["pairs_for_power"] > time["pairs_least"]
    needed = f"{time['pairs_least']} at least, about {time['pairs_for_power']}"
    assert table.rows[0][-2:] == (TOO_FEW, needed)
    assert "in 80 % of cases" in " ".join(table.notes)


def test_a_median_and_the_mean_of_differences_are_each_called_what_they_are() -> None:
    """A time of which the median stays and the mean does not: two numbers that do not fit."""
    first = side("a", *(row(i, simulated_seconds=30.0) for i in range(9)))
    slower = side("b", *(row(i, simulated_seconds=30.0 if i < 5 else 60.0) for i in range(9)))
    figures, against = comparison_tables(compared([first, slower]))
    at = figures.header.index("time s, median")
    assert [line[at] for line in figures.rows] == ["30.0", "30.0"]
    assert against.rows[0][against.header.index("mean difference")] == "+13.3"
    assert "collisions" in figures.header
    assert "neither a share nor called a median is a mean" in figures.notes[0]
    assert "The mean is of these pairs alone" in against.notes[0]


def test_as_many_pairs_as_it_takes_show_it_and_one_less_never_does() -> None:
    def time_of(count: int) -> dict[str, Any]:
        first = side("a", *(row(i) for i in range(count)))
        slower = side("b", *(row(i, simulated_seconds=90.0 + i) for i in range(count)))
        return test_of(differences([first, slower]), "time")

    least = time_of(3)["pairs_least"]
    assert time_of(least - 1)["verdict"] == TOO_FEW
    assert time_of(least)["verdict"] == "worse"
    assert time_of(least)["pairs_for_power"] is None


def test_the_order_of_the_sides_changes_no_p() -> None:
    sides = [side(n, *(row(i, **(FAILED if i < k else {})) for i in range(9))) for n, k in
             (("a", 0), ("b", 4), ("c", 9))]  # fmt: skip

    def ps(order: list[Candidate]) -> dict[frozenset[str], float]:
        found = [one for one in differences(order) if one["metric"] == "success"]
        return {frozenset((one["first"], one["other"])): one["p_corrected"] for one in found}

    assert ps(sides) == ps(sides[::-1])


def test_too_many_for_each_against_each_are_held_against_the_first() -> None:
    sides = [side(f"s{k}", row(0), row(1)) for k in range(MOST_EACH + 1)]
    document = compared(sides)
    assert document["against"] == "first"
    assert {one["first"] for one in document["differences"]} == {"s0"}
    assert not [t for t in comparison_tables(document) if t.title.startswith("Each")]
    tests = math.comb(MOST_EACH, 2) * len(METRICS)
    assert tests / (1 + DRAWS) < LEVEL
    assert {one["first"] for one in differences(sides[:MOST_EACH])} == {
        f"s{k}" for k in range(MOST_EACH - 1)
    }


def test_pairs_are_the_same_scenario_and_seed() -> None:
    first = side("a", *(row(i) for i in range(5)), row(7, scenario="doorway"))
    second = side("b", *(row(i) for i in range(3, 9)))
    assert test_of(differences([first, second]), "success")["pairs"] == 2
    qrio, nao = row(0), row(0, robot="nao")
    assert test_of(differences([side("a", qrio), side("b", nao)]), "success")["pairs"] == 1
    both = [side("a", qrio, nao), side("b", replace(qrio), replace(nao))]
    assert test_of(differences(both), "success")["pairs"] == 2
    assert compared([])["differences"] == []


@pytest.fixture
def sweeps(tmp_path: Path) -> list[Path]:
    """Two sweeps of twenty episodes, the second with two variants."""
    folders = []
    for name, variants in (("one", [""]), ("two", ["x=1", "x=2"])):
        rows = [
            row(i, variant=v, simulated_seconds=30.0 + i + 5 * (v == "x=2"))
            for v in variants
            for i in range(20)
        ]
        document = {
            "schema": SCHEMA,
            "lines": [{"variant": variant} for variant in variants],
            "episodes": [one.document() for one in rows],
        }
        (tmp_path / name).mkdir()
        (tmp_path / name / "results.json").write_text(json.dumps(document))
        folders.append(tmp_path / name)
    return folders


def test_variants_are_sides_of_their_own(sweeps: list[Path]) -> None:
    assert [one.name for one in candidates(sweeps)] == ["one", "two x=1", "two x=2"]
    assert [one.name for one in candidates(sweeps[1:])] == ["x=1", "x=2"]
    assert [one.name for one in candidates(sweeps[:1])] == ["one"]


def test_the_command_shows_tables_json_and_markdown(
    sweeps: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names, out = [str(folder) for folder in sweeps], tmp_path / "comparison.md"
    assert execute(["compare", *names, "--json", "--out", str(out)]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["schema"] == "treadwell.comparison/1"
    assert len(document["differences"]) == 3 * len(METRICS)
    pairs = [("one", "two x=1"), ("one", "two x=2"), ("two x=1", "two x=2")]
    assert list(dict.fromkeys((d["first"], d["other"]) for d in document["differences"])) == pairs
    assert (document["against"], document["correction"], document["level"]) == (
        "each",
        "holm",
        0.05,
    )
    text = out.read_text()
    assert "| one | 20 | 100.0 % (83.9 to 100.0) |" in text
    assert "| B  two x=1 | +0.0 | - | -5.0 better |" in text
    assert "| two x=2 | time s | +5.0 | +5.0 to +5.0 | 20 | " in text
    assert execute(["compare", *names]) == 0
    shown = capsys.readouterr()
    assert "worse" in shown.out
    assert "Holm" in shown.err


def test_what_is_no_finished_sweep_is_bad_input(sweeps: list[Path], tmp_path: Path) -> None:
    for folders, what in (
        ([tmp_path / "nowhere"], "no such sweep"),
        ([tmp_path], "not a sweep"),
        ([sweeps[0], sweeps[0]], "given twice"),
    ):
        with pytest.raises(InputError, match=what):
            candidates(folders)
    (tmp_path / "journal.jsonl").write_text("")
    with pytest.raises(InputError, match="not finished"):
        candidates([tmp_path])
    for broken in ("no", "[]", '{"schema": "treadwell.sweep/1"}'):
        (tmp_path / "results.json").write_text(broken)
        with pytest.raises(InputError, match=r"results\.json"):
            candidates([tmp_path])
    good = {"schema": SCHEMA, "lines": [{}], "episodes": [{"seed": 1}]}
    (tmp_path / "results.json").write_text(json.dumps(good))
    with pytest.raises(InputError, match="an episode that is not"):
        candidates([tmp_path])
    whole = json.loads((sweeps[0] / "results.json").read_text())
    for key, value, what in (
        ("falls", "1", "falls: found '1'"),
        ("core_ms", NAN, "NaN is no finite"),
    ):
        bad = whole | {"episodes": [whole["episodes"][0] | {key: value}]}
        (tmp_path / "results.json").write_text(json.dumps(bad))
        with pytest.raises(InputError, match=what):
            candidates([tmp_path])
    assert execute(["compare", str(sweeps[0]), "--out", str(tmp_path / "no" / "x.md")]) == 2


def test_a_sweep_that_was_asked_for_more_is_not_finished(
    sweeps: list[Path], tmp_path: Path
) -> None:
    document = json.loads((sweeps[0] / "results.json").read_text())
    (tmp_path / "results.json").write_text(json.dumps(document))
    more = [{**line, "seeds": [*range(100)]} for line in document["lines"]]
    asked = {key: value for key, value in document.items() if key != "episodes"}
    (tmp_path / "sweep.json").write_text(json.dumps(asked | {"lines": more}))
    with pytest.raises(InputError, match="not finished"):
        candidates([tmp_path])
