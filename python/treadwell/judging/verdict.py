"""How an episode ends: what the robot declares, held against what the judge sees."""

from dataclasses import dataclass

import mujoco

from treadwell.judging.judge import Judge
from treadwell.judging.result import Outcome

SETTLING_SECONDS = 5.0
"""Seconds after a declaration within which a robot of scale 1 has to stand still."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The end of an episode.

    Attributes:
        outcome: as in `result.json`.
        reason: `word: sentence`, None where the outcome says it all.
    """

    outcome: Outcome
    reason: str | None = None


class Referee:
    """Ends an episode. The robot declares arrival and refusal itself; it is never told."""

    def __init__(self, judge: Judge, time_limit: float, patience: float = 1.0) -> None:
        """Begin.

        Args:
            judge: the one to ask.
            time_limit: simulated seconds.
            patience: how much longer than a robot of scale 1 this one may take to come to a stand.
        """
        self._judge = judge
        self._settling_seconds = SETTLING_SECONDS * patience
        self._time_limit = time_limit
        self._declared: tuple[str, str | None, float] | None = None

    def decide(
        self, data: mujoco.MjData, time_s: float, outcome: str | None, reason: str | None
    ) -> Verdict | None:
        """Return the verdict, None while the episode goes on; call it after `Judge.watch`.

        Args:
            data: the same that was watched.
            time_s: simulated time, s.
            outcome: what the robot declares: `goal_reached`, `refused` or None.
            reason: why it refuses.
        """
        judge = self._judge
        if judge.fallen:
            return Verdict("fell", f"fell: {judge.fall}")
        if outcome is not None and self._declared is None:
            self._declared = (outcome, reason, time_s)
        if self._declared is not None:
            return self._check(data, time_s, *self._declared)
        if judge.stuck:
            return Verdict("stuck", "stuck: the robot stayed in one place for too long")
        if time_s >= self._time_limit - 1e-9:
            return Verdict("timed_out", f"timed_out: {self._time_limit:g} s were over")
        return None

    def _check(
        self, data: mujoco.MjData, time_s: float, outcome: str, reason: str | None, since: float
    ) -> Verdict | None:
        judge = self._judge
        if not judge.standing_still:
            if time_s - since < self._settling_seconds:
                return None
            return Verdict("stuck", "unsteady: the robot declared an end and did not stand still")
        if outcome == "refused":
            return Verdict("refused", reason)
        if judge.goal_reached(data):
            return Verdict("goal_reached")
        away = f"{judge.distance_to_goal:.3f} m"
        return Verdict("stuck", f"elsewhere: arrival declared {away} from the goal's centre")
