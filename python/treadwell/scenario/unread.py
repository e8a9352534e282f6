"""Settings that somebody gave and that none of the chosen components reads."""

from collections.abc import Collection

from treadwell.components import TABLES
from treadwell.scenario.model import Scenario
from treadwell.scenario.overrides import split_key


def unread(scenario: Scenario, replaced: Collection[str] = ()) -> dict[str, str]:
    """Return a sentence for each setting of `--set` or `overrides` that changes nothing.

    Such are the settings of a component in whose place another one was chosen. What the
    scenario's file says is not told: a file may hold settings for several choices.

    Args:
        scenario: as it was loaded.
        replaced: slots whose component the caller brings as an object.

    Returns:
        Dotted key -> the sentence.
    """
    chosen = {
        slot: "" if slot in replaced else name for slot, name in scenario.navigation.slots().items()
    }
    read = {table for slot, name in chosen.items() for table in TABLES[slot].get(name, ())}
    sentences = {}
    for key in scenario.set_keys.keys:
        words = split_key(key)
        if words[0] != "navigation" or len(words) < 2 or words[1] in read:
            continue
        readers = {
            slot: [name for name, tables in of_slot.items() if words[1] in tables]
            for slot, of_slot in TABLES.items()
        }
        told = [
            f"navigation.{slot} is {chosen[slot] or 'an object'}, and only {_listed(names)} "
            f"{'reads' if len(names) == 1 else 'read'} it"
            for slot, names in readers.items()
            if names
        ]
        if told:
            sentences[key] = f"{scenario.set_keys.word} {key} changes nothing: {'; '.join(told)}"
    return sentences


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
