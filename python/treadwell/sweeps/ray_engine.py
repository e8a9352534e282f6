"""The engine that does a sweep's episodes on a Ray cluster: the same function, elsewhere.

On each node an actor a slot holds a worker process of its own (`Pool`), so that limits, crashes and
hangs are dealt with as on one machine. All nodes must see the same folders.
"""

import os
from collections import deque
from collections.abc import Iterator
from typing import Any, Final, Self

from treadwell.errors import InputError
from treadwell.extras import install_hint
from treadwell.sweeps.engine import Engine
from treadwell.sweeps.job import do
from treadwell.workers.answers import Answer, Died
from treadwell.workers.pool import Limits, Pool

TRIES: Final = 3
"""Nodes that an episode may take with it, or be lost with, before it is given up."""

_Task = tuple[Any, Limits, bool, int]
"""Item, limits, whether it needs a fresh process, and how often it was lost."""


class Slot:
    """One place on the cluster where a job can be done at a time; lives in an actor."""

    def __init__(self) -> None:
        """Start nothing yet."""
        self._pool = Pool(do, 1)

    def do(self, item: object, limits: Limits, *, fresh: bool) -> Answer:
        """Do a job in a process of this node and return what came of it."""
        self._pool.submit(item, limits, fresh=fresh)
        ((_, answer),) = self._pool.answers()
        return answer

    def close(self) -> None:
        """End the process."""
        self._pool.__exit__(None, None, None)


def ray_engine(workers: int | None) -> Engine:
    """Return the engine; it joins the cluster of `RAY_ADDRESS`, or starts one on this machine.

    Args:
        workers: episodes at a time; None: as many as the cluster has processors.

    Raises:
        InputError: Ray is not installed, or there is no such cluster.
    """
    # Under `uv run` Ray would start each worker by the same command, in a folder that it packs and
    # that has no lock: nothing would ever begin. The nodes have an environment of their own.
    os.environ.setdefault("RAY_ENABLE_UV_RUN_RUNTIME_ENV", "0")
    try:
        import ray
    except ImportError:
        raise InputError(f"--engine ray: Ray is not installed: {install_hint('ray')}") from None
    if not ray.is_initialized():
        # A cluster of this machine listens to this machine alone, and asks nobody.
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        own = {} if "RAY_ADDRESS" in os.environ else {"include_dashboard": False}
        try:
            ray.init(log_to_driver=False, configure_logging=False, **own)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise InputError(f"--engine ray: no cluster: {error}") from None
    slots = workers or int(ray.cluster_resources().get("CPU", 1))
    return _RayEngine(ray, slots)


class _RayEngine:
    """Hands jobs to actors, and to another where one is lost with its node."""

    def __init__(self, ray: Any, count: int) -> None:  # noqa: ANN401 - Ray has no types of use
        self._ray, self._count = ray, count
        self._actor = ray.remote(num_cpus=1, max_restarts=0)(Slot)
        self._waiting: deque[_Task] = deque()
        self._idle: list[Any] = []
        self._slots = 0
        self._running: dict[Any, tuple[Any, _Task]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        for actor in [*self._idle, *(actor for actor, _ in self._running.values())]:
            self._ray.kill(actor)
        self._idle.clear()
        self._running.clear()

    def submit(
        self,
        item: object,
        limits: Limits | None = None,
        *,
        fresh: bool = False,
        next_: bool = False,
    ) -> None:
        task = (item, limits or Limits(), fresh, 0)
        if next_:
            self._waiting.appendleft(task)
        else:
            self._waiting.append(task)

    def answers(self) -> Iterator[tuple[Any, Answer]]:
        while True:
            self._hand_out()
            if not self._running:
                return
            ready, _ = self._ray.wait(list(self._running), num_returns=1, timeout=1.0)
            for reference in ready:
                actor, task = self._running.pop(reference)
                answer = self._answer(reference, actor, task)
                if answer is not None:
                    self._hand_out()
                    yield task[0], answer

    def _hand_out(self) -> None:
        while self._waiting:
            if not self._idle:
                if self._slots >= self._count:
                    return
                self._slots += 1
                self._idle.append(self._actor.remote())
            actor, task = self._idle.pop(), self._waiting.popleft()
            item, limits, fresh, _ = task
            self._running[actor.do.remote(item, limits, fresh=fresh)] = (actor, task)

    def _answer(self, reference: Any, actor: Any, task: _Task) -> Answer | None:  # noqa: ANN401
        """Return what came of a task; None of one that was lost and is going to be done again."""
        try:
            answer: Answer = self._ray.get(reference)
        except self._ray.exceptions.RayError as error:
            self._slots -= 1
            item, limits, fresh, lost = task
            if lost + 1 >= TRIES:
                return Died(f"its node was lost {TRIES} times: {type(error).__name__}")
            self._waiting.appendleft((item, limits, fresh, lost + 1))
            return None
        self._idle.append(actor)
        return answer
