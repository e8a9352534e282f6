"""What a part of the user's is told before the first tick, and what it may ask for."""

import numpy as np
import pytest
from user_parts import Legs, Straight

import treadwell
from treadwell._core import BodyState, FloorView, Goal, Planes, Scan, Staircase
from treadwell.errors import InputError
from treadwell.protocols import Plan, Pose, Setup

MAPPED = "navigation.static_map.resolution=0.05"


class FromTheStart(Legs):
    """Leg odometry from where the robot starts; it reads the pictures, too."""

    def __init__(self) -> None:
        super().__init__()
        self.setups: list[Setup] = []
        self.scans: list[Scan] = []

    def begin(self, setup: Setup) -> None:
        self.setups.append(setup)

    def see(self, scan: Scan) -> None:
        assert self.corrections == len(self.scans)
        self.scans.append(scan)

    def estimate(self, body: BodyState) -> Pose:
        moved_x, moved_y, moved_z, turned = super().estimate(body)
        start = self.setups[-1].start
        assert start is not None
        x, y, z, yaw = start
        return (
            x + np.cos(yaw) * moved_x - np.sin(yaw) * moved_y,
            y + np.sin(yaw) * moved_x + np.cos(yaw) * moved_y,
            z + moved_z,
            yaw + turned,
        )


def episode(overrides: tuple[str, ...], **parts: object) -> treadwell.Episode:
    made = treadwell.Episode("slalom", seed=2, overrides=("time_limit=1.2", *overrides), **parts)
    for _ in made:
        pass
    return made


def test_a_localizer_is_told_the_start_and_reads_each_frame() -> None:
    part = FromTheStart()
    start = ("start.position=[0.3, 0.2]", "start.yaw=0.5")
    made = episode((*start, MAPPED), localizer=part)
    (setup,) = part.setups
    assert setup.start == pytest.approx((0.3, 0.2, 0.0, 0.5))
    assert [goal.position for goal in setup.goals] == [pytest.approx((2.8, 0.0))]
    assert setup.robot["body"]["radius"] == pytest.approx(0.12, abs=0.05)
    assert setup.static_map is not None
    assert len(part.scans) == part.corrections > 5
    scan = part.scans[-1]
    assert scan.disparity.shape == scan.depth.shape == (scan.height, scan.width) == (72, 88)
    assert scan.points_in_camera.shape == (72, 88, 3)
    assert (scan.fx, scan.fy, scan.cx, scan.cy) == pytest.approx((101.2, 101.2, 43.5, 35.5), 0.02)
    told = treadwell.Episode("slalom", seed=2, overrides=("time_limit=1.2", *start))
    for _ in told:
        pass
    assert made.pilot.view().origin == told.pilot.view().origin


def test_who_has_to_find_out_is_told_no_start_and_without_a_map_none() -> None:
    class Lost(FromTheStart):
        def estimate(self, body: BodyState) -> Pose:
            return Legs.estimate(self, body)

    part = Lost()
    episode(("start.known=false",), localizer=part)
    assert part.setups[0].start is None
    assert part.setups[0].static_map is None


def test_an_exception_before_the_first_tick_is_bad_input_with_the_parts_name() -> None:
    class Broken(Straight):
        def begin(self, setup: Setup) -> None:
            raise ValueError(f"no {len(setup.goals)}")

    with pytest.raises(InputError, match=r"navigation\.planner: Broken\.begin: ValueError\('no 1'"):
        episode((), planner=Broken())


def test_a_planner_has_helpers_that_see_a_flat_top() -> None:
    class Asks:
        def plan(self, view: FloorView, _: Staircase, start: Pose, __: Goal) -> Plan:
            self.free = view.passable(start[2], 0.015, 0.12)
            self.room, self.kind = view.clearance(), view.kind
            return Plan(None, "only looking")

    part = Asks()
    episode((), planner=part)
    assert part.free.shape == part.kind.shape == part.room.shape
    assert not part.free[part.kind == 2].any()
    assert (part.room[part.kind == 2] == 0.0).all()
    assert part.free.any()


def test_planes_of_a_frame_reach_a_localizer_after_the_scan() -> None:
    order: list[str] = []

    class Orders(FromTheStart):
        def see(self, scan: Scan) -> None:
            super().see(scan)
            order.append("scan")

        def correct(self, body: BodyState, planes: Planes, view: FloorView) -> None:
            super().correct(body, planes, view)
            order.append("planes")

    episode((), localizer=Orders())
    assert order[:4] == ["scan", "planes", "scan", "planes"]
