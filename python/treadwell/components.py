"""The components that a scenario can name, with one line each: the one list of them in Python.

What others add to it is in `additions`.
"""

import re
from typing import Final

COMPONENTS: Final[dict[str, dict[str, str]]] = {
    "world_model": {
        "fog": "floor and obstacle grid over an 8-bit occupancy grid, moves with the robot",
        "averaging": "mean height of each cell's points (Kagami 2003); what fog is compared with",
        "octree": "a static map that is told and a local one of what is seen (Maier 2012), octrees",
    },
    "segmenter": {
        "scan_line": "planes by scan-line grouping, thresholds follow the local noise",
        "scan_line_1994": "scan-line grouping as published: straight lines, fixed thresholds",
        "scan_line_adaptive": "the same for planes in any direction, each with a noise of its own",
        "hough": "planes in any direction by a randomised Hough transform",
        "ransac": "planes in any direction by repeated random samples",
        "histogram": "level surfaces by the peaks of a histogram of heights",
    },
    "localizer": {
        "odometry": "legs' odometry from encoders, gyro and foot contact",
        "matching": "the same, its heading kept by upright surfaces that are seen again",
        "monte_carlo": "particles in six dimensions against a static map (Maier 2012)",
        "truth": "the simulator's own pose; for ablations only, the result says so",
    },
    "planner": {
        "a_star": "A* on the grid by clearance; levels join by climbs, unknown cells have a price",
        "voronoi": "the same along the lines with most room to either side (Dolgov 2008)",
    },
    "behaviour": {
        "stair_climbing": "walks where it can, climbs where stairs lead on, both feet on each step",
        "continuous": "the same, one foot a step without stopping where the treads allow it",
        "walking": "walks the path, looks around, stops for what appears, refuses where no way is",
    },
}
"""Slot of `[navigation]` -> name -> description."""

STAGES: Final[tuple[str, ...]] = (
    "proprioception",
    "self_filter",
    "ground",
    "stairs",
    "climbing",
    "static_map",
    "guide",
)
"""Stages with parameters (`[navigation.self_filter]`) that are not chosen by name."""

CLASS_NAME: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*", re.ASCII)
"""A user's own component: `package.module:Class`."""


def parameter_tables() -> list[str]:
    """Return the names that a table `[navigation.<name>]` can have, sorted."""
    names = {name for slot in COMPONENTS.values() for name in slot}
    return sorted(names | set(STAGES))
