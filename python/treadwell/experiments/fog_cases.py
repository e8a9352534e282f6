"""What the experiment `fog` runs: its cases, by world model and by segmenter."""

import math
from collections.abc import Callable
from typing import Final

from treadwell.components import COMPONENTS
from treadwell.experiments.experiment import Case
from treadwell.measuring.ceiling_watch import CeilingWatch
from treadwell.measuring.element_watch import ElementWatch
from treadwell.measuring.map_watch import MapWatch
from treadwell.measuring.pose_watch import PoseWatch
from treadwell.measuring.segmentation_watch import SegmentationWatch
from treadwell.measuring.watch import Watch

FOG: Final = "fog"
WORLD_MODELS: Final = (FOG, "averaging")
"""The paper's map, and the one that it compares it with. Not all of `COMPONENTS`: `octree` is told
a static map, here with the very box in it that is then removed or moved."""
SEGMENTERS: Final = tuple(COMPONENTS["segmenter"])
_IDEAL: Final = tuple(f"sensors.{sense}=ideal" for sense in ("depth", "encoders", "imu", "feet"))

Naming = Callable[[str], str]
"""Name of a component -> name of the case."""

LEVELS_IDEAL: Final = "three_levels_ideal"
BEAM_HIGH: Final = "beam_high"
BEAM_LOW: Final = "beam_low"
BEAM_SEEN: Final = "beam_seen"
BEAM_SEEN_LOW: Final = "beam_seen_low"
BEAM_BY_THE_PAPER: Final = "beam_seen_by_the_paper"
BEAMS: Final = (BEAM_SEEN, BEAM_SEEN_LOW, BEAM_BY_THE_PAPER, BEAM_HIGH, BEAM_LOW)
WALKED_FILTERED: Final = "levels_walked"
WALKED_UNFILTERED: Final = "levels_walked_unfiltered"
CROOKED_FILTERED: Final = "levels_walked_crooked"
CROOKED_UNFILTERED: Final = "levels_walked_crooked_unfiltered"
WALKED: Final = (WALKED_FILTERED, WALKED_UNFILTERED, CROOKED_FILTERED, CROOKED_UNFILTERED)
TURNS: Final = "turns"
TURNS_MATCHED: Final = "turns_matched"
SLOPE: Final = "slope_seen"
OVER: Final = "over_each_other"


SLOPES: Final = (3, 5, 8, 10, 15)
"""Angles of the slopes that are walked, or refused, degrees."""
STEEPEST: Final = 10
"""A steeper slope is to be refused, degrees."""


def slope_up(angle: int) -> str:
    """Return the name of the case in which a slope of so many degrees is walked up."""
    return f"slope_up_{angle}"


def slope_down(angle: int) -> str:
    """Return the name of the case in which it is walked down."""
    return f"slope_down_{angle}"


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


def _worse(what: str, *overrides: str) -> Case:
    """Return a case of three levels that makes it harder for the map."""
    return Case(f"three_levels_{what}", "three_levels", overrides)


_WRONG_CAMERA: Final = (
    "sensors.camera_roll_pitch_error=0.1745",
    "sensors.camera_position_error=0.02",
)
_UNCORRECTED: Final = ("navigation.ground.correct=false",)
_UNMATCHED: Final = ("navigation.fog.match_gate=0.0",)

WORSE: Final = (
    _worse("10_degrees_20_mm", *_WRONG_CAMERA),
    _worse("unmatched", *_UNMATCHED),
    _worse("uncorrected", *_UNCORRECTED),
    _worse("uncorrected_unmatched", *_UNCORRECTED, *_UNMATCHED),
    *(
        _worse(f"{share}_percent_outliers", f"sensors.mismatch_rate={share}e-2")
        for share in (2, 5, 10)
    ),
)
"""Three levels with a camera that is more wrong than the robot's, without what puts it right, and
with pixels that are grossly wrong."""

_BEAMS: Final = (
    Case(BEAM_SEEN, "beam_seen", watch=CeilingWatch),
    Case(BEAM_SEEN_LOW, "beam_seen", ("course.beam.base=0.5",), watch=CeilingWatch),
    # More room than any beam leaves: as where there is no ceiling map.
    Case(BEAM_BY_THE_PAPER, "beam_seen", ("navigation.fog.headroom=9.0",), watch=CeilingWatch),
    Case(BEAM_HIGH, "beam_high", watch=CeilingWatch),
    Case(BEAM_LOW, "beam_low", watch=CeilingWatch),
)

_UNFILTERED: Final = ("navigation.odometry.height_gain=0.0",)

_CROOKED: Final = (
    "event=["
    '{at=0.2, do="encoder_offset", joint="left_knee_pitch", value=0.02},'
    '{at=0.2, do="encoder_offset", joint="right_knee_pitch", value=-0.02}]',
)
"""Knees that read 1.15 degrees too much and too little: four times what encoders may be off."""

_WALKED: Final = (
    Case(WALKED_FILTERED, "levels_walked", watch=PoseWatch),
    Case(WALKED_UNFILTERED, "levels_walked", _UNFILTERED, watch=PoseWatch),
    Case(CROOKED_FILTERED, "levels_walked", _CROOKED, watch=PoseWatch),
    Case(CROOKED_UNFILTERED, "levels_walked", _CROOKED + _UNFILTERED, watch=PoseWatch),
)


def _slope(scenario: str, name: Callable[[int], str], height: str, angle: int) -> Case:
    """Return the case of a scenario with a slope of this angle; `height`: key of what is on top."""
    rise = round(math.tan(math.radians(angle)), 4)
    top = (f"course.slope.rise={rise}", f"course.top.size=[0.8,0.8,{rise}]", f"{height}={rise}")
    refused = ('expect.outcome="refused"',) if angle > STEEPEST else ()
    return Case(name(angle), scenario, top + refused)


_SLOPES: Final = tuple(
    case
    for angle in SLOPES
    for case in (
        _slope("slope_up", slope_up, "goal.height", angle),
        _slope("slope_down", slope_down, "start.height", angle),
    )
)

CASES: Final = (
    Case(LEVELS_IDEAL, "three_levels", _IDEAL),
    *_for_each_model(levels, "three_levels"),
    *_for_each_model(removed, "box_removed", MapWatch),
    *_for_each_model(moved, "box_moved", MapWatch),
    *(
        Case(seen(name), "stairs_seen", _with("segmenter", name), watch=SegmentationWatch)
        for name in SEGMENTERS
    ),
    *WORSE,
    *_BEAMS,
    Case(SLOPE, "slope_seen", watch=ElementWatch),
    *_SLOPES,
    Case(OVER, "over_each_other", watch=ElementWatch),
    Case(TURNS, "turns", watch=PoseWatch),
    Case(TURNS_MATCHED, "turns", _with("localizer", "scan_match"), watch=PoseWatch),
    *_WALKED,
    # Where another map leads the robot is not asked; one run shows what it looks like.
    *_for_each_model(course, "obstacle_course", share_of_others=0.0),
)
