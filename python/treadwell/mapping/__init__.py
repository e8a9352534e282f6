"""The core's parts on data of one's own, without an episode.

>>> import numpy as np
>>> from treadwell import mapping
>>> camera = mapping.Camera(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)
>>> world = mapping.Map("fog", camera, robot="qrio", overrides={"fog.cell": 0.02})
>>> for depth, world_from_camera in frames:             # (h, w) m, NaN or 0 unseen; (4, 4)
...     seen = world.insert(depth, world_from_camera)   # seen.used, seen.reason, seen.planes
>>> world.save_picture("map.png"), world.save_recording("map.rrd")
>>> view = world.view()                                 # origin, cell, kind, height, sightings
>>> stairs = mapping.find_stairs(world)
>>> way = mapping.plan(world, start=(0, 0, 0), goal=(2, 0))
>>> way.path, way.reason

>>> height = np.zeros((100, 250))                       # (rows along y, columns along x), metres
>>> height[:, 100:] = 0.04                              # a step
>>> plan = mapping.plan_footsteps(height, cell=0.01, start=(0.4, 0.5, 0.0), goal=(2.0, 0.5))
>>> for step in plan:
...     step.side, step.x, step.y, step.yaw, step.height
"""

from treadwell._core import FloorView, Octree
from treadwell.footstep_plan import FootstepPlan, PlannedFootstep
from treadwell.mapping.camera import Camera
from treadwell.mapping.footsteps import plan_footsteps
from treadwell.mapping.kept_frames import Seen
from treadwell.mapping.map import Map
from treadwell.mapping.monte_carlo import MonteCarlo, Spread
from treadwell.mapping.stairs import FoundStair, find_stairs
from treadwell.mapping.view import floor_view
from treadwell.mapping.ways import Way, plan

__all__ = [
    "Camera",
    "FloorView",
    "FootstepPlan",
    "FoundStair",
    "Map",
    "MonteCarlo",
    "Octree",
    "PlannedFootstep",
    "Seen",
    "Spread",
    "Way",
    "find_stairs",
    "floor_view",
    "plan",
    "plan_footsteps",
]


def __dir__() -> list[str]:
    """Return what is public: for the tab key, without the modules that it is made of."""
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
