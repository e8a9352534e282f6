"""A scenario as a Gymnasium environment: the agent takes the place of the behaviour."""

import math
from collections.abc import Mapping
from copy import deepcopy
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, Literal

import gymnasium
import numpy as np
from numpy.typing import NDArray

from treadwell.environment.actions import Actions, FootstepActions, VelocityActions
from treadwell.environment.commanded import LEVEL_M, Commanded, NoPlanner
from treadwell.environment.height_scan import HeightScan
from treadwell.environment.observations import Observed, observation_space, observed
from treadwell.environment.top_view import TopView
from treadwell.episode import Episode, Step
from treadwell.errors import CoreError, InputError, SimulationError
from treadwell.judging.verdict import Verdict
from treadwell.physics.simulation import TICK_NS
from treadwell.processor import likely_reason, processor
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import load_scenario
from treadwell.scenario.overrides import Overrides
from treadwell.scenario.scaling import to_robot

GOAL_REWARD: Final = 10.0
FALL_REWARD: Final = -10.0
COLLISION_REWARD: Final = -1.0


_ALIVE: Final = frozenset(
    {"_episode", "_view", "_step", "_behaviour", "_verdict", "_depth", "_actions"}
)
"""Attributes that hold physics, core, or what follows from them."""


class CourseEnv(gymnasium.Env[Observed, Any]):
    """One episode after the other on a scenario's course.

    The reward is the way (m) by which the robot came nearer to the goal, past the via points;
    `GOAL_REWARD`, `FALL_REWARD` and, for each new collision, `COLLISION_REWARD`. It and the end of
    an episode come from the judge, which knows the truth; observations have none of it. An episode
    is truncated when the scenario's time limit is over, terminated by any other verdict.

    It can be copied and pickled, amid an episode, too. Physics and core hold more than can be
    written down, so the copy does again what was done since `reset`: it takes as long as that did.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 12}  # noqa: RUF012 - as Env has it

    def __init__(
        self,
        scenario: str | Path = "obstacle_course",
        robot: str | Path | None = None,
        *,
        actions: Literal["velocity", "footsteps"] = "velocity",
        overrides: Overrides = (),
        height_scan: Mapping[str, float] | bool = False,
        render_mode: str | None = None,
        user_code: bool = True,
    ) -> None:
        """Build the scenario once, so that what is bad in it is told here.

        Args:
            scenario: a name or a path.
            robot: its name or folder, instead of the scenario's.
            actions: what the agent does.
            overrides: settings `KEY=VALUE`, as `--set` takes them, or a mapping of keys to values.
            height_scan: whether observations have the heights around the robot as it believes them;
                or `length`, `width`, `spacing` and `ahead` of their grid, m.
            render_mode: None, or `rgb_array`: the course from above.
            user_code: False: a scenario that names a Python class is refused.

        Raises:
            InputError: anything of it is bad.
        """
        if render_mode not in {None, *self.metadata["render_modes"]}:
            raise InputError(f"render_mode: found {render_mode!r}; must be 'rgb_array' or None")
        if actions not in {"velocity", "footsteps"}:
            raise InputError(f"actions: found {actions!r}; must be 'velocity' or 'footsteps'")
        self.render_mode = render_mode
        self._asked: dict[str, Any] = {"robot": robot, "overrides": deepcopy(overrides)}
        self._scenario = scenario
        self._kind = actions
        self._scan = HeightScan.read(height_scan)
        self._user_code = user_code
        self._episode: Episode | None = None
        self._view: TopView | None = None
        self._step: Step | None = None
        self._done: list[Any] | None = None
        self._begin(load_scenario(scenario, **self._asked).seed)
        assert self._episode is not None
        self.observation_space = observation_space(self._episode.robot, self._scan)
        self.action_space = self._actions.space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observed, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: of this environment's random numbers, of which each episode's seed is drawn.
            options: `scenario_seed` is the episode's own seed instead, that of `run --seed`.

        Raises:
            InputError: the course that was drawn cannot be built, or has a robot with other senses,
                or all is over before the first picture arrives.
        """
        super().reset(seed=seed)
        drawn = int(self.np_random.integers(2**31))
        self._begin(int((options or {}).get("scenario_seed", drawn)))
        assert self._episode is not None
        name = self._episode.scenario.name
        if observation_space(self._episode.robot, self._scan) != self.observation_space:
            self.close()
            raise InputError(f"{name}: [vary] draws a robot whose observations have another form")
        self._look()
        if self._verdict is not None:
            outcome = self._verdict.outcome
            self.close()
            raise InputError(f"{name}: is over before the first picture arrives: {outcome}")
        return self._observed(), self._info()

    def step(self, action: Any) -> tuple[Observed, float, bool, bool, dict[str, Any]]:  # noqa: ANN401
        """Do an action and return observation, reward, terminated, truncated and info.

        Raises:
            InputError: it is none of `action_space`, by its form or by what is no finite number;
                nothing was done.
        """
        episode = self._episode
        if episode is None or self._step is None or self._verdict is not None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        before, hits = self._to_go(), len(episode.judge.collisions)
        self._behaviour.decision = self._actions.decision(action)
        assert self._done is not None
        self._done.append(deepcopy(action))
        ticks, verdict = 0, None
        while verdict is None:
            verdict = self._tick()
            ticks += 1
            situation = self._behaviour.situation
            over = situation is not None and self._actions.is_over(ticks, situation)
            if over and not self._behaviour.arrived:  # after the arrival nothing can be done
                break
        reward = before - self._to_go()
        reward += COLLISION_REWARD * (len(episode.judge.collisions) - hits)
        outcome = None if verdict is None else verdict.outcome
        reward += {"goal_reached": GOAL_REWARD, "fell": FALL_REWARD}.get(outcome or "", 0.0)
        truncated = outcome == "timed_out"
        ended = outcome is not None and not truncated
        return self._observed(), float(reward), ended, truncated, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """Return the course from above, (h, w, 3); None without a render mode."""
        if self.render_mode is None or self._episode is None:
            return None
        if self._view is None:
            self._view = TopView(self._episode)
        picture = self._view.draw()
        if self._step is not None:
            self._view.mark(picture, self._step.estimate.pose[:2])
        return picture

    def close(self) -> None:
        """Let the physics and the core go."""
        self._episode = self._view = None
        self._step = self._done = None

    def __getstate__(self) -> dict[str, Any]:
        """Return all but what is alive, and what has to be done to have that again."""
        state = {key: value for key, value in self.__dict__.items() if key not in _ALIVE}
        return state | {"_was": None if self._episode is None else self._mark()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Do again what was done.

        Raises:
            SimulationError: it does not come out the same, as on another processor.
        """
        was, done = state.pop("_was"), state.pop("_done")
        self.__dict__.update(state)
        self._episode = self._view = None
        self._step = self._done = None
        if was is None:
            return
        self._begin(was["seed"])
        if done is not None:
            self._look()
            for action in done:
                self.step(action)
        if self._mark() | {"processor": ""} != was | {"processor": ""}:
            reason = likely_reason(was["processor"]) or "the scenario or its code changed"
            raise SimulationError(
                f"{self._scenario}: the copy of this environment does not come to the same state "
                f"after the same {len(done or [])} actions: {reason}"
            )

    def _mark(self) -> dict[str, Any]:
        """Return what tells an episode's state from another."""
        assert self._episode is not None
        made, step = self._episode.scenario, self._step
        where = None if step is None else (step.time_ns, step.estimate, self._episode.judge.frame)
        return {"seed": made.seed, "where": where, "processor": processor()}

    def _look(self) -> None:
        """Go on to the first picture."""
        self._done = []
        while self._step is None or self._depth is None:
            self._tick()

    def _begin(self, seed: int) -> None:
        self.close()  # where nothing can be built, the episode before does not go on
        made = load_scenario(self._scenario, seed=seed, **self._asked)
        if made.scale_to_robot:
            made = to_robot(made, load_robot(made.robot))
        self._behaviour = Commanded(made.goal.height)
        self._episode = Episode(
            made, user_code=self._user_code, behaviour=self._behaviour, planner=NoPlanner()
        )
        self._behaviour.level_m = LEVEL_M * self._episode.robot.scale
        self._verdict: Verdict | None = None
        self._depth: NDArray[np.float32] | None = None
        self._actions = self._make_actions(self._episode)

    def _make_actions(self, episode: Episode) -> Actions:
        file = episode.robot.file
        period_ticks = max(1, round(1e9 * file.camera.period / TICK_NS))
        if self._kind == "velocity":
            return VelocityActions(period_ticks, episode.robot.scale)
        left, right = episode.judge.truth.soles(episode.simulation.data)
        stance_m = math.dist((left.x, left.y), (right.x, right.y))
        soles = [leg.sole.length for leg in (file.legs.left, file.legs.right)]
        return FootstepActions(period_ticks, stance_m, min(soles), episode.robot.scale)

    def _tick(self) -> Verdict | None:
        """Go on by a control tick and return how it all ended, None while it goes on."""
        assert self._episode is not None
        try:
            self._step = self._episode.tick()
        except (CoreError, SimulationError) as error:
            if self._step is None or self._depth is None:
                raise
            self._verdict = Verdict("error", f"error: {error}")
            return self._verdict
        self._verdict = self._episode.verdict
        if self._step.observation.depth is not None:
            self._depth = self._step.observation.depth.depth
        elif self._verdict is not None and self._depth is None:
            height, width = self.observation_space["depth"].shape  # type: ignore[index]
            self._depth = np.full((height, width), np.nan, dtype=np.float32)
        return self._verdict

    def _to_go(self) -> float:
        """Return the true way to the goal past the via points that are left, m."""
        assert self._episode is not None
        goal, frame = self._episode.scenario.goal, self._episode.judge.frame
        places = (*goal.via, goal.position)
        left = places[min(self._episode.pilot.goals_passed, len(places) - 1) :]
        way = [(frame.x, frame.y), *left]
        return sum(math.dist(a, b) for a, b in pairwise(way))

    def _observed(self) -> Observed:
        assert self._episode is not None
        assert self._step is not None
        assert self._depth is not None
        pilot = self._episode.pilot
        seen = observed(self._step, self._depth, self._episode.goal, pilot.gaze)
        if self._scan is not None:
            seen |= self._scan.observed(pilot.view(), self._step.estimate.pose)
        return seen

    def _info(self) -> dict[str, Any]:
        assert self._step is not None
        assert self._episode is not None
        verdict = self._verdict
        return {
            "time": 1e-9 * self._step.time_ns,
            "scenario_seed": self._episode.scenario.seed,
            "state": self._step.state,
            "outcome": "" if verdict is None else verdict.outcome,
            "reason": "" if verdict is None else verdict.reason or "",
        }
