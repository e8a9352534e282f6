"""What a component of the user's does wrong is told with its name, the line and the tick."""

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from user_parts import PARTS, Still

import treadwell
from treadwell.errors import CoreError, InputError
from treadwell.guard import Guard, blamed
from treadwell.plugins import METHODS
from treadwell.protocols import Decision, Footstep, ListedStep, Plan

STEP = Footstep("left", 0.04, 0.042, 0.0, 0.0, -0.05, 0.05)
SHORT = ("time_limit=0.6", "navigation.call_limit=0.3")


class Failing:
    """A behaviour that does something at its third call."""

    def __init__(self, deed: Any) -> None:  # noqa: ANN401 - a call or an exception
        self.deed = deed
        self.calls = 0

    def next(self, *_: object) -> Decision:
        self.calls += 1
        if self.calls == 3:
            if isinstance(self.deed, BaseException):
                raise self.deed
            self.deed()
        return Decision("idle")


def nothing_ever() -> None:
    while True:
        pass


def reason(part: object, tmp_path: Path) -> str:
    done = treadwell.run(
        "open_floor", overrides=SHORT, out=tmp_path / "run", record=False, behaviour=part
    )
    assert done.outcome == "error"
    return str(done.result.reason)


def test_an_exception_is_told_with_class_line_and_tick(tmp_path: Path) -> None:
    text = reason(Failing(RuntimeError("a wheel came off")), tmp_path)
    line = Failing.next.__code__.co_firstlineno + 4
    assert text == (
        "error: behaviour: Failing: RuntimeError('a wheel came off'), "
        f"test_guard.py:{line} at tick 2 (0.02 s)"
    )


@pytest.mark.parametrize("deed", [nothing_ever, lambda: time.sleep(60)])
def test_a_call_that_does_not_return_ends_the_run_with_error(
    deed: Any,  # noqa: ANN401
    tmp_path: Path,
) -> None:
    text = reason(Failing(deed), tmp_path)
    assert text.startswith(
        "error: behaviour: Failing: took longer than 0.3 s (navigation.call_limit), test_guard.py:"
    )
    assert text.endswith("at tick 2 (0.02 s)")


@pytest.mark.parametrize("deed", [SystemExit(0), MemoryError(), RecursionError()])
def test_nothing_that_is_raised_ends_the_program(deed: BaseException, tmp_path: Path) -> None:
    assert type(deed).__name__ in reason(Failing(deed), tmp_path)


def test_ctrl_c_amid_a_call_interrupts() -> None:
    episode = treadwell.Episode("open_floor", behaviour=Failing(KeyboardInterrupt()))
    for _ in range(2):
        episode.tick()
    with pytest.raises(KeyboardInterrupt):
        episode.tick()


def test_who_steps_an_episode_gets_the_exception_as_the_cause() -> None:
    cause = ValueError("so it was")
    episode = treadwell.Episode("open_floor", behaviour=Failing(cause))
    for _ in range(2):
        episode.tick()
    with pytest.raises(CoreError, match="behaviour: Failing: ValueError") as caught:
        episode.tick()
    assert caught.value.__cause__ is cause


def test_a_failure_of_the_cores_own_blames_nobody() -> None:
    guards = {"behaviour": Guard("behaviour", "Still", Still(), 1.0)}
    error = CoreError("observation: time goes back")
    assert blamed(error, guards) is error
    assert str(blamed(CoreError("behaviour: no"), guards)) == "behaviour: Still: no"


def test_an_attribute_that_is_no_method_is_no_method_of_the_protocol() -> None:
    behaviour = Failing(nothing_ever)
    behaviour.begin = None  # type: ignore[attr-defined]
    assert not hasattr(Guard("behaviour", "Failing", behaviour, 1.0), "begin")


@pytest.mark.parametrize("slot", PARTS)
def test_the_limit_goes_for_every_method_of_every_slot(slot: str) -> None:
    class Slow:
        def wait(self, *_: object) -> None:
            time.sleep(60)

        segment = insert = view = correct = estimate = plan = next = step = wait

    guard = Guard(slot, "Slow", Slow(), 0.05)
    for method in METHODS[slot]:
        guard.error = None
        with pytest.raises(BaseException, match=r"longer than 0\.05 s"):
            getattr(guard, method)()
        assert guard.error is not None


@pytest.mark.parametrize("limit", ["0", "-1", "nan", "1e9", "soon"])
def test_a_limit_that_is_none_is_bad_input(limit: str) -> None:
    with pytest.raises(InputError, match="call_limit"):
        treadwell.Episode("open_floor", overrides=(f"navigation.call_limit={limit}",))


class View:
    """A world model's view that can be spoilt."""

    def __init__(self, **changes: object) -> None:
        self.origin: Any = (-1.0, -1.0)
        self.cell: Any = 0.05
        self.kind: Any = np.ones((40, 40), np.uint8)
        self.height: Any = np.zeros((40, 40), np.float32)
        vars(self).update(changes)


@pytest.mark.parametrize(
    ("view", "message"),
    [
        (View(cell=0.0), "cell must be from"),
        (View(cell=1e-300), "cell must be from"),
        (View(origin=(1e9, 0.0)), "origin must be finite and within 10000, got 1000000000"),
        (View(cell=float("nan")), "cell must be from"),
        (View(origin=(float("inf"), 0.0)), "origin must be finite"),
        (View(height=np.full((40, 40), np.nan, np.float32)), "height must be finite where"),
        (View(kind=np.full((40, 40), 7, np.uint8)), "kind must be 0, 1 or 2, got 7"),
        (
            View(kind=np.zeros((2100, 2100), np.uint8), height=np.zeros((2100, 2100), np.float32)),
            "4000000 cells at most",
        ),
    ],
)
def test_a_view_that_makes_no_sense_is_refused(view: View, message: str) -> None:
    class Model:
        def insert(self, *_: object) -> bool:
            return True

        def view(self) -> View:
            return view

    episode = treadwell.Episode("open_floor", overrides=("time_limit=1.2",), world_model=Model())
    with pytest.raises(CoreError, match=f"world_model: Model: .*{message}"):
        for _ in episode:
            pass


LISTED = ListedStep("left", 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("slot", "method", "answer", "message"),
    [
        (
            "localizer",
            "estimate",
            (0.0, 0.0, 0.0),
            r"four numbers \(x m, y m, z m, yaw rad\), got tuple \(float, float, float\)",
        ),
        ("localizer", "estimate", (1e9, 0.0, 0.0, 0.0), "estimate must be finite and within"),
        ("planner", "plan", Plan(np.full((2, 2), 1e9)), "path must be finite and within"),
        ("planner", "plan", Plan(np.zeros((100_001, 2))), "path may have 100000 points at most"),
        (
            "planner",
            "plan",
            Plan(np.zeros((2, 2)), footsteps=(LISTED,) * 1001),
            "1000 footsteps at most",
        ),
        ("behaviour", "next", Decision("x", velocity=(1e9, 0.0, 0.0)), "velocity must be finite"),
        ("behaviour", "next", Decision("x", gaze=(0.0, 1e9)), "gaze must be finite and within"),
        ("behaviour", "next", Decision("x" * 101), "100 characters at most"),
        ("behaviour", "next", Decision("x", footsteps=(STEP,) * 1001), "1000 footsteps at most"),
        ("behaviour", "next", Decision("x", footsteps=(STEP._replace(x=1e9),)), "within 100"),
    ],
)
def test_an_answer_beyond_all_bounds_is_refused(
    slot: str, method: str, answer: object, message: str
) -> None:
    """A pose a million kilometres away once took all memory, and the program with it."""
    methods: dict[str, Any] = dict.fromkeys(METHODS[slot], lambda *_: None)
    part = type("Wild", (), methods | {method: lambda *_: answer})()
    parts: dict[str, Any] = {slot: part}
    episode = treadwell.Episode("open_floor", overrides=("time_limit=1.2",), **parts)
    with pytest.raises(CoreError, match=f"{slot}: Wild: .*{message}"):
        for _ in episode:
            pass
