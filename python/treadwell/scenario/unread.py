"""Settings that somebody gave and that none of the chosen components reads."""

import sys
import warnings
from collections.abc import Collection
from typing import Final

from treadwell.components import OF_CHOICE, TABLES
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import split_key

_PACKAGE: Final = "treadwell."


def unread(scenario: Scenario, replaced: Collection[str] = ()) -> dict[str, str]:
    """Return a sentence for each setting of `--set` or `overrides` that changes nothing.

    Such are the settings of a component in whose place another one was chosen.

    Args:
        scenario: as it was loaded.
        replaced: slots whose component the caller brings as an object.

    Returns:
        Dotted key -> the sentence.
    """
    sentences = {}
    for key in scenario.set_keys.keys:
        words = split_key(key)
        if words[0] == "navigation" and len(words) > 1:
            told = _why(scenario, words[1], replaced)
            if told:
                sentences[key] = f"{scenario.set_keys.word} {key} changes nothing: {told}"
    return sentences


def unread_tables(scenario: Scenario) -> list[str]:
    """Return a sentence for each table of the scenario's file that changes nothing.

    That is no fault: a file may hold settings for several choices.
    """
    given = {tuple(split_key(key)[:2]) for key in scenario.set_keys.keys}
    tables = scenario.navigation.parameters()
    own = [name for name in tables if ("navigation", name) not in given]
    told = ((name, _why(scenario, name, ())) for name in own)
    return [f"[navigation.{name}] changes nothing: {why}" for name, why in told if why]


def warn_of_unread(scenario: Scenario, replaced: Collection[str]) -> None:
    """Warn whoever called into the package of settings that change nothing."""
    level, frame = 1, sys._getframe()
    while frame.f_globals.get("__name__", "").startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back  # type: ignore[assignment]
    for sentence in unread(scenario, replaced).values():
        warnings.warn(sentence, stacklevel=level)


def _why(scenario: Scenario, table: str, replaced: Collection[str]) -> str:
    """Return why nothing reads a table; nothing where something does, or it is no component's."""
    slots = scenario.navigation.slots()
    chosen = {slot: "" if slot in replaced else name for slot, name in slots.items()}
    read = any(table in TABLES[slot].get(name, ()) for slot, name in chosen.items())
    if read or table not in OF_CHOICE:
        return ""
    readers = {
        slot: [name for name, tables in of_slot.items() if table in tables]
        for slot, of_slot in TABLES.items()
    }
    return "; ".join(
        f"navigation.{slot} is {chosen[slot] or 'an object'}, and only {_listed(names)} "
        f"{'reads' if len(names) == 1 else 'read'} it"
        for slot, names in readers.items()
        if names
    )


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
