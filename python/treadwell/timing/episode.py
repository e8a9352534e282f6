"""How long an episode takes, as a ratio to physics that never change: see `benches/frozen`."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from time import process_time
from typing import Any, Final

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray

from treadwell.episode import Episode
from treadwell.errors import InputError, TreadwellError
from treadwell.physics.audit import STATE
from treadwell.recording.scores import Scores

FROZEN: Final = Path(__file__).resolve().parent / "frozen" / "slalom.npz"
TORQUE_UNIT: Final = 2.0**-10
"""N·m that 1 in the file stands for."""
BEGIN: Final = 15.0
SECONDS: Final = 10.0
"""When the timing begins, and for how long, in simulated seconds: the robot walks by then."""
_ROUNDS: Final = 3
"""The reference counts with the least of so many times: what else the machine does is not its."""


@dataclass(frozen=True, eq=False)
class Frozen:
    """The reference's physics.

    Attributes:
        model: as it was.
        start: its state at the beginning.
        torques: (steps, nu) N·m.
        end: (nq,) positions after the last step.
    """

    model: mujoco.MjModel
    start: NDArray[np.float64]
    torques: NDArray[np.float64]
    end: NDArray[np.float64]


@cache
def frozen(path: Path = FROZEN) -> Frozen:
    """Read the reference.

    Raises:
        TreadwellError: this version of MuJoCo does not read it.
    """
    with np.load(path) as file:
        arrays = dict(file)
    try:
        model = mujoco.MjModel.from_binary_path(
            "model.mjb", {"model.mjb": arrays["model"].tobytes()}
        )
    except ValueError as error:
        raise TreadwellError(
            f"{path.name}: MuJoCo {mujoco.__version__} does not read the frozen model; "
            "a new one has to be made, see benches/frozen/README.md"
        ) from error
    return Frozen(model, arrays["state0"], TORQUE_UNIT * arrays["ctrl"], arrays["qpos"])


def stepped(reference: Frozen) -> tuple[float, NDArray[np.float64]]:
    """Step the reference's ten seconds in C, once.

    Returns:
        Seconds of the processor's time, and the positions (nq,) at the end.
    """
    model, physics = reference.model, mujoco.mjtState.mjSTATE_FULLPHYSICS
    data = mujoco.MjData(model)
    mujoco.mj_setState(model, data, reference.start, STATE)
    state = np.empty(mujoco.mj_stateSize(model, physics))
    mujoco.mj_getState(model, data, state, physics)
    begin = process_time()
    states, _ = rollout.rollout(
        model, data, state, reference.torques, initial_warmstart=data.qacc_warmstart.copy()
    )
    seconds = process_time() - begin
    return seconds, states[0, -1, 1 : 1 + model.nq]


def frozen_ms(rounds: int = _ROUNDS) -> float:
    """Return the processor's time for a simulated second of the reference, ms."""
    return 1e3 / SECONDS * min(stepped(frozen())[0] for _ in range(rounds))


def episode(scenario: str = "slalom", seed: int = 0) -> dict[str, Any]:
    """Time ten seconds of an episode without recording, and the reference beside it.

    Args:
        scenario: which.
        seed: of its draws.

    Raises:
        InputError: it ends earlier.
    """
    running = Episode(scenario, seed=seed)
    _go_on(running, BEGIN)
    before = frozen_ms()
    begin = process_time()
    _go_on(running, BEGIN + SECONDS)
    own = 1e3 / SECONDS * (process_time() - begin)
    reference = (before + frozen_ms()) / 2
    return {
        "scenario": scenario,
        "seed": seed,
        "simulated_seconds": SECONDS,
        "ms_a_simulated_second": round(own, 3),
        "frozen_ms": round(reference, 3),
        "ratio": round(own / reference, 3),
        "times_real_time": round(1e3 / own, 2),
    }


def _go_on(running: Episode, until: float) -> None:
    """Play an episode up to a simulated time, s, with all that a run without recording does."""
    scores = Scores(running)
    while running.simulation.time_ns < until * 1e9:
        if running.verdict is not None:
            raise InputError(f"{running.scenario.name} ends before {until:g} s")
        step = running.tick()
        scores.tick(step)
        if step.observation.depth is not None:
            scores.frame(step)
