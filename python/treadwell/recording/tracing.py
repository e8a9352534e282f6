"""What the recorder and the score are given of a camera frame: gathered from core and judge."""

import numpy as np
from numpy.typing import NDArray

from treadwell._core import Pilot
from treadwell.episode import Episode, Step
from treadwell.poses import pose_matrix
from treadwell.recording.core_products import occupied_by, stairs_of, stepping_of
from treadwell.recording.rhythm import Rhythm
from treadwell.trace import Trace

_MOST_GUESSES = 1000
"""So many guesses of a localizer are shown, about, evenly out of all."""
_NOTHING = np.empty((0, 4), np.float32)


def trace_of(episode: Episode, step: Step, rhythm: Rhythm | None = None) -> Trace:
    """Return one camera frame's trace.

    Args:
        episode: right after `step`.
        step: a tick, with or without a depth frame.
        rhythm: what is due of clearance, voxels and guesses, which then goes on; None: all.
    """
    pilot, data = episode.pilot, episode.simulation.data
    if rhythm is not None:
        rhythm.frame(step.time_ns)
    occupied = occupied_by(pilot) if rhythm is None or rhythm.voxels else _NOTHING
    if rhythm is not None and len(occupied):
        rhythm.voxels_taken()
    map_from_robot = pose_matrix(*step.estimate.pose)
    origin, cell, kind, height, sightings = pilot.floor()
    frame = step.observation.depth
    planes = pilot.planes()
    path = pilot.path()
    stepping = stepping_of(pilot, 0 if rhythm is None else rhythm.plans)
    if rhythm is not None and stepping is not None:
        rhythm.plans = stepping.count
    return Trace(
        time_ns=step.time_ns,
        map_from_robot=map_from_robot,
        odometry_from_robot=pose_matrix(*step.estimate.odometry),
        truth_from_robot=episode.judge.observed.matrix(),
        map_from_camera=map_from_robot @ pilot.robot_from_camera(),
        depth=None if frame is None else frame.depth,
        points_in_robot=planes.points_in_robot,
        labels=planes.labels,
        ground=0 if planes.ground is None else planes.ground + 1,
        view_origin=origin,
        view_cell=cell,
        view_kind=kind,
        view_height=height,
        sightings=sightings,
        maps_forgotten=pilot.maps_forgotten,
        map_due=rhythm is None or rhythm.map,
        clearance=pilot.clearance() if rhythm is None or rhythm.map else None,
        occupied=occupied,
        guesses=_guesses(pilot) if rhythm is None or rhythm.guesses else _NOTHING,
        path=np.empty((0, 2)) if path is None else path,
        climbs=tuple(climb.span for climb in pilot.climbs() or ()),
        stairs=stairs_of(pilot),
        soles=episode.judge.soles,
        touch=(episode.judge.touch.left, episode.judge.touch.right),
        footsteps=step.footsteps,
        stepping=stepping,
        misstep="stumbled" if pilot.stepping.stumbled else pilot.stepping.misstep,
        state=step.state,
        goal=episode.goal,
        gaze=(pilot.gaze[0], pilot.gaze[1]),
        body_positions=data.xpos.copy(),
        body_orientations=data.xquat.copy(),
        timing=dict(zip(pilot.stages, pilot.timing, strict=True)),
    )


def _guesses(pilot: Pilot) -> NDArray[np.float32]:
    """Return some of them, also of a search beside those that count."""
    places, headings, _ = pilot.guesses()
    stride = 1 + len(headings) // _MOST_GUESSES
    return np.column_stack([places, headings])[::stride].astype(np.float32)
