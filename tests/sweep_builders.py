"""Small sweeps for tests: a scenario that is over at once, and parts that misbehave."""

import ctypes
import os
import time
from pathlib import Path
from typing import Any

from user_parts import Straight

from treadwell.sweeps.request import Key
from treadwell.sweeps.row import Row

SHORT = """
schema = 1
name = "{name}"
time_limit = 0.2
[start]
position = [0.0, 0.0]
[goal]
position = [1.0, 0.0]
[vary]
"start.yaw" = {{ uniform = [-0.3, 0.3] }}
"""


def short(folder: Path, name: str = "short") -> str:
    """Write a scenario that is over after 0.2 s, and return its path."""
    path = folder / f"{name}.toml"
    path.write_text(SHORT.format(name=name))
    return str(path)


class Odd(Straight):
    """A planner that goes wrong in the way that its parameter says."""

    def __init__(self, how: str = "well") -> None:
        super().__init__()
        self.how = how

    def plan(self, *given: Any) -> Any:  # noqa: ANN401 - as the protocol
        if self.how == "crash":
            ctypes.string_at(0)
        if self.how == "leave":
            os._exit(9)
        if self.how == "hang":
            time.sleep(3600)
        if self.how == "memory":
            bytearray(40 * 10**9)
        if self.how == "raise":
            raise ValueError("cannot plan")
        return super().plan(*given)


def row(seed: int = 0, **changes: Any) -> Row:  # noqa: ANN401 - any column
    """Return a row of an episode that went well."""
    facts: dict[str, Any] = {
        "scenario": "slalom",
        "robot": "qrio",
        "variant": "",
        "seed": seed,
        "outcome": "goal_reached",
        "passed": True,
        "success": True,
        "simulated_seconds": 30.0 + seed,
        "falls": 0,
        "collisions": 0,
    }
    return Row(**facts | changes)


def key(seed: int = 0) -> Key:
    """Return the key of `row`."""
    return Key("slalom", "qrio", "", seed)
