"""Plan-view maps: the handbook's section 36.2 in the loop, and its figures with our data."""

from statistics import median
from typing import Final

from treadwell.experiments.experiment import NOTHING, Case, Experiment, Results, Table, share
from treadwell.experiments.indoor.figures import BESIDE

SCENES: Final = {
    "navigation.world_model=occupancy_2d": ("doorway", "slalom"),
    "navigation.localizer=fast_slam": ("rocks",),
    "navigation.planner=voronoi_graph": ("doorway", "random_house", "two_levels"),
    "navigation.planner=hierarchical": ("doorway", "random_house", "two_levels"),
}
"""A part of the chapter -> the scenes that it can represent."""


def _name(part: str, scene: str) -> str:
    return f"{scene}_{part.rpartition('=')[2]}"


def _tables(results: Results) -> list[Table]:
    rows = []
    for part, scenes in SCENES.items():
        for scene in scenes:
            runs = results.get(_name(part, scene), ())
            if not runs:
                continue
            ends = sorted({run.outcome for run in runs if run.outcome != "goal_reached"})
            collisions = sum(len(run.result.collisions) for run in runs)
            times = [run.result.timing_ms["plan"].median for run in runs]
            rows.append(
                (
                    part.rpartition("=")[2],
                    scene,
                    share(sum(run.passed for run in runs), len(runs)),
                    str(collisions),
                    ", ".join(ends) or NOTHING,
                    f"{median(times):.1f}",
                )
            )
    header = ("part", "scene", "as expected", "collisions", "other ends", "planning a frame, ms")
    note = "Elsewhere a plane that a laser sweeps says too little: sills, stairs, raised floors."
    return [Table("In the loop", header, tuple(rows), (note,))] if rows else []


INDOOR: Final = Experiment(
    name="indoor",
    description="Plan-view maps (handbook, section 36.2): in the loop, and the chapter's figures",
    cases=tuple(
        Case(_name(part, scene), scene, (part,))
        for part, scenes in SCENES.items()
        for scene in scenes
    ),
    tables=_tables,
    beside=BESIDE,
)
