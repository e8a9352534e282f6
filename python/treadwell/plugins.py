"""User components: found by name or `package.module:Class`, made, checked for their methods.

A class that a scenario names is input: it is looked at first (`class_source`), and may be refused.
What an installed package brings by a name is the choice of whoever installed it.
"""

import difflib
import importlib
import inspect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from treadwell.additions import class_of, is_component, known
from treadwell.class_source import check_class, check_methods
from treadwell.components import CLASS_NAME, COMPONENTS
from treadwell.errors import InputError
from treadwell.module_source import locate
from treadwell.protocols import Behaviour, Localizer, Planner, Segmenter, Walker, WorldModel

METHODS = {
    "segmenter": ("segment",),
    "world_model": ("insert", "view"),
    "localizer": ("correct", "estimate"),
    "planner": ("plan",),
    "behaviour": ("next",),
    "walker": ("step",),
}
"""Slot -> the methods of its protocol in `treadwell.protocols`."""

PROTOCOLS: dict[str, type] = {
    "segmenter": Segmenter,
    "world_model": WorldModel,
    "localizer": Localizer,
    "planner": Planner,
    "behaviour": Behaviour,
    "walker": Walker,
}
"""Slot -> its protocol."""

OPTIONAL = {
    "segmenter": ("begin",),
    "world_model": ("begin", "forget"),
    "localizer": ("begin", "see"),
    "planner": ("begin", "forget"),
    "behaviour": ("begin",),
    "walker": ("begin", "standing", "stepping", "steps_taken"),
}
"""Slot -> the methods that are called where a component has them."""


@dataclass(frozen=True, slots=True)
class ForeignPart:
    """A component that is Python of the user's or of an installed package.

    Attributes:
        slot: which component it is to be.
        name: what the scenario calls it.
        target: its class, `package.module:Class`.
    """

    slot: str
    name: str
    target: str

    @property
    def installed(self) -> bool:
        """Whether an installed package brings it by a name; else the scenario names the class."""
        return self.name != self.target

    def examined(self) -> Path | None:
        """Return the file that would be run, and run nothing; None: the module is in no file.

        Raises:
            InputError: there is no such module; or the scenario names what is not seen to be a
                class with the methods of its protocol.
        """
        module, _, kind = self.target.partition(":")
        try:
            if not self.installed:
                check_class(module, kind, arguments(self.slot))
            return locate(module).file
        except InputError as error:
            raise InputError(f"navigation.{self.slot}: {self.name}: {error}") from None

    def said(self, file: Path | None) -> str:
        """Return what is told before it runs, with the file that `examined` returned."""
        named = f"{self.name} = {self.target}" if self.installed else self.name
        return f"runs {self.slot} {named}" + (f" ({file})" if file else "")


def arguments(slot: str) -> dict[str, tuple[str, ...]]:
    """Return the methods of a slot's protocol, each with the arguments that it is called with."""
    protocol = PROTOCOLS[slot]
    return {
        method: tuple(inspect.signature(getattr(protocol, method)).parameters)[1:]
        for method in METHODS[slot]
    }


def foreign_parts(slots: Mapping[str, str]) -> tuple[ForeignPart, ...]:
    """Return the components that are not treadwell's own, of slot -> name.

    Raises:
        InputError: no installed package brings one, or two do.
    """
    return tuple(
        ForeignPart(slot, name, name if ":" in name else class_of(slot, name))
        for slot, name in slots.items()
        if name not in COMPONENTS[slot]
    )


def examined(parts: Sequence[ForeignPart], where: str) -> dict[ForeignPart, Path | None]:
    """Return the file that each part would run, as `ForeignPart.examined` does.

    Raises:
        InputError: as it does; with `where`, the scenario's file, before the key.
    """
    try:
        return {part: part.examined() for part in parts}
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def refuse_user_code(parts: Sequence[ForeignPart], where: str) -> None:
    """Refuse classes that a scenario names.

    Args:
        parts: what `foreign_parts` returned.
        where: the scenario's file.

    Raises:
        InputError: one is the scenario's; those of installed packages are let through.
    """
    for part in parts:
        if not part.installed:
            raise InputError(
                f"{where}: navigation.{part.slot}: found {part.name!r}, which is code of the "
                "user's; where --no-user-code (user_code=False) is asked for it must be a name of "
                "`treadwell list components`"
            )


def stand_in(slot: str) -> object:
    """Return an object with the methods of a slot's protocol, none of which does anything."""
    return type("StandIn", (), dict.fromkeys(METHODS[slot], lambda *_: None))()


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
    (part,) = foreign_parts({slot: name})
    if not part.installed:
        part.examined()
    module_name, _, class_name = part.target.partition(":")
    try:
        module = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:
        raise InputError(f"{where}: cannot import {module_name}: {error!r}") from error
    kind = getattr(module, class_name, None)
    if not isinstance(kind, type):
        raise InputError(f"{where}: {module_name} has no class {class_name}")
    # Before it is called: making a class may do anything.
    if part.installed:
        _check_methods(slot, kind, class_name)
    else:
        part.examined()  # now of the class itself
    return _made(kind, parameters, where, name)


def brought_component(
    slot: str, component: object, parameters: Mapping[str, dict[str, Any]]
) -> object:
    """Return what the caller brings for a slot, checked; a class is made first.

    Args:
        slot: which component it is to be.
        component: an object, or its class.
        parameters: the scenario's tables `[navigation.NAME]`; a class gets that of its name.

    Raises:
        InputError: the slot does not exist, a method is missing, or the class cannot be made.
    """
    if not isinstance(component, type) or slot not in COMPONENTS:
        check_component(slot, component)
        return component
    try:
        check_methods(component, arguments(slot))
    except InputError as error:
        raise InputError(f"{slot}: {class_path(component)}: {error}") from None
    own = parameters.get(component.__name__, {})
    return _made(component, own, slot, class_path(component))


def _made(kind: type, parameters: dict[str, Any], where: str, name: str) -> object:
    try:
        component: object = kind(**parameters)
    except (Exception, SystemExit) as error:
        raise InputError(f"{where}: cannot make {name}: {error!r}") from error
    return component


def class_names(components: Mapping[str, object]) -> dict[str, str]:
    """Return the settings by which a scenario names the classes that a caller brings, or names.

    So it may have a table of their parameters, and says truly what it was run with. Of a class that
    no scenario could name there is none.

    Raises:
        InputError: a name stands for no component.
    """
    named = {slot: one for slot, one in components.items() if isinstance(one, str)}
    for slot, name in named.items():
        if slot in COMPONENTS and not is_component(slot, name):
            raise InputError(_no_component(slot, name))
    named |= {
        slot: name
        for slot, one in components.items()
        if isinstance(one, type)
        if CLASS_NAME.fullmatch(name := f"{one.__module__}:{one.__name__}")
    }
    return {f"navigation.{slot}": name for slot, name in named.items() if slot in COMPONENTS}


def _no_component(slot: str, name: str) -> str:
    names = known(slot)
    allowed = f"one of {', '.join(names)}, 'package.module:Class', a class or an object"
    return f"{slot}: found {name!r}; must be {allowed}{_nearest(name, names)}"


def _nearest(word: str, names: Iterable[str]) -> str:
    near = difflib.get_close_matches(word, names, n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def brought(components: Mapping[str, object]) -> dict[str, object]:
    """Return the components that a caller brings, without those that are only named."""
    return {
        slot: component
        for slot, component in components.items()
        if not (isinstance(component, str) and slot in COMPONENTS)
    }


def check_component(slot: str, component: object) -> None:
    """Refuse an object that lacks a method of its slot's protocol.

    Raises:
        InputError: the slot or a method does not exist.
    """
    if slot not in COMPONENTS:
        hint = _nearest(slot, COMPONENTS)
        raise InputError(f"{slot}: no such component; there are {', '.join(COMPONENTS)}{hint}")
    _check_methods(slot, component, type(component).__name__)


def _check_methods(slot: str, component: object, name: str) -> None:
    missing = [method for method in METHODS[slot] if not callable(getattr(component, method, None))]
    if missing:
        raise InputError(f"{slot}: {name} has no method {', '.join(missing)}")


def class_path(component: object) -> str:
    """Return a class, or that of an object, as `package.module:Class`."""
    kind = component if isinstance(component, type) else type(component)
    return f"{kind.__module__}:{kind.__qualname__}"
