"""What the experiment `fog` runs: its cases, by world model and by segmenter."""

from collections.abc import Callable
from typing import Final

from treadwell.components import COMPONENTS
from treadwell.experiments.experiment import Case
from treadwell.judging.map_watch import MapWatch
from treadwell.judging.segmentation_watch import SegmentationWatch
from treadwell.judging.watch import Watch

FOG: Final = "fog"
WORLD_MODELS: Final = tuple(COMPONENTS["world_model"])
"""The paper's map, and those that it is compared with."""
SEGMENTERS: Final = tuple(COMPONENTS["segmenter"])
_IDEAL: Final = tuple(f"sensors.{sense}=ideal" for sense in ("depth", "encoders", "imu", "feet"))

Naming = Callable[[str], str]
"""Name of a component -> name of the case."""

LEVELS_IDEAL: Final = "three_levels_ideal"


def levels(model: str) -> str:
    """Return the name of the case with three levels."""
    return f"three_levels_{model}"


def removed(model: str) -> str:
    """Return the name of the case in which a box is removed."""
    return f"box_removed_{model}"


def moved(model: str) -> str:
    """Return the name of the case in which a box moves."""
    return f"box_moved_{model}"


def course(model: str) -> str:
    """Return the name of the case in which the course is walked."""
    return f"obstacle_course_{model}"


def seen(segmenter: str) -> str:
    """Return the name of the case in which a segmenter looks at stairs."""
    return f"stairs_seen_{segmenter}"


def _with(slot: str, name: str) -> tuple[str, ...]:
    return (f"navigation.{slot}={name}",)


def _for_each_model(
    name: Naming, scenario: str, watch: type[Watch] | None = None, *, share_of_others: float = 1.0
) -> list[Case]:
    """Return a case for each world model; of those that are compared with, a share of the runs."""
    return [
        Case(
            name(model),
            scenario,
            _with("world_model", model),
            1.0 if model == FOG else share_of_others,
            watch,
        )
        for model in WORLD_MODELS
    ]


CASES: Final = (
    Case(LEVELS_IDEAL, "three_levels", _IDEAL),
    *_for_each_model(levels, "three_levels"),
    *_for_each_model(removed, "box_removed", MapWatch),
    *_for_each_model(moved, "box_moved", MapWatch),
    *(
        Case(seen(name), "stairs_seen", _with("segmenter", name), watch=SegmentationWatch)
        for name in SEGMENTERS
    ),
    # Where another map leads the robot is not asked; one run shows what it looks like.
    *_for_each_model(course, "obstacle_course", share_of_others=0.0),
)
