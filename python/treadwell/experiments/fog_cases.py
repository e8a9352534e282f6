"""What the experiment `fog` runs: its cases, by world model and by segmenter."""

from typing import Final

from treadwell.components import COMPONENTS
from treadwell.experiments.experiment import Case
from treadwell.judging.map_watch import MapWatch
from treadwell.judging.segmentation_watch import SegmentationWatch

WORLD_MODELS: Final = tuple(COMPONENTS["world_model"])
"""The paper's map, and those that it is compared with."""
SEGMENTERS: Final = tuple(COMPONENTS["segmenter"])
_IDEAL: Final = tuple(f"sensors.{sense}=ideal" for sense in ("depth", "encoders", "imu", "feet"))

LEVELS_IDEAL: Final = "three_levels_ideal"
LEVELS: Final = "three_levels"
COURSE: Final = "obstacle_course"


def removed(model: str) -> str:
    """Return the name of the case in which a box is removed."""
    return f"box_removed_{model}"


def moved(model: str) -> str:
    """Return the name of the case in which a box moves."""
    return f"box_moved_{model}"


def seen(segmenter: str) -> str:
    """Return the name of the case in which a segmenter looks at stairs."""
    return f"stairs_seen_{segmenter}"


def _with(slot: str, name: str) -> tuple[str, ...]:
    return (f"navigation.{slot}={name}",)


CASES: Final = (
    Case(LEVELS_IDEAL, "three_levels", _IDEAL),
    Case(LEVELS, "three_levels"),
    *(
        Case(removed(model), "box_removed", _with("world_model", model), watch=MapWatch)
        for model in WORLD_MODELS
    ),
    *(
        Case(moved(model), "box_moved", _with("world_model", model), watch=MapWatch)
        for model in WORLD_MODELS
    ),
    *(
        Case(seen(name), "stairs_seen", _with("segmenter", name), watch=SegmentationWatch)
        for name in SEGMENTERS
    ),
    Case(COURSE, COURSE),
)
