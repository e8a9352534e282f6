"""What the experiment `models` runs: every world model on every scene of one suite."""

from dataclasses import dataclass
from typing import Final

from treadwell.components import COMPONENTS
from treadwell.experiments.experiment import Case
from treadwell.measuring.ground_watch import GroundWatch

WORLD_MODELS: Final = tuple(COMPONENTS["world_model"])
"""Whatever is registered: a model that is new is run as the others are."""


@dataclass(frozen=True, slots=True)
class Scene:
    """A scenario of the suite.

    Attributes:
        name: of the scenario.
        asks: what of a model it asks for, in a few words.
        elements: names of what stands there, of which no model is told; none where the scenario's
            own localizer needs the map of them.
    """

    name: str
    asks: str
    elements: tuple[str, ...]


SCENES: Final = (
    Scene("stairs_up", "stairs", ("stairs",)),
    Scene("sill", "a sill", ("sill", "left wall", "right wall", "end wall")),
    Scene("slope_up", "a slope", ("slope", "top")),
    Scene("rubble", "rubble to go around", ("rubble",)),
    Scene("terrain", "waves of the ground", ("waves",)),
    Scene("vegetation", "grass that gives way", ("grass",)),
    Scene("visitor", "a visitor who comes and goes", ("post",)),
    Scene("box_removed", "a box that is taken away", ("box",)),
    Scene("underpass", "under a deck in a house", ()),
    Scene("bridge_under", "under a bridge", ("banks", "deck")),
    Scene("bridge_over", "over a bridge", ("banks", "deck")),
)
SHOWN: Final = "bridge_under"
"""The scene that is drawn as every model has it (Fig. 36.11 of the handbook)."""
GONE: Final = ("box_removed", "visitor")
"""Scenes in which something is taken away."""


def case_name(scene: str, model: str) -> str:
    """Return the name of the case of a scene with a model."""
    return f"{scene}_{model}"


def _case(scene: Scene, model: str) -> Case:
    unmapped = (f"course.{name}.mapped=false" for name in scene.elements)
    settings = (f"navigation.world_model={model}", *unmapped)
    return Case(case_name(scene.name, model), scene.name, settings, watch=GroundWatch)


CASES: Final = tuple(_case(scene, model) for scene in SCENES for model in WORLD_MODELS)
