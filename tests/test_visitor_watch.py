"""When the path leads around what was put in its way, frame by frame."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from episode_builders import qrio, trace, world

from treadwell.measuring.visitor_watch import SEEN_POINTS, Avoidance, VisitorWatch
from treadwell.measuring.watch import Watch
from treadwell.poses import pose_matrix

VISITOR = """
[[event]]
at = 1.0
do = "add"
element = { kind = "box", name = "visitor", position = [1.0, 0.0], size = [0.3, 0.3, 0.6] }
"""
WORLD = world(VISITOR)
THROUGH = np.array([[0.0, 0.0], [2.0, 0.0]])
CLOSE_BY = np.array([[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]])
AROUND = np.array([[0.0, 0.0], [0.7, 0.5], [1.3, 0.5], [2.0, 0.0]])

_watch: type[Watch] = VisitorWatch


class Scene:
    """Frames with a path, a number of points on the visitor, and ways planned so far."""

    def __init__(self) -> None:
        self.present: set[str] = set()
        self.pilot = SimpleNamespace(replans=3, planes=lambda: SimpleNamespace(exposure_ns=0))
        events = SimpleNamespace(present=self.present, place=lambda *_: np.zeros(3))
        episode: Any = SimpleNamespace(
            course=WORLD.course,
            simulation=WORLD.simulation,
            robot=qrio(),
            events=events,
            pilot=self.pilot,
        )
        self.watch = VisitorWatch(episode)
        self.frames = 0

    def see(self, path: np.ndarray, points: int = 0, *, replanned: bool = False) -> None:
        """Take in the next frame, 0.2 s later, of a picture that was taken 50 ms before."""
        self.frames += 1
        time_ns = 200_000_000 * self.frames
        self.pilot.planes = lambda: SimpleNamespace(exposure_ns=time_ns - 50_000_000)
        self.pilot.replans += replanned
        # What the robot has in its map is 0.5 m beside where it truly is.
        cloud = np.full((SEEN_POINTS + 1, 3), [5.0, 0.0, 0.3], dtype=np.float32)
        cloud[:points] = [0.86, 0.5, 0.3]
        beside = pose_matrix(0.0, 0.5, 0.0, 0.0)
        truth = pose_matrix(0.0, 0.0, 0.0, 0.0)
        self.watch.frame(
            trace(
                WORLD,
                time_ns,
                path=path + np.array([0.0, 0.5]) if len(path) else path,
                points_in_robot=cloud - np.float32([0.0, 0.5, 0.0]),
                map_from_robot=beside,
                truth_from_robot=truth,
            )
        )


def test_the_new_way_is_timed_from_the_picture_that_has_the_visitor_first() -> None:
    scene = Scene()
    scene.see(THROUGH, SEEN_POINTS)
    scene.present.add("visitor")
    scene.see(THROUGH, SEEN_POINTS - 1)
    scene.see(THROUGH, SEEN_POINTS)
    scene.see(CLOSE_BY, SEEN_POINTS, replanned=True)
    scene.see(np.empty((0, 2)))
    scene.see(AROUND, replanned=True)
    scene.see(THROUGH)
    found = scene.watch.findings()
    assert found.seen is not None
    assert round(found.seen, 6) == 0.55
    assert round(found.delay() or 0.0, 6) == 0.25
    assert round(found.delay_around() or 0.0, 6) == 0.65


def test_nothing_is_timed_where_the_way_was_free_or_the_visitor_never_seen() -> None:
    free, unseen = Scene(), Scene()
    free.see(AROUND)
    unseen.see(THROUGH)
    for scene in (free, unseen):
        scene.present.add("visitor")
    free.see(AROUND, SEEN_POINTS)
    unseen.see(AROUND, replanned=True)
    assert free.watch.findings().blocked is None
    assert free.watch.findings().delay() is None
    assert unseen.watch.findings().seen is None
    assert unseen.watch.findings().delay() is None


def test_one_that_is_seen_coming_counts_from_when_it_stands_in_the_way() -> None:
    scene = Scene()
    scene.see(AROUND)
    scene.present.add("visitor")
    scene.see(AROUND, SEEN_POINTS, replanned=True)
    scene.see(THROUGH, SEEN_POINTS)
    scene.see(AROUND, SEEN_POINTS, replanned=True)
    found = scene.watch.findings()
    assert found.blocked is not None
    assert round(found.blocked, 6) == 0.6
    assert round(found.delay() or 0.0, 6) == 0.2
    assert found.delay_around() == found.delay()


def test_a_course_without_a_visitor_has_none() -> None:
    episode: Any = SimpleNamespace(course=world().course, robot=qrio())
    watch = VisitorWatch(episode)
    watch.frame(trace(WORLD, 0))
    assert watch.findings() == Avoidance(None, None, None, None)
