"""Every foot planned: courses on which a chain of recognised stairs is no way."""

from typing import Final

from treadwell.experiments.experiment import Experiment
from treadwell.experiments.footsteps.suite import BEHAVIOUR, suite_of
from treadwell.experiments.footsteps.tables import footsteps_tables


def footsteps_experiment(behaviour: str = BEHAVIOUR) -> Experiment:
    """Return the experiment with a behaviour that walks.

    Args:
        behaviour: a name of `treadwell list components`, or `package.module:Class`.
    """
    suite = suite_of(behaviour)
    return Experiment(
        name="footsteps",
        description=f"{behaviour} on flights that turn, wind or stand aside, stones and slabs",
        cases=suite.cases,
        tables=footsteps_tables(suite),
    )


FOOTSTEPS: Final = footsteps_experiment()
