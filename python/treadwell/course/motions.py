"""What events set in motion: elements that go somewhere, people who walk, doors that turn."""

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from treadwell.course.course import CourseElement
from treadwell.course.outlines import Floats
from treadwell.physics.parts import TICK_SECONDS
from treadwell.scenario.events import Move

DOOR_SECONDS: Final = 1.0
"""How long a door takes to where it is set."""
ROOM: Final = 0.15
"""Metres that who gives way leaves between itself and the robot, on a course of scale 1."""
PATIENCE: Final = 3.0
"""Seconds that who gives way waits before it turns back."""


@dataclass
class Motion:
    """An element on its way along the points of a `move`.

    Attributes:
        element: what moves.
        move: the event.
        room: metres that it leaves between itself and the robot, where it gives way.
        reach: radius of its outline about its reference point, metres.
        next: index of the point that it goes to.
        back: whether it goes along its path the other way.
        waited: seconds that it has stood before the robot.
    """

    element: CourseElement
    move: Move
    room: float = ROOM
    reach: float = field(init=False)
    next: int = 0
    back: bool = False
    waited: float = 0.0

    def __post_init__(self) -> None:
        """Measure the element."""
        corners = [piece.vertices[:, :2] - self.element.origin[:2] for piece in self.element.pieces]
        self.reach = max((float(np.hypot(*each.T).max()) for each in corners), default=0.0)

    def advance(self, place: Floats, robot: Floats, radius: float) -> bool:
        """Go on by one control tick; return whether it has arrived for good.

        Args:
            place: (3,) of its row of `mocap_pos`, changed in place.
            robot: (2,) where the robot is, world.
            radius: of the robot, metres.
        """
        way = self.move.way()
        stride = self.move.speed * TICK_SECONDS
        # In one tick it may pass several points, each but once.
        for _ in range(len(way)):
            target = np.array(way[self.next])
            ahead = target - place[:2]
            distance = float(np.hypot(*ahead))
            if self._waits(place, ahead, robot, radius):
                return False
            if distance > stride:
                place[:2] += ahead * (stride / distance)
                return False
            place[:2] = target
            stride -= distance
            if not self._go_on(len(way)):
                return True
        return False

    def _go_on(self, count: int) -> bool:
        """Aim at the next point; return False where there is none."""
        step = -1 if self.back else 1
        self.next += step
        if self.move.loop:
            self.next %= count
        return 0 <= self.next < count

    def _waits(self, place: Floats, ahead: Floats, robot: Floats, radius: float) -> bool:
        """Say whether it stands still for the robot; turn it back where it has done so for long."""
        if not self.move.gives_way:
            return False
        towards = robot - place[:2]
        close = math.hypot(*towards) < self.reach + radius + self.room
        if not close or float(towards @ ahead) <= 0.0:
            self.waited = 0.0
            return False
        self.waited += TICK_SECONDS
        if self.waited > PATIENCE and len(self.move.way()) > 1:
            self.waited = 0.0
            self.back = not self.back
            self.next += -1 if self.back else 1
            count = len(self.move.way())
            self.next = self.next % count if self.move.loop else min(max(self.next, 0), count - 1)
        return True


@dataclass
class Swing:
    """A leaf on its way to where a door is set.

    Attributes:
        element: the leaf.
        begin: how far open it was, 0 to 1.
        end: how far open it will be.
        ticks: control ticks since it began.
    """

    element: CourseElement
    begin: float
    end: float
    ticks: int = 0

    def advance(self) -> float:
        """Go on by one control tick; return how far open it is then."""
        self.ticks += 1
        share = min(self.ticks * TICK_SECONDS / DOOR_SECONDS, 1.0)
        return self.begin + share * (self.end - self.begin)

    @property
    def is_over(self) -> bool:
        """Whether it is where it was to be."""
        return self.ticks * TICK_SECONDS >= DOOR_SECONDS - 1e-9
