"""The one list of experiments: a new one is a file beside this and a line in it."""

import difflib
from typing import Final

from treadwell.errors import InputError
from treadwell.experiments.experiment import Experiment
from treadwell.experiments.fog import FOG
from treadwell.experiments.footsteps.experiment import FOOTSTEPS
from treadwell.experiments.indoor.experiment import INDOOR
from treadwell.experiments.models.experiment import MODELS
from treadwell.experiments.nao import NAO
from treadwell.experiments.robots import ROBOTS
from treadwell.experiments.stairs import STAIRS
from treadwell.experiments.world.experiment import WORLD

EXPERIMENTS: Final[dict[str, Experiment]] = {
    made.name: made for made in (FOG, FOOTSTEPS, INDOOR, MODELS, NAO, ROBOTS, STAIRS, WORLD)
}


def find_experiment(name: str) -> Experiment:
    """Return an experiment by its name.

    Raises:
        InputError: there is none of that name; the message says which there are.
    """
    if name in EXPERIMENTS:
        return EXPERIMENTS[name]
    near = difflib.get_close_matches(name, EXPERIMENTS, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise InputError(
        f"NAME: there is no experiment {name!r}: allowed are {', '.join(EXPERIMENTS)}{hint}"
    )
