"""Parts that the courses of the experiment are put together from, as a scenario file has them."""

from collections.abc import Sequence
from typing import Any, Final

Part = dict[str, Any]
"""A table of a scenario file."""

TALL: Final = 0.7
"""Metres: walls that no robot looks over."""


def wall(
    name: str, begin: tuple[float, float], end: tuple[float, float], height: float = TALL
) -> Part:
    """Return an upright wall along a line."""
    return {"kind": "wall", "name": name, "from": list(begin), "to": list(end), "height": height}


def corridor(
    end: float, width: float = 0.9, *, begin: float = -0.6, closed: bool = True
) -> list[Part]:
    """Return the walls of a corridor along x, `width` m between them; shut at both ends or not."""
    side = width / 2 + 0.025
    walls = [
        wall(f"{name} wall", (begin, y), (end, y)) for name, y in (("left", side), ("right", -side))
    ]
    if closed:
        for name, x in (("end", end), ("near", begin)):
            walls.append(wall(f"{name} wall", (x, -side), (x, side)))
    return walls


def box(
    name: str, position: tuple[float, float], size: tuple[float, float, float], base: float = 0.0
) -> Part:
    """Return a box that stands, or hangs `base` m above the ground."""
    return {
        "kind": "box",
        "name": name,
        "position": list(position),
        "size": list(size),
        "base": base,
    }


def desk(position: tuple[float, float], size: tuple[float, float], room: float) -> list[Part]:
    """Return a desk on four legs with `room` m below its top."""
    x, y = position
    half = (size[0] / 2 - 0.03, size[1] / 2 - 0.03)
    legs = [
        box(f"leg {i}", (x + i1 * half[0], y + i2 * half[1]), (0.04, 0.04, room))
        for i, (i1, i2) in enumerate(((-1, -1), (-1, 1), (1, -1), (1, 1)))
    ]
    return [box("top", position, (*size, 0.03), room), *legs]


def flight(steps: int, rise: float, tread: float, width: float, landing: float) -> Part:
    """Return stairs that lead up along x from 0.6 m on."""
    return {
        "kind": "stairs",
        "name": "stairs",
        "position": [0.6, 0.0],
        "steps": steps,
        "rise": rise,
        "tread": tread,
        "width": width,
        "landing": landing,
    }


def ramp(
    name: str, at: tuple[float, float], length: float, width: float, rise: float, yaw: float = 0.0
) -> Part:
    """Return an inclined plane; `at`: middle of its low edge, `yaw`: the way up."""
    return {
        "kind": "ramp",
        "name": name,
        "position": list(at),
        "yaw": yaw,
        "length": length,
        "width": width,
        "rise": rise,
    }


def platform(name: str, at: tuple[float, float], size: tuple[float, float, float]) -> Part:
    """Return a block with a walkable top."""
    return {"kind": "platform", "name": name, "position": list(at), "size": list(size)}


def cable(at: float, width: float, size: float = 0.015) -> Part:
    """Return a bar across the way at x = `at`, as high and deep as `size`, m."""
    return {
        "kind": "sill",
        "name": "cable",
        "position": [at, 0.0],
        "rise": size,
        "depth": size,
        "width": width,
    }


def scenario(
    name: str,
    goal: Part,
    course: Sequence[Part],
    *,
    start: Part | None = None,
    vary: Part | None = None,
    **tables: Part | list[Part],
) -> Part:
    """Return a whole scenario; the start and the soles' friction vary unless told otherwise.

    Args:
        name: the scenario's.
        goal: its table; a radius of 0.15 m unless it has one.
        course: its elements.
        start: its table; the origin, facing along x.
        vary: what is drawn; the heading within 0.2 rad, the place within 4 cm.
        tables: others, by their names.
    """
    drawn = {"start.yaw": spread(0.2), "start.position.1": spread(0.04)} if vary is None else vary
    return {
        "schema": 1,
        "name": name,
        "time_limit": 150.0,
        "start": {"position": [0.0, 0.0], **(start or {})},
        "goal": {"radius": 0.15, **goal},
        "course": list(course),
        "vary": {"physics.friction": {"uniform": [0.6, 1.0]}, **drawn},
        "expect": {"max_collisions": 0},
        **tables,
    }


def spread(most: float) -> Part:
    """Return what is drawn from -most to most."""
    return {"uniform": [-most, most]}


def between(least: float, most: float) -> Part:
    """Return what is drawn from least to most."""
    return {"uniform": [least, most]}
