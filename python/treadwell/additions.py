"""Components that installed packages add by name; all that a name can stand for."""

import sys
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Final

from treadwell.components import CLASS_NAME, COMPONENTS
from treadwell.errors import InputError

GROUP: Final = "treadwell.components"
"""Group of the entry points; one is named `slot.name`, as in `planner.beeline`."""


def installed(slot: str) -> dict[str, tuple[EntryPoint, ...]]:
    """Return name -> the entry points that bring it, of the packages that are installed."""
    found: dict[str, tuple[EntryPoint, ...]] = {}
    for point in _entry_points(tuple(sys.path)):
        of, _, name = point.name.partition(".")
        if of == slot and name.isidentifier() and name not in COMPONENTS[slot]:
            found[name] = (*found.get(name, ()), point)
    return found


def additions(slot: str) -> dict[str, str]:
    """Return name -> one line, of all that is there beside `COMPONENTS`."""
    return {name: _origin(points[0]) for name, points in installed(slot).items()}


def is_component(slot: str, name: str) -> bool:
    """Say whether `name` can stand in `slot`: a component's, or `package.module:Class`."""
    return (
        name in COMPONENTS[slot]
        or (len(name) <= 256 and bool(CLASS_NAME.fullmatch(name)))
        or name in known(slot)
    )


def known(slot: str) -> dict[str, str]:
    """Return name -> one line, of all that can stand in `slot`: the list, and what others add."""
    return {**COMPONENTS[slot], **additions(slot)}


def class_of(slot: str, name: str) -> str:
    """Return `package.module:Class` of an installed component.

    Raises:
        InputError: there is none of the name, or two packages bring it.
    """
    points = installed(slot).get(name, ())
    values = {point.value for point in points}
    if len(values) > 1:
        origins = " and ".join(sorted(_origin(point) for point in points))
        raise InputError(f"navigation.{slot}: {name} is brought by {origins}")
    if not values:
        raise InputError(f"navigation.{slot}: no installed package brings {name}")
    return values.pop()


@cache
def _entry_points(_path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    """Return the group's entry points; packages are looked up once for a search path."""
    return tuple(entry_points(group=GROUP))


def _origin(point: EntryPoint) -> str:
    package = "" if point.dist is None else f"{point.dist.name} {point.dist.version}: "
    return f"{package}{point.value}"
