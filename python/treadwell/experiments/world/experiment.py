"""The world beyond the project's own courses: what others' robots, and ours, went wrong on."""

from typing import Final

from treadwell.experiments.experiment import Case, Experiment
from treadwell.experiments.world.claims import CLAIMS
from treadwell.experiments.world.faults import BREAKAGES, COURSES, case_of
from treadwell.experiments.world.tables import LEVELS, world_tables

WORLD: Final = Experiment(
    name="world",
    description="The world beyond the project's own courses",
    cases=(
        *(claim.case for claim in CLAIMS),
        *(case_of(breakage, course) for breakage in BREAKAGES for course in COURSES),
        Case(LEVELS, "obstacle_course"),
    ),
    tables=world_tables,
)
