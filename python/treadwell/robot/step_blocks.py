"""Two steps as blocks beside a posed robot: does anything but a foot touch them?"""

import mujoco
import numpy as np

from treadwell.robot.load import Robot

TREAD_M = 0.12
"""Depth of the steps that a robot as large as `qrio` tries: one foot is as far ahead."""
GAP_M = 0.015
"""How far its toes are from the riser ahead, and going down its heels from the one behind."""
HALF_M = 0.5
"""Half of a block's size: larger than a step, since only its edge counts."""
NAMES = ("lower step", "upper step")


def add_steps(spec: mujoco.MjSpec) -> list[str]:
    """Add the blocks to a specification; return the names of their geoms."""
    for name in NAMES:
        body = spec.worldbody.add_body(name=name, mocap=True)
        size = [HALF_M, HALF_M, HALF_M]
        kind = mujoco.mjtGeom.mjGEOM_BOX
        body.add_geom(name=name, type=kind, size=size, contype=0, conaffinity=0)
    return list(NAMES)


class Steps:
    """The blocks in a compiled model."""

    def __init__(self, model: mujoco.MjModel, robot: Robot, names: list[str]) -> None:
        """Find the blocks, and what of the robot may touch them."""
        self._model = model
        self._blocks = [model.geom(name).id for name in names]
        self._mocaps = [int(model.body_mocapid[model.geom_bodyid[block]]) for block in self._blocks]
        self._tread_m, self._gap_m = TREAD_M * robot.scale, GAP_M * robot.scale
        self._half_sole_m = 0.5 * robot.file.legs.left.sole.length
        feet = [
            model.body(leg.sole.link).id for leg in (robot.file.legs.left, robot.file.legs.right)
        ]
        links = model.body_rootid == model.body(robot.root).id
        links[feet] = False
        solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        self._shapes = [int(g) for g in np.flatnonzero(solid & links[model.geom_bodyid])]

    def place(self, data: mujoco.MjData, height_m: float) -> None:
        """Put the blocks where a step of this height is, the foot behind at x = 0.

        Up, there are the step and the next one; down, there is the one that is left.
        """
        if height_m > 0.0:
            edge = self._half_sole_m + self._gap_m
            places = [(edge, height_m), (edge + self._tread_m, 2.0 * height_m)]
        else:
            edge = self._tread_m - self._half_sole_m - self._gap_m
            places = [(edge - 2.0 * HALF_M, 0.0), (edge - 2.0 * HALF_M, -1.0)]
        for mocap, (x, top) in zip(self._mocaps, places, strict=True):
            data.mocap_pos[mocap] = (x + HALF_M, 0.0, top - HALF_M)

    def touched(self, data: mujoco.MjData) -> str | None:
        """Return a link that is inside a block, None where there is none.

        Args:
            data: its kinematics up to date.
        """
        model, line = self._model, np.zeros(6)
        for block in self._blocks:
            for shape in self._shapes:
                if mujoco.mj_geomDistance(model, data, shape, block, 0.01, line) < 0.0:
                    return str(model.body(int(model.geom_bodyid[shape])).name)
        return None
