"""The core's parts on data of one's own, without an episode.

>>> import numpy as np
>>> from treadwell import mapping
>>> height = np.zeros((100, 250))                       # (rows along y, columns along x), metres
>>> height[:, 100:] = 0.04                              # a step
>>> plan = mapping.plan_footsteps(height, cell=0.01, start=(0.4, 0.5, 0.0), goal=(2.0, 0.5))
>>> for step in plan:
...     step.side, step.x, step.y, step.yaw, step.height
"""

from treadwell.footstep_plan import FootstepPlan, PlannedFootstep
from treadwell.mapping.footsteps import plan_footsteps

__all__ = ["FootstepPlan", "PlannedFootstep", "plan_footsteps"]
