"""A walker of the user's own: what it is told, what it may tell, and what its answers must be."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from user_parts import Statue, Still

import treadwell
from treadwell._core import Command, Proprioception, Situation, Stepping
from treadwell.errors import CoreError, InputError
from treadwell.protocols import Decision, Footstep, JointTargets
from treadwell.robot.load import load_robot

QRIO = load_robot("qrio")
STEP = Footstep("left", 0.04, 0.042, 0.0, 0.0, -0.05, 0.05)


class Told:
    """A behaviour: decides what it was made with, one decision from each of these seconds on."""

    def __init__(self, **decisions: Decision) -> None:
        self.decisions = {float(key[1:]): value for key, value in decisions.items()}
        self.seen: list[Situation] = []

    def next(self, situation: Situation) -> Decision:
        self.seen.append(situation)
        begun = [s for s in self.decisions if s <= 1e-9 * situation.time_ns + 1e-6]
        return self.decisions[max(begun)]


def run(seconds: float, **parts: Any) -> treadwell.Episode:  # noqa: ANN401 - any part
    overrides = (f"time_limit={seconds}", "start.yaw=0.0")
    episode = treadwell.Episode("open_floor", seed=2, overrides=overrides, **parts)
    while episode.verdict is None:
        episode.tick()
    return episode


def test_a_walker_is_told_the_command_and_what_the_body_feels() -> None:
    part = Statue()
    walk = Decision("walk", velocity=(0.05, -0.02, 0.1), gaze=(0.3, 0.5))
    run(0.6, walker=part, behaviour=Told(s0=walk))
    command, felt = part.seen[-1]
    assert command.velocity == (0.05, -0.02, 0.1)
    assert (command.footsteps, command.gaze, command.arms_raised) == ([], (0.3, 0.5), False)
    assert felt.time_ns == 590_000_000
    assert felt.joint_names == list(QRIO.joints)
    assert felt.stand == pytest.approx(QRIO.stand)
    assert felt.joint_ranges.shape == (26, 2)
    assert (felt.joint_ranges[:, 0] < felt.joint_ranges[:, 1]).all()
    assert felt.joint_positions == pytest.approx(part.step(command, felt).position, abs=0.1)
    assert felt.joint_velocities.shape == (26,)
    assert felt.gravity == pytest.approx([0.0, 0.0, -1.0], abs=0.05)
    assert np.linalg.norm(felt.gravity) == pytest.approx(1.0)
    assert np.abs(felt.angular_velocity).max() < 0.5
    assert felt.foot_forces.shape == (2, 4)
    assert felt.foot_loads == pytest.approx(felt.foot_forces.sum(axis=1))
    assert felt.foot_loads.sum() == pytest.approx(7.0 * 9.81, rel=0.3)
    assert felt.contacts == (True, True)
    assert felt.support in {"left", "right"}
    down = felt.odometry_from_torso[:3, :3].T @ [0.0, 0.0, -1.0]
    assert felt.gravity == pytest.approx(down)
    assert np.abs(felt.odometry_from_robot[:3, 3]).max() < 0.02
    assert 0.2 < felt.odometry_from_torso[2, 3] < 0.5


def test_a_walkers_targets_are_those_of_the_motors_and_command_head_turns_the_head() -> None:
    class Odd(Statue):
        def step(self, command: Command, proprioception: Proprioception) -> JointTargets:
            made = super().step(command, proprioception)
            return JointTargets(made.position, np.full(26, 0.01), np.full(26, 0.02))

    look = Told(s0=Decision("look", gaze=(0.4, 0.5)))
    overrides = ("time_limit=1", "start.yaw=0.0")
    episode = treadwell.Episode("open_floor", overrides=overrides, walker=Odd(), behaviour=look)
    while episode.verdict is None:
        step = episode.tick()
    legs = [i for i, name in enumerate(QRIO.joints) if not name.startswith("neck")]
    assert step.command.position[legs] == pytest.approx(QRIO.stand[legs])
    assert (step.command.velocity == 0.01).all()
    assert (step.command.torque == 0.02).all()
    assert episode.pilot.gaze == pytest.approx((0.4, 0.5))
    ahead = episode.pilot.robot_from_camera()[:3, 2]
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(0.4, abs=0.05)


def test_a_walker_that_does_not_say_so_stands_when_its_feet_have_rested_for_a_step() -> None:
    walk = Decision("walk", velocity=(0.05, 0.0, 0.0))
    behaviour = Told(s0=Decision("stand"), s1=walk, s1_5=walk, s2=Decision("stand"))
    episode = run(4.0, walker=Statue(), behaviour=behaviour)
    stood = {round(1e-9 * s.time_ns, 2): s.standing for s in behaviour.seen}
    assert all(stood[0.01 * i] for i in range(5))
    assert not any(stood[t] for t in (1.1, 1.5, 2.0, 2.1))
    settled = min(t for t, stands in stood.items() if t > 2.0 and stands)
    assert settled - 2.0 == pytest.approx(QRIO.file.gait.get("step_time", 0.6), abs=0.03)
    assert episode.pilot.steps_taken == 0
    assert not any(s.takes_footsteps for s in behaviour.seen)


class Teller(Statue):
    """A walker that tells of itself what it does not do."""

    def standing(self) -> bool:
        return False

    def steps_taken(self) -> int:
        return 7

    def stepping(self) -> Stepping:
        return Stepping(2, 0.003, stumbled=True, misstep="obstructed")


def test_what_a_walker_tells_of_itself_is_what_the_behaviour_is_told() -> None:
    part, behaviour = Teller(), Told(s0=Decision("step", footsteps=(STEP,)))
    episode = run(0.1, walker=part, behaviour=behaviour)
    last = behaviour.seen[-1]
    assert (last.standing, last.takes_footsteps) == (False, True)
    stepping = last.stepping
    assert (stepping.landed, stepping.height_error) == (2, 0.003)
    assert (stepping.stumbled, stepping.misstep) == (True, "obstructed")
    assert episode.pilot.steps_taken == 7
    command = part.seen[-1][0]
    assert (command.velocity, command.footsteps) == (None, [(*STEP,)])


def test_footsteps_for_a_walker_that_takes_none_end_in_a_refusal_that_says_so() -> None:
    part, behaviour = Statue(), Told(s0=Decision("step", footsteps=(STEP,)))
    episode = run(2.0, walker=part, behaviour=behaviour)
    assert episode.verdict is not None
    assert episode.verdict.outcome == "refused"
    assert episode.verdict.reason == (
        "walker: the way needs footsteps one by one, and this walker takes velocities alone"
    )
    assert all(command.footsteps == [] for command, _ in part.seen)


def test_the_cores_own_walker_takes_footsteps() -> None:
    behaviour = Still()
    run(0.05, behaviour=behaviour)
    assert behaviour.seen[-1].takes_footsteps


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"position": np.zeros(25)}, "position must have 26 values, one a joint, got 25"),
        ({"position": np.zeros(26, np.float32)}, "position must be an array with 1 axis of float"),
        ({"position": np.zeros((26, 1))}, "position must be an array with 1 axis"),
        ({"velocity": np.full(26, np.nan)}, "velocity must be finite and within 1000, got NaN"),
        ({"torque": np.full(26, 1e9)}, "torque must be finite and within 1000"),
        ({"torque": None}, "torque must be an array with 1 axis of float64, got None"),
    ],
)
def test_targets_that_cannot_be_end_the_episode_with_the_walkers_name(
    changes: dict[str, Any], message: str
) -> None:
    class Wild(Statue):
        def step(self, *_: object) -> Any:  # noqa: ANN401 - whatever it is
            still = np.zeros(26)
            return JointTargets(**{"position": still, "velocity": still, "torque": still} | changes)

    with pytest.raises(CoreError, match=f"walker: Wild: .*{message}"):
        run(0.1, walker=Wild())


@pytest.mark.parametrize(
    ("method", "answer", "message"),
    [
        ("standing", None, r"standing\(\) must return a bool, got None"),
        ("steps_taken", -1, r"steps_taken\(\) must return a count, got -1"),
        ("stepping", {}, r"stepping\(\) must return a Stepping, got {}"),
    ],
)
def test_what_a_walker_tells_that_makes_no_sense_ends_the_episode(
    method: str, answer: object, message: str
) -> None:
    part = type("Vague", (Statue,), {method: lambda _: answer})()
    with pytest.raises(CoreError, match=f"walker: Vague: .*{message}"):
        run(0.1, walker=part)


@pytest.mark.parametrize(
    "misstep", [None, "no_ground", "obstructed", "left_leg_buckled", "right_leg_buckled"]
)
def test_a_walker_of_the_users_tells_how_a_step_was_taken_back(misstep: str | None) -> None:
    assert Stepping(1, misstep=misstep).misstep == misstep


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            {"misstep": "slipped"},
            "misstep must be no_ground, .*right_leg_buckled or None, got slipped",
        ),
        ({"height_error": np.nan}, "height_error must be finite"),
    ],
)
def test_stepping_that_cannot_be_is_not_made(words: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Stepping(**words)


def test_a_run_by_a_walker_of_ones_own_is_kept_as_any_other(tmp_path: Path) -> None:
    overrides = ("time_limit=2", "start.yaw=0.0")
    out = tmp_path / "run"
    done = treadwell.run("open_floor", overrides=overrides, walker=Statue(), out=out)
    assert done.outcome == "timed_out"
    assert done.result.falls == 0
    again = treadwell.replay(out, walker=Statue(), out=tmp_path / "again")
    assert again.result.steps_taken == done.result.steps_taken == 0
    with pytest.raises(InputError, match=r"treadwell.replay\(walker=...\)"):
        treadwell.replay(out, out=tmp_path / "without")


def test_steps_that_a_walker_does_not_count_are_counted_by_the_feet(tmp_path: Path) -> None:
    """The loads of a walk by the core's own walker, given to one that says nothing of its gait."""
    overrides, out = ("time_limit=6", "start.yaw=0.0"), tmp_path / "walked"

    def stroll() -> Told:
        return Told(s0=Decision("stand"), s1=Decision("walk", velocity=(0.08, 0.0, 0.1)))

    walked = treadwell.run("open_floor", seed=2, overrides=overrides, behaviour=stroll(), out=out)
    felt = treadwell.replay(out, walker=Statue(), behaviour=stroll(), out=tmp_path / "felt")
    assert walked.result.steps_taken > 5
    assert abs(felt.result.steps_taken - walked.result.steps_taken) <= 1  # one may be in the air


def test_the_walkers_parameters_are_the_robots() -> None:
    with pytest.raises(InputError, match=r"navigation\.dcm: unknown key"):
        treadwell.Episode("open_floor", overrides=("navigation.dcm.step_time=1.0",))
    with pytest.raises(InputError, match=r"navigation\.walker: .*must be dcm or"):
        treadwell.Episode("open_floor", overrides=("navigation.walker=zmp",))
