"""The shipped scenarios, closed loop with all noise on: each does what it expects."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import treadwell
from treadwell.judging.verdict import Verdict
from treadwell.recording.verification import verify_run
from treadwell.runner import Run
from treadwell.scenario.loading import load_scenario, scenario_names

pytestmark = pytest.mark.scenario

WALKED = {
    "open_floor": "goal_reached",
    "slalom": "goal_reached",
    "blind_zone": "goal_reached",
    "blind_alley": "goal_reached",
    "doorway": "goal_reached",
    "curtain": "goal_reached",
    "visitor": "goal_reached",
    "push": "goal_reached",
    "boxed_in": "refused",
    "beam_high": "goal_reached",
    "beam_low": "refused",
    "slope_up": "goal_reached",
    "slope_down": "goal_reached",
    "slope_across": "goal_reached",
    "narrow_passage": "goal_reached",
    "terrain": "goal_reached",
    "rubble": "goal_reached",
    "vegetation": "goal_reached",
}
CLIMBED = (
    "stairs_up",
    "stairs_down",
    "stairs_over",
    "stairs_spiral",
    "stairs_askew",
    "stairs_uneven",
    "sill",
    "basin",
    "obstacle_course",
    "levels_walked",
    "stair_blind",
    "stair_lifted",
)
NOT_CLIMBED = (
    "stairs_too_high",
    "basin_narrow",
    "stairs_in_air",
    "stairs_blank",
    "stair_removed",
    "stair_blind_long",
)
LOOKED_AT = (
    "box_removed",
    "box_moved",
    "three_levels",
    "stairs_seen",
    "slope_seen",
    "over_each_other",
    "turns",
    "beam_seen",
)
IN_A_KNOWN_HOUSE = ("two_levels_unknown", "visitor_nao", "kidnapped", "underpass")
FAR_IN_A_KNOWN_HOUSE = ("two_levels", "nao_1", "nao_2", "nao_3")
FOOT_BY_FOOT = (
    "l_stairs",
    "l_stairs_down",
    "u_stairs",
    "u_stairs_down",
    "winder",
    "winder_down",
    "spiral_12",
    "spiral_12_down",
    "two_flights",
    "two_flights_down",
    "stairs_beside",
    "stairs_behind",
    "stepping_stones",
    "slabs",
)
"""Laid out for steps that are planned one by one: `treadwell experiment footsteps` walks them."""
BRIDGE = ("bridge_over", "bridge_under")
"""Minutes each: `treadwell experiment models` walks them."""
DRAWN = ("random_flat", "random_flights", "random_house", "random_stairs", "random_yard", "rocks")
"""Too many courses for a test: `treadwell sweep` runs them."""
CHANGING = ("door_shuts", "person_crosses")
"""Met with some seeds alone: docs/results/indoor_changing.md counts them."""
EXPECTED = {
    **WALKED,
    **dict.fromkeys((*DRAWN, *BRIDGE, *CHANGING, *FOOT_BY_FOOT), "goal_reached"),
    **dict.fromkeys((*IN_A_KNOWN_HOUSE, *FAR_IN_A_KNOWN_HOUSE), "goal_reached"),
    **dict.fromkeys(LOOKED_AT, "goal_reached"),
    **dict.fromkeys(CLIMBED, "goal_reached"),
    **dict.fromkeys(NOT_CLIMBED, "refused"),
}
OF_A_KIND = {
    "slalom": "boxes",
    "push": "an impulse",
    "visitor": "something that moves",
    "terrain": "a height field",
}
"""Name -> what plain physics has to do there; the others do it again."""
STEPPED = [
    pytest.param(name, marks=[] if name in OF_A_KIND else pytest.mark.long) for name in WALKED
]
SEED = 0
SEEDS = (SEED, pytest.param(1, marks=pytest.mark.long))
BOTH = ("qrio", pytest.param("nao", marks=pytest.mark.long))
FAR = [pytest.param(name, marks=pytest.mark.long) for name in FAR_IN_A_KNOWN_HOUSE]
Runner = Callable[[str, int], Run]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Runner:
    """Runs each scenario and seed once."""
    done: dict[tuple[str, int], Run] = {}
    folder = tmp_path_factory.mktemp("runs")

    def once(name: str, seed: int) -> Run:
        if (name, seed) not in done:
            out = folder / f"{name}-{seed}"
            done[name, seed] = treadwell.run(name, seed=seed, out=out, record=False)
        return done[name, seed]

    return once


def test_every_shipped_scenario_says_what_is_expected_of_it_here() -> None:
    assert {name: load_scenario(name).expect.outcome for name in scenario_names()} == EXPECTED


@pytest.mark.parametrize("name", [*IN_A_KNOWN_HOUSE, *FAR])
def test_in_a_house_that_is_known_the_goal_is_reached(run: Runner, name: str) -> None:
    result = run(name, SEED).result
    assert (result.outcome, result.falls, result.failures) == ("goal_reached", 0, [])
    assert not result.ablation


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", WALKED)
def test_a_scenario_ends_as_it_expects_without_a_fall_or_a_collision(
    run: Runner, name: str, seed: int
) -> None:
    result = run(name, seed).result
    assert (result.outcome, result.reason, result.failures) == (
        EXPECTED[name],
        result.reason if EXPECTED[name] == "refused" else None,
        [],
    )
    assert result.passed
    assert result.falls == 0
    assert result.collisions == []
    assert result.localization is not None
    # Where nothing corrects the heading, a place is wrong by more the longer the way.
    off = max(0.15, 0.02 * result.path_length)
    assert result.localization.translation_error.max < off
    assert not result.ablation


@pytest.mark.parametrize("name", STEPPED)
def test_plain_physics_steps_to_the_same_states(run: Runner, name: str) -> None:
    done = run(name, SEED)
    assert verify_run(Path(done.folder)).problems == ()


def passage(
    robot: str, footprint: str, width: float, seed: int = 2
) -> tuple[Verdict | None, int, set[str]]:
    """Return how it ends at a passage of a width, the collisions, and the states on the way."""
    sides = (0.02 + 0.5 * width, 0.02 - 0.5 * width)
    overrides = (
        f"navigation.a_star.footprint={footprint}",
        f"course.0.from=[0.9,{sides[0]:.3f}]",
        f"course.1.to=[0.9,{sides[1]:.3f}]",
    )
    episode = treadwell.Episode("narrow_passage", robot=robot, seed=seed, overrides=overrides)
    states = {step.state for step in episode}
    return episode.verdict, len(episode.judge.collisions), states


NARROWED = pytest.mark.xfail(
    reason="the map narrows the passage to 0.24 m: 1 of 13 seeds (before: 0, this one after 137 s)",
    strict=True,
)


@pytest.mark.parametrize(
    ("robot", "seed"),
    [
        ("qrio", 0),
        pytest.param("nao", 2, marks=pytest.mark.long),
        pytest.param("qrio", 2, marks=(NARROWED, pytest.mark.long)),
    ],
)
def test_what_is_too_narrow_for_the_circle_is_passed_sideways(robot: str, seed: int) -> None:
    verdict, collisions, states = passage(robot, "oriented", 0.33, seed)
    assert verdict is not None
    assert (verdict.outcome, collisions) == ("goal_reached", 0)
    assert "sidle" in states


@pytest.mark.parametrize("robot", BOTH)
def test_what_is_too_narrow_for_the_circle_is_refused_by_it(robot: str) -> None:
    verdict, collisions, states = passage(robot, "circle", 0.33)
    assert verdict is not None
    assert (verdict.outcome, collisions) == ("refused", 0)
    # Whoever stands in the mouth already does not count what is too near there as narrow.
    assert (verdict.reason or "").partition(": ")[0] in {"too_narrow", "blocked"}
    assert "sidle" not in states


@pytest.mark.parametrize("robot", BOTH)
def test_what_is_wide_enough_for_the_circle_is_walked_straight_ahead(robot: str) -> None:
    verdict, collisions, states = passage(robot, "circle", 0.44)
    assert verdict is not None
    assert (verdict.outcome, collisions) == ("goal_reached", 0)
    assert "sidle" not in states


def test_a_refusal_says_in_a_word_and_a_sentence_what_is_in_the_way(run: Runner) -> None:
    result = run("boxed_in", SEED).result
    assert result.reason is not None
    word, _, sentence = result.reason.partition(": ")
    assert word in {"blocked", "too_narrow", "no_path"}
    assert len(sentence) > 10
    assert result.simulated_seconds < 110.0


def test_the_map_of_a_course_is_right_nearly_everywhere(run: Runner) -> None:
    counted = run("slalom", SEED).result.map
    assert counted.floor_cells > 300
    assert counted.floor_cells_right > 0.9
    assert counted.obstacle_cells_right > 0.75


def test_stereo_sees_nothing_of_a_staircase_without_texture() -> None:
    seen = []
    for name in ("stairs_up", "stairs_blank"):
        settings = ("start.position=[0.15, 0.0]", "start.yaw=0.0")
        episode = treadwell.Episode(name, overrides=settings)
        frames = [step.observation.depth for step, _ in zip(episode, range(12), strict=False)]
        seen.append([int(np.isfinite(np.asarray(frame)).sum()) for frame in frames])
    # As the robot looks down, the staircase fills more than a third of the 88 x 72 pixels.
    assert np.subtract(*seen).max() > 88 * 72 / 3
