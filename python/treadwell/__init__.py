"""A testbed: a small humanoid finds its own way over an obstacle course, by its senses alone.

>>> import treadwell
>>> run = treadwell.run("slalom", seed=3)              # the same as `treadwell run slalom --seed 3`
>>> for step in treadwell.Episode("slalom"):           # or frame by frame
...     step.observation.depth, step.estimate.pose, step.command
>>> planners = {"navigation.planner": ["a_star", "voronoi"]}
>>> sweep = treadwell.sweep("slalom", episodes=20, vary=planners)
>>> treadwell.compare(sweep, figure="planners.pdf")    # each against each, by paired tests
"""

import os
from typing import TYPE_CHECKING, Any

from treadwell.gymnasium_hook import register_with_gymnasium
from treadwell.version import __version__

if TYPE_CHECKING:
    from treadwell.comparing.compare import compare
    from treadwell.episode import Episode
    from treadwell.replaying.replay import replay
    from treadwell.runner import run
    from treadwell.sweeps.sweep import sweep

__all__ = ["Episode", "__version__", "compare", "replay", "run", "sweep"]

if os.environ.get("TREADWELL_CORE"):
    from treadwell.own_core import use

    use(os.environ["TREADWELL_CORE"])

register_with_gymnasium()

_HOMES = {
    "Episode": "treadwell.episode",
    "replay": "treadwell.replaying.replay",
    "compare": "treadwell.comparing.compare",
    "run": "treadwell.runner",
    "sweep": "treadwell.sweeps.sweep",
}


_LIBRARY = ("costs", "mapping", "protocols")
"""Modules that users import."""


def __getattr__(name: str) -> Any:  # noqa: ANN401 - whatever the name means
    """Import the doors when they are first used: the command line starts faster without MuJoCo."""
    import importlib

    if name in _LIBRARY:
        return importlib.import_module(f"treadwell.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'treadwell' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the doors, those that were not used yet, too: for completion in a notebook."""
    return sorted({*__all__, *_LIBRARY, *(name for name in globals() if name.startswith("__"))})
