"""A result is shown in a line and a table, with everything escaped; never as pages of its data."""

import re
from pathlib import Path
from typing import Any

import pytest
from episode_builders import result, scenario
from hypothesis import given
from hypothesis import strategies as st

import treadwell
from treadwell.cli import run as cli_run
from treadwell.measuring.measures import PoseErrors
from treadwell.replaying.replay import Replay
from treadwell.replaying.result import ReplayFacts, ReplayResult
from treadwell.runner import Run
from treadwell.summary import html_table, result_rows

NASTY = '<script>alert("&")</script>'


def text_of(html: str) -> list[str]:
    """The captions and cells of a table."""
    return re.findall(r"<(?:caption|th|td)[^>]*>([^<]*)<", html)


def replayed(**changes: object) -> ReplayResult:
    facts: dict[str, Any] = {
        "run": "x", "observations": 100, "compared": 100, "changed": False, **changes
    }  # fmt: skip
    made = scenario()
    return ReplayResult(
        scenario=made.name,
        robot="qrio",
        seed=made.seed,
        version="0.1.0",
        configuration=made.configuration(),
        simulated_seconds=1.0,
        wall_seconds=0.1,
        real_time_factor=10.0,
        steps_taken=0,
        replans=0,
        behaviour=[],
        timing_ms={},
        replay=ReplayFacts(**facts),
    )


def test_a_result_is_one_short_line() -> None:
    made = result(scenario(), outcome="fell", simulated_seconds=3.14159)
    name = f"{made.scenario} with qrio, seed {made.seed}"
    line = f"{name}: fell after 3.1 s, not passed"
    assert repr(made) == str(made) == f"<Result {line}>"
    run = Run(made, Path("runs/x"))
    assert repr(run) == f"<Run {line}; runs/x>"
    passed = made.model_copy(update={"passed": True, "outcome": "goal_reached"})
    assert repr(passed) == f"<Result {name}: goal_reached after 3.1 s, passed>"


def test_a_replay_is_one_line_that_says_whether_it_agrees() -> None:
    made = replayed()
    said = f"{made.scenario} with qrio, seed {made.seed}, replayed: the same in all 100 ticks"
    assert repr(made).startswith(f"<ReplayResult {said}")
    assert repr(Replay(made, Path("again"))) == f"<Replay {said}, bit for bit; again>"
    assert "no answers to compare with" in repr(replayed(compared=0))


def test_a_notebook_and_the_terminal_show_the_same_table(
    capsys: pytest.CaptureFixture[str],
) -> None:
    made = result(scenario(), outcome="refused", reason="sill: too high", failures=["a", "b"])
    title, *cells = text_of(made._repr_html_())
    cli_run.show(made.document())
    shown = capsys.readouterr().out
    assert title in shown
    assert all(cell in shown for cell in cells)
    assert dict(zip(cells[::2], cells[1::2], strict=True))["failures"] == "a; b"
    assert text_of(Run(made, Path("runs/x"))._repr_html_())[-2:] == ["folder", "runs/x"]
    assert "compared with the recording" in text_of(replayed()._repr_html_())
    assert text_of(Replay(replayed(), Path("again"))._repr_html_())[-1] == "again"


def test_nothing_of_a_result_is_taken_for_html() -> None:
    made = result(scenario(), scenario=NASTY, robot=NASTY, reason=NASTY, failures=[NASTY])
    for shown in (made, Run(made, Path(NASTY)), replayed(declared=NASTY, reason=NASTY)):
        assert "<script" not in shown._repr_html_()
        assert "&lt;script&gt;alert(&quot;&amp;&quot;)" in shown._repr_html_()


@given(st.text(), st.lists(st.tuples(st.text(), st.text())))
def test_a_table_has_no_more_elements_than_its_own(
    title: str, rows: list[tuple[str, object]]
) -> None:
    assert html_table(title, rows).count("<") == 6 + 6 * len(rows)


def test_what_python_gives_is_shown_so(tmp_path: Path) -> None:
    run = treadwell.run(
        "open_floor", overrides={"time_limit": 0.3}, record=False, out=tmp_path / "run"
    )
    assert repr(run).startswith("<Run open_floor with qrio, seed 0: timed_out after 0.3 s")
    assert len(repr(run)) < 200


def test_what_a_step_holds_is_a_line_each_too() -> None:
    step = treadwell.Episode("open_floor").tick()
    shown = [step.observation, step.observation.depth, step.command, step.estimate]
    for one in shown:
        assert "array" not in repr(one)
        assert len(repr(one)) < 160
    assert repr(step.observation).startswith("<Observation at 0.00 s: ")
    assert repr(step.observation.depth) in repr(step.observation)


def test_the_tab_key_offers_of_the_library_what_is_public() -> None:
    from treadwell import mapping

    assert {name for name in dir(mapping) if not name.startswith("__")} == set(mapping.__all__)


def test_the_error_says_how_long_the_robot_knew_that_it_was_lost() -> None:
    errors = PoseErrors()
    for place in (0.0, 0.4):
        errors.add_level((place, 0.0, 0.0, 0.0), (0.0,) * 4, (0.0,) * 4)
    found = errors.errors()
    assert found is not None
    assert found.lost_share == 0.0
    errors.add_lost()
    found = errors.errors()
    assert found is not None
    assert found.lost_share == 0.5
    document = {**result(scenario()).document(), "localization": found.model_dump()}
    told = dict(result_rows(document))["localization error, mean"]
    assert told == "0.200 m; in 50% of the frames it knew that it was lost"
