"""The table of three levels seen with worse senses."""

from pathlib import Path

from episode_builders import result
from experiment_builders import MADE, rows_of

from treadwell.experiments import fog_cases as cases
from treadwell.experiments.experiment import Results
from treadwell.experiments.fog import fog_tables
from treadwell.judging.result import MapCounts, SurfaceEntry
from treadwell.runner import Run


def test_with_worse_senses_labels_and_heights_stand_beside_those_with_the_robots_own() -> None:
    counts = MapCounts(
        floor_cells=90,
        floor_cells_right=0.9,
        obstacle_cells_right=1.0,
        whole_obstacle_cells=10,
        whole_obstacle_called_floor=0.0,
    )
    top = SurfaceEntry(element="low", part="top", truth=0.04, estimate=0.035, cells=9)
    runs = [Run(result(MADE, map=counts, surfaces=[top]), Path("folder"))]
    results: Results = {case.name: runs for case in cases.WORSE} | {cases.levels("fog"): runs}
    rows = rows_of(fog_tables, results, "Three levels with worse senses")
    assert set(rows) == set(results)
    assert set(rows.values()) == {("90.00", "100.00", "91.00", "5.00", "5.00")}
    assert "Three levels with worse" not in {
        made.title for made in fog_tables({cases.levels("fog"): runs})
    }
