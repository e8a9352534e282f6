"""The bar of a sweep: lines where there is no terminal, failures at once, time left."""

import pytest
from sweep_builders import row

from treadwell.cli import sweep_progress
from treadwell.cli.sweep_progress import SweepProgress


def test_where_there_is_no_terminal_failures_and_the_end_are_lines(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [100.0]
    monkeypatch.setattr(sweep_progress.time, "monotonic", lambda: now[0])
    with SweepProgress(4, terminal=False) as progress:
        progress.update(0, 0, None)
        for done, failed in ((1, False), (2, True), (3, False)):
            now[0] += 6.0
            facts = {"success": False, "outcome": "fell", "reason": "fell: so"} if failed else {}
            progress.update(done, done - (done > 1), row(done, **facts))
        progress.update(4, 3, row(4))
    lines = capsys.readouterr().err.splitlines()
    assert lines == [
        "0 of 4 episodes, 0 of 0 succeeded",
        "slalom qrio seed 2: fell fell: so",
        "2 of 4 episodes, 1 of 2 succeeded, 0:00:12 left",
        "4 of 4 episodes, 3 of 4 succeeded",
    ]
    assert progress.done == 4


def test_on_a_terminal_there_is_a_bar(capsys: pytest.CaptureFixture[str]) -> None:
    with SweepProgress(4, terminal=True) as progress:
        progress.update(3, 2, row())
    captured = capsys.readouterr()
    assert "3/4 2 of 3 succeeded" in captured.err
    assert captured.out == ""
