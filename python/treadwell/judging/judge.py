"""The judge: watches the truth at every tick for falls, collisions, arrival, and being stuck."""

import math

import mujoco

from treadwell.course.course import Course
from treadwell.judging.contacts import Collision, Contacts, Touch
from treadwell.judging.ground_truth import GroundFrame, GroundTruth
from treadwell.judging.level_changes import LevelChanges
from treadwell.robot.load import Robot
from treadwell.scenario.model import Scenario
from treadwell.scenario.scaling import size_of
from treadwell.trace import Sole

FALLEN_TILT = 0.8
"""Rad by which the torso may lean."""
UPRIGHT_SECONDS = 1.0
"""For so long nothing of a fall must be seen before another one can count."""
STILL_SECONDS = 1.0
"""For so long both soles must carry and lie where they are for the robot to stand still."""
STILL_DRIFT = 0.01
"""Metres by which a sole of a robot of scale 1 may drift while the robot stands still."""
STILL_TURN = 0.05
"""Rad by which it may turn meanwhile."""
GOAL_HEIGHT_TOLERANCE = 0.02
"""Metres that each sole may be off the goal's height, on a course of scale 1."""
STUCK_SECONDS = 30.0
"""Of a robot of scale 1; a larger one, which takes longer for all it does, has longer."""
STUCK_RADIUS = 0.1
"""Metres: a robot of scale 1 that does not leave a disc of this radius for so long is stuck."""
STUCK_TURN = 0.5
"""Rad: one that has turned by this meanwhile looks around, and is not stuck."""
PATH_SPACING = 0.03
"""Metres between the points of which the path's length is made; sways smaller than it vanish, of a
robot of scale 1."""


class Judge:
    """Keeps what the truth says of an episode. Nothing of it may enter the core.

    Attributes:
        truth: reads poses from MuJoCo's data.
        falls: how often the robot fell.
        fall: what the last fall was, one sentence, or None.
        frame: the true robot frame at the last look.
        observed: the same at the look before, when the senses saw what the core was told last: what
            it then believed is held against this. Of the first look, that one's.
        soles: the true soles at the last look.
        touch: which soles stood on a floor at the last look.
        path_length: m, of the true robot frame's way seen from above.
    """

    def __init__(
        self, model: mujoco.MjModel, course: Course, scenario: Scenario, robot: Robot
    ) -> None:
        """Look names up once.

        Args:
            model: the compiled course with the robot in it.
            course: what stands where.
            scenario: for its goal.
            robot: the robot.
        """
        self.truth = GroundTruth(model, robot)
        self._contacts = Contacts(model, course, robot, self.truth.sole_bodies)
        self._goal = scenario.goal
        size = size_of(robot)
        self._drift = STILL_DRIFT * size.length
        self._goal_rise = GOAL_HEIGHT_TOLERANCE * course.scale
        self._spacing, self._stuck_radius = PATH_SPACING * size.length, STUCK_RADIUS * size.length
        self._stuck_seconds = STUCK_SECONDS * size.patience
        self._levels = LevelChanges(course.height_at, course.scale)
        self.falls = 0
        self.fall: str | None = None
        self._last_fallen = -math.inf
        self.path_length = 0.0
        self._time = 0.0
        self._still: tuple[float, tuple[Sole, Sole], float] | None = None
        self._place: tuple[float, GroundFrame] | None = None
        self._path_point: tuple[float, float] | None = None
        self.frame = self.observed = GroundFrame(0.0, 0.0, 0.0, 0.0)
        self._looked = False
        self.soles: tuple[Sole, Sole] | None = None
        self.touch = Touch(False, False, None)

    def watch(self, data: mujoco.MjData, time_s: float) -> None:
        """Look at the state after a tick.

        Args:
            data: positions, link poses and contacts up to date.
            time_s: simulated time, s.
        """
        still = self.still_seconds
        interval, self._time = max(0.0, time_s - self._time), time_s
        touch = self.touch = self._contacts.look(data, time_s, interval, still)
        on_left, on_right, fallen_part = touch
        soles, tilt = self.truth.look(data)
        self.soles = soles
        frame = self.truth.frame(soles, (on_left, on_right))
        self.observed = self.frame if self._looked else frame
        self.frame, self._looked = frame, True
        upright = tilt <= FALLEN_TILT and fallen_part is None
        if not upright:
            self._note_fall(tilt, time_s, fallen_part)
        if on_left and on_right:
            self._watch_stillness(time_s, soles, frame)
        else:
            self._still = None
        self._watch_progress(time_s, frame)
        left_foot, right_foot = self._levels.feet
        left_foot.look(*soles[0][:3], touching=on_left)
        right_foot.look(*soles[1][:3], touching=on_right)

    def begin_elsewhere(self) -> None:
        """Go on after the robot was carried: what lies between it neither walked nor climbed."""
        self._path_point = None
        for foot in self._levels.feet:
            foot.begin_elsewhere()

    @property
    def fallen(self) -> bool:
        """Whether the robot lies or topples now."""
        return self._last_fallen == self._time

    @property
    def collisions(self) -> list[Collision]:
        """The collisions so far."""
        return self._contacts.collisions()

    @property
    def stairs_climbed(self) -> int:
        """Changes of level upwards that both feet have made or passed."""
        return self._levels.climbed

    @property
    def stairs_descended(self) -> int:
        """Changes of level downwards that both feet have made or passed."""
        return self._levels.descended

    @property
    def still_seconds(self) -> float:
        """For how long the robot has been standing still on both soles, s."""
        return 0.0 if self._still is None else self._time - self._still[0]

    @property
    def standing_still(self) -> bool:
        """Whether the robot has stood still on both soles for a second."""
        return self.still_seconds >= STILL_SECONDS - 1e-9

    @property
    def stuck(self) -> bool:
        """Whether the robot has not come away from its place for a long time."""
        return self._place is not None and self._time - self._place[0] > self._stuck_seconds

    @property
    def distance_to_goal(self) -> float:
        """Distance of the true robot frame from the goal's centre, m."""
        return math.dist((self.frame.x, self.frame.y), self._goal.position)

    def goal_reached(self, data: mujoco.MjData) -> bool:
        """Say whether the robot, which declares to have arrived, has, and stands still there.

        Args:
            data: the same that was watched last.
        """
        soles = self.truth.soles(data)
        height = self._goal.height
        level = height is None or all(abs(sole.z - height) <= self._goal_rise for sole in soles)
        inside = self.distance_to_goal <= self._goal.radius
        return inside and level and self.standing_still and not self.fallen

    def _note_fall(self, tilt: float, time: float, fallen_part: str | None) -> None:
        if time - self._last_fallen > UPRIGHT_SECONDS:
            self.falls += 1
            self.fall = (
                f"the torso leaned by {tilt:.2f} rad at {time:.2f} s"
                if fallen_part is None
                else f"{fallen_part} touched the floor at {time:.2f} s"
            )
        self._last_fallen = time

    def _watch_stillness(self, time: float, soles: tuple[Sole, Sole], frame: GroundFrame) -> None:
        """Look at a robot that stands on both soles."""
        if self._still is not None:
            _, (left, right), yaw = self._still
            if (
                math.dist(left[:3], soles[0][:3]) <= self._drift
                and math.dist(right[:3], soles[1][:3]) <= self._drift
                and abs(math.remainder(frame[3] - yaw, math.tau)) <= STILL_TURN
            ):
                return
        self._still = (time, soles, frame.yaw)

    def _watch_progress(self, time: float, frame: GroundFrame) -> None:
        here = frame[:2]
        if self._place is None or _has_moved(self._place[1], frame, self._stuck_radius):
            self._place = (time, frame)
        if self._path_point is None:
            self._path_point = here
        else:
            step = math.dist(here, self._path_point)
            if step >= self._spacing:
                self.path_length += step
                self._path_point = here


def _has_moved(before: GroundFrame, now: GroundFrame, radius: float) -> bool:
    """Say whether the robot has come away from its place, or turned to look around."""
    if math.dist(before[:2], now[:2]) > radius:
        return True
    return abs(math.remainder(now[3] - before[3], math.tau)) > STUCK_TURN
