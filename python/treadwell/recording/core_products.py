"""What a core has made, as plain data; without a simulator."""

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Pilot, Stair
from treadwell.errors import CoreError
from treadwell.footstep_plan import plan_of
from treadwell.recording.mesh_file import SurfaceMesh
from treadwell.trace import StairTrace, SteppingTrace


def stairs_of(pilot: Pilot) -> tuple[StairTrace, ...]:
    """Return the stairs that are seen or remembered."""
    return tuple([_stair(stair) for stair in pilot.staircase().stairs])


def _stair(stair: Stair) -> StairTrace:
    return StairTrace(
        front=np.array(stair.front),
        back=np.array(stair.back),
        front_fitted=stair.front_fit is not None,
        back_fitted=stair.back_fit is not None,
        steps_ago=stair.steps_ago,
    )


def stepping_of(pilot: Pilot, known: int) -> SteppingTrace | None:
    """Return the plan of footsteps that was made last; None where `known` plans are all."""
    found = pilot.planned_footsteps()
    if found is None or found["count"] == known:
        return None
    ground = pilot.stepping_ground()
    assert ground is not None
    return SteppingTrace(plan_of(found), found["exit"], found["count"], *ground)


def occupied_by(pilot: Pilot) -> NDArray[np.float32]:
    """Return middle and side of each cube that the core holds to be occupied, (n, 4) m."""
    middles, sides = pilot.occupied()
    return np.column_stack([middles, sides]).astype(np.float32)


def known_surface(pilot: Pilot) -> SurfaceMesh | None:
    """Return the surface of the world model; None where it has none, or the core failed."""
    try:
        found = pilot.surface()
    except CoreError:
        return None
    return None if found is None else SurfaceMesh(*found)


def known_occupied(pilot: Pilot) -> NDArray[np.float32]:
    """Return what `occupied_by` does; of a core that has failed, which tells no more, no cube."""
    try:
        return occupied_by(pilot)
    except CoreError:
        return np.empty((0, 4), np.float32)
