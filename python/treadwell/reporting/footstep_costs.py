"""Why planned footsteps cost what they cost, for the page of a run."""

from treadwell.judging.result import Result
from treadwell.reporting.tables import TableData, table


def footstep_costs(result: Result) -> TableData:
    """Return why each plan of footsteps costs what it costs."""
    rows = [
        (
            f"{plan.time:.1f}",
            f"{plan.steps} ({plan.careful_steps})",
            *(
                f"{seconds:.1f}"
                for seconds in (
                    plan.walked
                    + plan.careful
                    + plan.partial
                    + plan.margin
                    + plan.turns
                    + plan.unseen,
                    plan.walked,
                    plan.careful,
                    plan.partial,
                    plan.margin,
                    plan.turns,
                    plan.unseen,
                )
            ),
        )
        for plan in result.footstep_plans
    ]
    columns = (
        "time (s)",
        "steps (careful)",
        "whole way (s)",
        "walked",
        "careful",
        "soles that bear in part",
        "little room beside them",
        "turns",
        "on over what was not seen",
    )
    return table("What planned footsteps cost, as the feet began to step", columns, rows)
