"""Claims about the report's table of planned footsteps: it says why the way costs what it costs."""

from episode_builders import result, world

from treadwell.judging.entries import FootstepPlanEntry
from treadwell.reporting.footstep_costs import footstep_costs
from treadwell.reporting.tables import table


def test_each_plan_has_a_row_that_adds_up() -> None:
    plan = FootstepPlanEntry(
        time=12.3,
        steps=5,
        careful_steps=2,
        walked=1.5,
        careful=2.5,
        partial=0.3,
        margin=0.4,
        turns=0.2,
        unseen=4.0,
        expanded=80,
    )
    told = result(world().scenario, footsteps_planned=4, footstep_plans=[plan])
    (row,) = footstep_costs(told).rows
    assert row[:2] == ("12.3", "5 (2)")
    assert float(row[2]) == sum(float(part) for part in row[3:])
    assert not footstep_costs(result(world().scenario)).rows


def test_a_long_table_says_how_much_is_left_out() -> None:
    short = table("of few", ("a",), [("1",)])
    long = table("of many", ("a",), [(str(i),) for i in range(70)])
    assert (len(short.rows), short.note) == (1, "")
    assert (len(long.rows), long.note) == (60, "and 10 more")
