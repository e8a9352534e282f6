"""Senses and motors that break on the way, one at a time, on a flat course and on stairs."""

from dataclasses import dataclass
from typing import Final

from treadwell.experiments.experiment import Case

COURSES: Final = ("slalom", "stairs_up")
_WHEN: Final = 10.0
"""Simulated seconds until it breaks: the robot walks, or stands before the stairs."""
_WHILE: Final = 5.0


@dataclass(frozen=True, slots=True)
class Breakage:
    """What breaks.

    Attributes:
        name: of the row.
        overrides: settings that make it so.
        stands: whether a robot with it can stand at all; where not, a fall is no fault of ours.
    """

    name: str
    overrides: tuple[str, ...]
    stands: bool = True


def _fault(name: str, what: str, *, at: float = _WHEN, stands: bool = True) -> Breakage:
    return Breakage(name, (f'event=[{{at={at}, do="fault", {what}}}]',), stands)


BREAKAGES: Final = (
    _fault("depth_nan_5_s", f'part="depth", kind="nan", duration={_WHILE}'),
    _fault("depth_frozen_5_s", f'part="depth", kind="freeze", duration={_WHILE}'),
    _fault("depth_frozen", 'part="depth", kind="freeze"'),
    _fault("depth_half_dropped", 'part="depth", kind="drop", value=0.5'),
    _fault("depth_30_percent_outliers", 'part="depth", kind="outliers", value=0.3'),
    _fault("depth_5_percent_too_far", 'part="depth", kind="scale", value=1.05'),
    Breakage("depth_0.3_s_late", ("sensors.latency=0.3",)),
    Breakage("camera_3_degrees_down", (f'event=[{{at={_WHEN}, do="knock", pitch=0.0524}}]',)),
    _fault("cell_stuck_at_0", 'part="feet", kind="stick", foot="left", cell=0, value=0.0'),
    _fault("cell_stuck_at_60_N", 'part="feet", kind="stick", foot="left", cell=0, value=60.0'),
    _fault("left_foot_dead", 'part="feet", kind="dead", foot="left"'),
    _fault("gyro_2_degrees_a_s", 'part="imu", kind="bias", value=0.0349'),
    _fault("gyro_2_degrees_a_s_start", 'part="imu", kind="bias", value=0.0349', at=0.0),
    _fault("imu_swapped_start", 'part="imu", kind="swap"', at=0.0),
    _fault("imu_zero_start", 'part="imu", kind="zero"', at=0.0),
    _fault("torque_60_percent", 'part="motors", kind="weak", value=0.6'),
    _fault(
        "knee_40_percent_start",
        'part="motors", kind="weak", joint="left_knee_pitch", value=0.4',
        at=0.0,
        stands=False,
    ),
    Breakage("floor_0.3", (f'event=[{{at={_WHEN}, do="friction", value=0.3}}]',)),
    Breakage(
        "carried_off", (f'event=[{{at={_WHEN}, do="kidnap", position=[0.3, -0.6], yaw=1.2}}]',)
    ),
)
"""Faults of measured trials, and what is to come of them: no false success, hardly a fall."""


def case_of(breakage: Breakage, course: str) -> Case:
    """Return the case in which something breaks on a course; half of the seeds asked for."""
    return Case(f"{breakage.name}_{course}", course, breakage.overrides, share=0.5)
