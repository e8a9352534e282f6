"""The shipped scenarios with stairs, closed loop, all noise on: climbed, or refused in words."""

from collections.abc import Callable
from pathlib import Path

import pytest

import treadwell
from treadwell.recording.verification import verify_run
from treadwell.runner import Run

pytestmark = pytest.mark.scenario

CLIMBED = {
    "stairs_up": (4, 0),
    "stairs_down": (0, 4),
    "stairs_over": (4, 4),
    "stairs_spiral": (5, 0),
    "stairs_uneven": (4, 0),
    "sill": (1, 1),
    "basin": (1, 1),
    "stair_lifted": (4, 0),
    "stair_blind": (4, 0),
    "obstacle_course": (5, 1),
}
"""Name -> steps up and down that both feet make."""
REFUSED = {
    "basin_narrow": {"gap_too_short"},
    "stairs_too_high": {"step_too_high"},
    "stair_removed": {"blocked", "drop"},
    "stair_blind_long": {"sensor"},
    "stairs_blank": {"blocked"},
}
"""Name -> words with which it may be refused."""
LONG = {"stairs_blank"}
"""Looked at for minutes before the refusal."""
REFUSALS = [pytest.param(name, marks=[pytest.mark.long] * (name in LONG)) for name in REFUSED]
SEED = 0

Runner = Callable[[str], Run]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Runner:
    """Runs each scenario once."""
    done: dict[str, Run] = {}
    folder = tmp_path_factory.mktemp("runs")

    def once(name: str) -> Run:
        if name not in done:
            done[name] = treadwell.run(name, seed=SEED, out=folder / name, record=False)
        return done[name]

    return once


@pytest.mark.parametrize("name", [*CLIMBED, *REFUSALS])
def test_a_scenario_with_stairs_ends_as_it_expects_without_a_fall(run: Runner, name: str) -> None:
    result = run(name).result
    assert (result.failures, result.passed) == ([], True), result.reason
    assert result.falls == 0
    assert result.collisions == []


@pytest.mark.parametrize("name", CLIMBED)
def test_as_many_steps_are_climbed_as_there_are(run: Runner, name: str) -> None:
    result = run(name).result
    assert (result.stairs_climbed, result.stairs_descended) == CLIMBED[name]


@pytest.mark.parametrize("name", REFUSALS)
def test_what_may_not_be_climbed_is_refused_in_the_most_specific_word(
    run: Runner, name: str
) -> None:
    result = run(name).result
    word, _, sentence = (result.reason or "").partition(": ")
    assert word in REFUSED[name]
    assert len(sentence) > 10


def test_progress_on_stairs_is_seen_in_the_states(run: Runner) -> None:
    states = [entry.state for entry in run("stairs_up").result.behaviour]
    firsts = [states.index(name) for name in ("search", "align", "approach", "climb", "finish")]
    assert firsts == sorted(firsts)


def test_the_map_has_every_step_that_was_climbed_at_its_height(run: Runner) -> None:
    surfaces = run("stairs_up").result.surfaces
    assert [entry.part for entry in surfaces] == [f"step {i}" for i in (1, 2, 3, 4)]
    for entry in surfaces:
        assert entry.estimate == pytest.approx(entry.truth, abs=0.006)


def test_plain_physics_steps_to_the_same_states_on_stairs_that_change(run: Runner) -> None:
    assert verify_run(Path(run("stair_lifted").folder)).problems == ()
