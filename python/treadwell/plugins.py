"""User components: found by name or `package.module:Class`, made, checked for their methods."""

import importlib
from typing import Any

from treadwell.additions import class_of
from treadwell.components import COMPONENTS
from treadwell.errors import InputError

METHODS = {
    "segmenter": ("segment",),
    "world_model": ("insert", "view"),
    "localizer": ("correct", "estimate"),
    "planner": ("plan",),
    "behaviour": ("next",),
}
"""Slot -> the methods of its protocol in `treadwell.protocols`."""

OPTIONAL = {"world_model": ("forget",), "planner": ("forget",)}
"""Slot -> the methods that are called where a component has them."""


def load_component(slot: str, name: str, parameters: dict[str, Any]) -> object:
    """Return an object of the class that `name` means.

    Args:
        slot: which component it is to be.
        name: `package.module:Class`, or the name that an installed package gives it.
        parameters: keyword arguments for the class: its table `[navigation.Class]`, or of the name.

    Raises:
        InputError: there is no such module or class, it cannot be made, or a method is missing.
    """
    where = f"navigation.{slot}"
    module_name, _, class_name = (name if ":" in name else class_of(slot, name)).partition(":")
    try:
        module = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:
        raise InputError(f"{where}: cannot import {module_name}: {error!r}") from error
    kind = getattr(module, class_name, None)
    if not isinstance(kind, type):
        raise InputError(f"{where}: {module_name} has no class {class_name}")
    # Before it is called: a scenario may name any class there is, and making it may do anything.
    _check_methods(slot, kind, class_name)
    try:
        component: object = kind(**parameters)
    except (Exception, SystemExit) as error:
        raise InputError(f"{where}: cannot make {name}: {error!r}") from error
    return component


def check_component(slot: str, component: object) -> None:
    """Refuse an object that lacks a method of its slot's protocol.

    Raises:
        InputError: the slot or a method does not exist.
    """
    if slot not in COMPONENTS:
        raise InputError(f"{slot}: no such component; there are {', '.join(COMPONENTS)}")
    _check_methods(slot, component, type(component).__name__)


def _check_methods(slot: str, component: object, name: str) -> None:
    missing = [method for method in METHODS[slot] if not callable(getattr(component, method, None))]
    if missing:
        raise InputError(f"{slot}: {name} has no method {', '.join(missing)}")


def class_path(component: object) -> str:
    """Return the class of an object as `package.module:Class`."""
    kind = type(component)
    return f"{kind.__module__}:{kind.__qualname__}"
