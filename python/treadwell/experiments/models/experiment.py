"""Every way to model the ground, side by side: the handbook's section 36.3."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from treadwell.experiments.experiment import Experiment, Picture, Results
from treadwell.experiments.models.recorded import RECORDED
from treadwell.experiments.models.suite import CASES, SCENES, SHOWN, WORLD_MODELS, case_name
from treadwell.experiments.models.tables import models_tables

_AROUND_M: Final = 0.3
"""Metres shown around what a map has."""


def _pictures(results: Results, folder: Path) -> Sequence[Picture]:
    """Draw one scene as every model has it: the first run of each."""
    # Late, because matplotlib takes half a second to import.
    from treadwell.experiments.fog_pictures import (
        Panel,
        draw_panels,
        known_bounds,
        true_outlines,
    )

    made = []
    asked = {scene.name: scene.asks for scene in SCENES}
    for name in (SHOWN,):
        panels = [
            Panel(f"{model}: {run.outcome}", run.remembered, true_outlines(run.result))
            for model in WORLD_MODELS
            for run in results.get(case_name(name, model), ())[:1]
            if run.remembered is not None and run.remembered.kind.any()
        ]
        if panels:
            path = folder / f"{name}.png"
            bounds = known_bounds([panel.remembered for panel in panels], _AROUND_M)
            draw_panels(path, panels, bounds)
            made.append(Picture(f"One scene in all models: {asked[name]}", path))
    return made


MODELS: Final = Experiment(
    name="models",
    description="Every way to model the ground (handbook, section 36.3), on one suite and on data",
    cases=CASES,
    tables=models_tables,
    pictures=_pictures,
    beside=RECORDED,
)
