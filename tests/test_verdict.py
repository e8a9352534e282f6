"""The referee: what the robot declares counts only when the judge has seen it."""

from dataclasses import dataclass
from typing import Any

import pytest

from treadwell.judging.verdict import SETTLING_SECONDS, Referee, Verdict


@dataclass
class Seen:
    """What a judge can be asked."""

    fallen: bool = False
    fall: str | None = None
    standing_still: bool = True
    stuck: bool = False
    at_goal: bool = True
    distance_to_goal: float = 0.4

    def goal_reached(self, _: object) -> bool:
        return self.at_goal


def decide(
    seen: Seen, time_s: float = 1.0, outcome: str | None = None, reason: str | None = None
) -> Verdict | None:
    anyone: Any = seen
    return Referee(anyone, 60.0).decide(anyone, time_s, outcome, reason)


def test_an_episode_goes_on_while_nothing_is_declared_and_nothing_happens() -> None:
    assert decide(Seen()) is None
    assert decide(Seen(), 59.98) is None


def test_the_time_limit_ends_it() -> None:
    assert decide(Seen(), 60.0) == Verdict("timed_out", "timed_out: 60 s were over")


def test_arrival_counts_where_the_judge_sees_it() -> None:
    assert decide(Seen(), outcome="goal_reached") == Verdict("goal_reached")


def test_arrival_declared_elsewhere_is_stuck_with_the_distance() -> None:
    found = decide(Seen(at_goal=False), outcome="goal_reached")
    assert found is not None
    assert found.outcome == "stuck"
    assert found.reason == "elsewhere: arrival declared 0.400 m from the goal's centre"


def test_a_refusal_keeps_its_reason() -> None:
    word = "blocked: there is a wall"
    assert decide(Seen(), outcome="refused", reason=word) == Verdict("refused", word)


@pytest.mark.parametrize("outcome", ["goal_reached", "refused", None])
def test_a_fall_beats_everything(outcome: str | None) -> None:
    seen = Seen(fallen=True, fall="the torso leaned by 0.90 rad at 1.00 s", stuck=True)
    found = decide(seen, 99.0, outcome)
    assert found == Verdict("fell", "fell: the torso leaned by 0.90 rad at 1.00 s")


def test_a_declaration_waits_for_the_robot_to_stand_and_not_for_ever() -> None:
    seen: Any = Seen(standing_still=False)
    referee = Referee(seen, 60.0)
    assert referee.decide(seen, 2.0, "goal_reached", None) is None
    assert referee.decide(seen, 2.0 + SETTLING_SECONDS - 0.01, "goal_reached", None) is None
    found = referee.decide(seen, 2.0 + SETTLING_SECONDS, "goal_reached", None)
    assert found is not None
    assert found.outcome == "stuck"
    assert found.reason is not None
    assert found.reason.startswith("unsteady: ")


def test_the_first_declaration_counts() -> None:
    seen: Any = Seen(standing_still=False)
    referee = Referee(seen, 60.0)
    assert referee.decide(seen, 2.0, "refused", "blocked: first") is None
    seen.standing_still = True
    assert referee.decide(seen, 2.5, "goal_reached", None) == Verdict("refused", "blocked: first")


def test_a_robot_that_stays_where_it_is_without_a_word_is_stuck() -> None:
    found = decide(Seen(stuck=True))
    assert found is not None
    assert found.outcome == "stuck"
