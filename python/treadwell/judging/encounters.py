"""How the robot and something that moves met: who stood, and who moved into whom."""

from typing import NamedTuple

import mujoco
import numpy as np

STANDING_SECONDS = 0.5
"""For so long the robot has stood on both soles, unmoved, of which is said that it stood."""


class Encounter(NamedTuple):
    """A touch of something that moves, as it began.

    Attributes:
        standing: whether the robot stood: for `STANDING_SECONDS` on both soles, and none moved.
        robot_speed: m/s at which the touched point of the robot moved towards the element.
        element_speed: m/s at which the touched point of the element moved towards the robot.
    """

    standing: bool
    robot_speed: float
    element_speed: float


class Encounters:
    """Tells how things that events move met the robot."""

    def __init__(self, model: mujoco.MjModel) -> None:
        """Note what can be moved.

        Args:
            model: the compiled course with the robot in it.
        """
        self._model = model
        self._mocap = np.asarray(model.body_mocapid)[np.asarray(model.geom_bodyid)].tolist()
        self._places = np.zeros((0, 3))
        self._turns = np.zeros((0, 4))

    def note(self, data: mujoco.MjData) -> None:
        """Keep where everything is that can be moved, for the next look."""
        if self._model.nmocap:
            self._places, self._turns = data.mocap_pos.copy(), data.mocap_quat.copy()

    def at(
        self, data: mujoco.MjData, contact: int, geom: int, interval: float, still: float
    ) -> Encounter | None:
        """Return how the robot met a geom, None where that has not moved since the last look.

        Args:
            data: contacts and velocities up to date.
            contact: index of the contact.
            geom: the one of it that is not the robot's.
            interval: s since the last look.
            still: s for which the robot had stood on both soles at the last look.
        """
        moved = self._mocap[geom]
        if moved < 0 or moved >= len(self._places) or interval <= 0.0:
            return None
        place, turn = data.mocap_pos[moved], data.mocap_quat[moved]
        before, turned = self._places[moved], self._turns[moved]
        if (place == before).all() and (turn == turned).all():
            return None
        found = data.contact[contact]
        point = np.array(found.pos)
        # From the robot to the element: MuJoCo's normal leads from the first geom to the second.
        first, second = (int(one) for one in found.geom)
        ahead = np.array(found.frame[:3]) * (1.0 if second == geom else -1.0)
        back, at, was = np.zeros(4), np.zeros(3), np.zeros(3)
        mujoco.mju_negQuat(back, turn)
        mujoco.mju_rotVecQuat(at, point - place, back)
        mujoco.mju_rotVecQuat(was, at, turned)
        element = (point - (before + was)) / interval
        velocity = np.zeros(6)
        mine = int(self._model.geom_bodyid[first if second == geom else second])
        mujoco.mj_objectVelocity(self._model, data, mujoco.mjtObj.mjOBJ_BODY, mine, velocity, 0)
        arm = point - data.xpos[mine]
        robot = velocity[3:] + np.cross(velocity[:3], arm)
        return Encounter(
            still >= STANDING_SECONDS - 1e-9, float(robot @ ahead), float(-element @ ahead)
        )
