"""What a run planned and took of footsteps, for `map.png`, the result and the report."""

from typing import NamedTuple

from treadwell.footstep_plan import FootstepPlan
from treadwell.judging.entries import FootstepPlanEntry
from treadwell.trace import Sole


class SolePlace(NamedTuple):
    """A sole from above.

    Attributes:
        x: m, of its middle.
        y: as `x`.
        forward: (x, y) of its direction.
    """

    x: float
    y: float
    forward: tuple[float, float]


class StepMemory:
    """Keeps where soles were planned and put while the feet took listed steps.

    Attributes:
        planned: the next step of each plan, as the map has it.
        taken: where soles truly came down.
        plans: of each list of steps, as it was begun, what its plan costs.
        landed: listed steps that landed.
        refused: why steps of the user's planner were not taken, in the order of time.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.planned: list[SolePlace] = []
        self.taken: list[SolePlace] = []
        self.plans: list[FootstepPlanEntry] = []
        self.landed = 0
        self.refused: list[str] = []
        self._last_landed = 0
        self._touch = (True, True)
        self._stepping = False

    def plan(self, plan: FootstepPlan, *, taken: bool = True) -> None:
        """Take in a plan that is new.

        Args:
            plan: the plan.
            taken: whether the feet take steps now.
        """
        if plan.refused is not None and plan.refused not in self.refused:
            self.refused.append(plan.refused)
        for step in plan.steps[:taken]:
            self.planned.append(SolePlace(step.x, step.y, step.forward()))

    def frame(
        self,
        plan: FootstepPlan | None,
        time: float,
        *,
        landed: int,
        listed: bool,
        soles: tuple[Sole, Sole] | None,
        touch: tuple[bool, bool],
    ) -> None:
        """Take in a camera frame.

        Args:
            plan: the one that was made last.
            time: since the start, s.
            landed: steps of the present list that landed.
            listed: whether the feet take listed steps.
            soles: where the soles truly are, where that is known.
            touch: whether they stand on something.
        """
        if listed:
            # A list that begins anew counts from nothing.
            self.landed += max(landed - self._last_landed, 0)
            if not self._stepping and plan is not None and plan.steps:
                self.plans.append(_entry(plan, time))
        for side, sole in enumerate(soles or ()):
            if listed and touch[side] and not self._touch[side]:
                self.taken.append(SolePlace(sole.x, sole.y, sole.forward))
        self._last_landed = landed if listed else 0
        self._stepping, self._touch = listed, touch


def _entry(plan: FootstepPlan, time: float) -> FootstepPlanEntry:
    def seconds(manner: str) -> float:
        return sum(step.time for step in plan if step.manner == manner)

    return FootstepPlanEntry(
        time=time,
        steps=len(plan),
        careful_steps=sum(step.manner == "careful" for step in plan),
        walked=seconds("walked"),
        careful=seconds("careful"),
        partial=sum(step.partial for step in plan),
        margin=sum(step.margin for step in plan),
        turns=sum(step.turn for step in plan),
        unseen=max(plan.whole_cost - plan.cost, 0.0),
        expanded=plan.expanded,
    )
