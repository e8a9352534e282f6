"""Whether the motors of a robot's legs bear its weight, as plain data and as lines."""

from typing import Any

import mujoco
import numpy as np

from treadwell.robot.bearing import load_on
from treadwell.robot.load import Robot


def leg_loads(robot: Robot, data: mujoco.MjData) -> list[dict[str, Any]]:
    """Return what each joint of the legs bears when the robot stands on that leg alone."""
    peaks = dict(zip(robot.joints, (float(peak) for peak in robot.limits.peak_torque), strict=True))
    found = []
    for leg in (robot.file.legs.left, robot.file.legs.right):
        sole = (leg.sole.link, np.array(leg.sole.position))
        for load in load_on(robot.nominal, data, leg.joints, sole, peaks):
            group = next(
                (name for name, motors in robot.file.motors.items() if load.joint in motors.joints),
                None,
            )
            found.append(
                {
                    "joint": load.joint,
                    "motors": group,
                    "torque": load.torque_nm,
                    "share": load.share,
                }
            )
    return found


def too_weak(loads: list[dict[str, Any]]) -> list[str]:
    """Return a line for each kind of motors that cannot hold the robot on one leg."""
    worst: dict[str, dict[str, Any]] = {}
    for load in loads:
        group = load["motors"] or f"of {load['joint']}"
        if load["share"] > max(1.0, worst.get(group, load)["share"] - 1e-9):
            worst[group] = load
    return [
        f"motors.{group}.peak_torque: the motors cannot bear the weight: to stand on one leg "
        f"{load['joint']} takes {load['torque']:.1f} N m, its peak is "
        f"{load['torque'] / load['share']:.1f}"
        for group, load in worst.items()
    ]
