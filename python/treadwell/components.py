"""The names that `[navigation]` knows: the core's own list, and what the harness puts in.

What others add to it is in `additions`.
"""

import json
import re
from functools import cache
from typing import Final

from treadwell import _core

TRUTH: Final = "truth"
"""The localizer that the harness puts in: the core has none that knows the truth."""
_COMPONENTS: Final = [
    *_core.components(),
    (
        "localizer",
        TRUTH,
        "the simulator's own pose; for ablations only, the result says so",
        None,
        [],
    ),
]

COMPONENTS: Final[dict[str, dict[str, str]]] = {
    slot: {name: about for of, name, about, *_ in _COMPONENTS if of == slot}
    for slot in dict.fromkeys(slot for slot, *_ in _COMPONENTS)
}
"""Slot of `[navigation]` -> name -> one line on what it is."""

SOURCES: Final[dict[str, dict[str, str | None]]] = {
    slot: {name: source for of, name, _, source, _ in _COMPONENTS if of == slot}
    for slot in COMPONENTS
}
"""Slot -> name -> the paper that it is of; None where it is of no paper."""

TABLES: Final[dict[str, dict[str, frozenset[str]]]] = {
    slot: {name: frozenset(tables) for of, name, *_, tables in _COMPONENTS if of == slot}
    for slot in COMPONENTS
}
"""Slot -> name -> the tables `[navigation.<table>]` that it reads, beside those of every run."""

PAPERS: Final = {
    "000": "Gutmann, Fukuchi, Fujita: A Floor and Obstacle Height Map for 3D Navigation of a "
    "Humanoid Robot, ICRA 2005",
    "002": "Maier, Hornung, Bennewitz: Real-Time Navigation in 3D Environments Based on Depth "
    "Camera Data, Humanoids 2012",
    "003": "Gutmann, Fukuchi, Fujita: Stair Climbing for Humanoid Robots Using Stereo Vision, "
    "IROS 2004",
    "004": "Burgard, Hebert: World Modeling, in: Springer Handbook of Robotics, chapter 36, 2008",
}
"""Number of a publication in sources and comments -> what it is."""

RENAMED: Final[dict[str, str]] = {"matching": "scan_match"}
"""What a component and its table were called -> what they are called."""

CLASS_NAME: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*", re.ASCII)
"""A user's own component: `package.module:Class`."""


OF_CHOICE: Final = frozenset(
    table for of_slot in TABLES.values() for tables in of_slot.values() for table in tables
)
"""Tables that some components read and others do not."""


@cache
def _parameter_keys() -> tuple[str, ...]:
    tables = json.loads(_core.parameters())
    return tuple(row["key"] for table in tables for row in table["parameters"])


def parameter_names(*words: str) -> list[str]:
    """Return the keys that a table of `[navigation]` can have, in the core's order.

    Args:
        words: of its dotted key, as `fog` or `fog`, `tuning`.
    """
    begin = ".".join(("navigation", *words, ""))
    below = (key.removeprefix(begin) for key in _parameter_keys() if key.startswith(begin))
    return list(dict.fromkeys(key.partition(".")[0] for key in below))


def parameter_tables() -> list[str]:
    """Return the names that a table `[navigation.<name>]` can have, sorted.

    What has no parameters has none; those of the walker `dcm` are `[gait]` of robot.toml.
    """
    return sorted(set(_core.tables()) - {"gait"})
