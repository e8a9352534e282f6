"""The tables of the experiment: what came of each claim, what the faults did, why it refused."""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

from treadwell.experiments.experiment import NOTHING, Results, Table, middle, share
from treadwell.experiments.level_heights import level_heights
from treadwell.experiments.stairs import reasons
from treadwell.experiments.world import claims
from treadwell.experiments.world.claim import Claim, has_no_way, touches_of_the_head, word
from treadwell.experiments.world.faults import BREAKAGES, COURSES, Breakage, case_of
from treadwell.runner import Run

LEVELS: Final = "obstacle_course"
"""The case whose levels are held against Table I of Gutmann 2005."""
_COLUMNS: Final = (
    "course",
    "robot",
    "right",
    "goal",
    "refused",
    "otherwise",
    "falls",
    "touches",
    "of the head",
    "s",
)
_RIGHT: Final = (
    "Right: the goal, or a refusal by a word that is true of the course, without a fall and, but "
    "for cables, without a touch. Of what is drawn anew for each seed, and of the ramp's "
    "corridor, a refusal is right, too, where a search on the true course finds no way within the "
    "robot's limits."
)


def _claimed(title: str, some: Iterable[Claim], results: Results, *notes: str) -> Table:
    rows = [_row(claim, results[claim.case.name]) for claim in some if results.get(claim.case.name)]
    return Table(title, _COLUMNS, tuple(rows), (*notes, _RIGHT))


def _row(claim: Claim, runs: Sequence[Run]) -> tuple[str, ...]:
    ends = Counter(run.outcome for run in runs)
    others = len(runs) - ends["goal_reached"] - ends["refused"] - ends["fell"]
    return (
        claim.what,
        claim.robot,
        share(sum(claim.is_right(run) for run in runs), len(runs)),
        str(ends["goal_reached"]),
        _words(runs),
        str(others),
        str(sum(run.result.falls for run in runs)),
        str(sum(len(run.result.collisions) for run in runs)),
        str(sum(touches_of_the_head(run) for run in runs)),
        middle([run.result.simulated_seconds for run in runs]),
    )


def _words(runs: Sequence[Run]) -> str:
    """Return how often it was refused by which word."""
    counted = Counter(word(run) for run in runs if run.outcome == "refused")
    return ", ".join(f"{one} {count}" for one, count in counted.most_common()) or NOTHING


def _worlds(results: Results) -> Table:
    rows = []
    for claim in claims.WORLD_CLAIMS:
        runs = results.get(claim.case.name, ())
        refused = [run for run in runs if run.outcome == "refused"]
        rightly = sum(has_no_way(claim.case, run) for run in refused)
        goals = sum(run.outcome == "goal_reached" for run in runs)
        falls = sum(run.result.falls for run in runs)
        if runs:
            right = share(goals + rightly, len(runs))
            parts = (str(goals), str(rightly), str(len(refused) - rightly), str(falls))
            rows.append((claim.what, claim.robot, right, *parts))
    columns = ("world", "robot", "goal, or no way", "goal", "refused, no way", "refused, a way")
    return Table(
        "Houses and yards that draw themselves",
        (*columns, "falls"),
        tuple(rows),
        (
            "No way: none that a search on the true course finds within the robot's published "
            "limits. Wanted: 97 of 100, and 2 falls at most in 800.",
        ),
    )


def _faults(results: Results) -> Table:
    rows = []
    for breakage in BREAKAGES:
        cells = [_broken(results.get(case_of(breakage, course).name, ())) for course in COURSES]
        if set(cells) != {NOTHING}:
            rows.append((breakage.name, *cells, "" if breakage.stands else "cannot stand"))
    runs = [run for breakage in BREAKAGES if breakage.stands for run in _runs_of(breakage, results)]
    together = (
        f"{sum(map(_is_false, runs))} / {sum(r.result.falls > 0 for r in runs)} of {len(runs)}"
    )
    rows += [("all that can stand: false successes / falls", together, NOTHING, "")] if runs else []
    return Table(
        "A sense or a motor breaks",
        ("fault", *COURSES, ""),
        tuple(rows),
        (
            "Goal / refused as `sensor` / refused otherwise / arrival declared elsewhere / falls / "
            "of. Wanted: no false success, falls in 2 % of those that can stand.",
        ),
    )


def _runs_of(breakage: Breakage, results: Results) -> list[Run]:
    return [run for course in COURSES for run in results.get(case_of(breakage, course).name, ())]


def _is_false(run: Run) -> bool:
    """Say whether arrival was declared where the goal is not."""
    return (run.result.reason or "").startswith("elsewhere")


def _broken(runs: Sequence[Run]) -> str:
    words = Counter(word(run) for run in runs if run.outcome == "refused")
    goals = sum(run.outcome == "goal_reached" for run in runs)
    counts = (
        goals,
        words["sensor"],
        words.total() - words["sensor"],
        sum(map(_is_false, runs)),
        sum(run.result.falls > 0 for run in runs),
        len(runs),
    )
    return " / ".join(map(str, counts)) if runs else NOTHING


def world_tables(results: Results) -> list[Table]:
    """Return the tables of what came out; of what was not run there is none."""
    head = (
        "Wanted: no fall, no touch of the head; passed with 4 cm more than the robot's height, "
        "refused with less than it."
    )
    made = [
        _claimed("Courses after complaints", claims.COMPLAINTS, results, "Wanted: 19 of 20."),
        _claimed("Courses that hold", claims.HELD, results, "Wanted: all."),
        _claimed("Things above the head, 45 to 75 cm", claims.OVERHEAD, results, head),
        _claimed(
            "Slopes and bevels",
            claims.SLOPES,
            results,
            "Up, down, across and over bevels of 10 cm. Wanted: 97 of 100 up to 10 degrees; up to "
            "12 either; steeper refused; no fall.",
        ),
        _worlds(results),
        _claimed("Random courses", claims.RANDOM_CLAIMS, results),
        _faults(results),
        level_heights(results.get(LEVELS, ())),
        reasons(results),
    ]
    return [table for table in made if table.rows]
