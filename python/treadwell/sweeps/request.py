"""What a sweep is asked for: lines of scenario, robot and variant, and the seeds of each."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from treadwell.class_hash import class_hash
from treadwell.data import data_folder
from treadwell.errors import InputError
from treadwell.plugins import ForeignPart, examined, foreign_parts, refuse_user_code
from treadwell.robot.load import load_robot
from treadwell.scenario.loading import find_scenario, load_scenario, read_toml
from treadwell.scenario.model import Scenario
from treadwell.scenario.unread import unread
from treadwell.sweeps.content import build_hash, line_hash
from treadwell.sweeps.variants import variants
from treadwell.version import __version__

SCHEMA: Final = "treadwell.sweep/1"


@dataclass(frozen=True, slots=True, order=True)
class Key:
    """One episode of a sweep: the scenario's name, the robot's, the variant and the seed."""

    scenario: str
    robot: str
    variant: str
    seed: int

    @property
    def text(self) -> str:
        """One line that says it."""
        words = (self.scenario, self.robot, *([self.variant] if self.variant else []))
        return f"{' '.join(words)} seed {self.seed}"


@dataclass(frozen=True, slots=True)
class Line:
    """A scenario with a robot and settings, over seeds.

    Attributes:
        file: the scenario's file, absolute.
        scenario: its name.
        robot: the robot's name.
        robot_given: as the user gave it; None: the file's.
        variant: its settings of `--vary` as one text; empty where nothing varies.
        settings: `KEY=VALUE` each, those of `--set` and of the variant.
        seeds: of its episodes.
        parts: the components that are Python of the user's or of installed packages, in any of
            its episodes.
        hash: of the files that it depends on, and of what the scenario becomes.
        classes: (`package.module:Class`, hash of what it does) of each of the parts.
        unread: (key, sentence) of each of the settings that changes nothing in it.
    """

    file: Path
    scenario: str
    robot: str
    robot_given: str | None
    variant: str
    settings: tuple[str, ...]
    seeds: tuple[int, ...]
    parts: tuple[ForeignPart, ...]
    hash: str
    classes: tuple[tuple[str, str], ...] = ()
    unread: tuple[tuple[str, str], ...] = ()

    def keys(self) -> list[Key]:
        """Return its episodes."""
        return [Key(self.scenario, self.robot, self.variant, seed) for seed in self.seeds]

    def identity(self) -> dict[str, Any]:
        """Return all but the seeds as plain data: what a resumed sweep must have in common."""
        return {
            "scenario": self.scenario,
            "robot": self.robot,
            "variant": self.variant,
            "settings": list(self.settings),
            "hash": self.hash,
            "classes": dict(self.classes),
        }

    def document(self) -> dict[str, Any]:
        """Return it as plain data, with what `treadwell run` is given for one of its episodes."""
        shipped = self.file.parent == data_folder("scenarios").resolve()
        return {
            **self.identity(),
            "file": self.scenario if shipped else str(self.file),
            "robot_given": self.robot_given,
            "seeds": list(self.seeds),
        }


@dataclass(frozen=True, slots=True)
class Request:
    """A sweep: its lines, in the order of the results."""

    lines: tuple[Line, ...]

    def keys(self) -> list[Key]:
        """Return all episodes, seed by seed so that the lines grow side by side."""
        places = [(seed, line) for line in self.lines for seed in line.seeds]
        order = {id(line): number for number, line in enumerate(self.lines)}
        places.sort(key=lambda place: (place[0], order[id(place[1])]))
        return [Key(line.scenario, line.robot, line.variant, seed) for seed, line in places]

    def line_of(self, key: Key) -> int:
        """Return the index of an episode's line."""
        for number, line in enumerate(self.lines):
            if (line.scenario, line.robot, line.variant) == (key.scenario, key.robot, key.variant):
                return number
        raise KeyError(key)

    def python(self) -> dict[ForeignPart, Path | None]:
        """Return the parts in Python that its episodes run, each with its file.

        Raises:
            InputError: one is not there, or no class with the methods of its protocol.
        """
        found: dict[ForeignPart, Path | None] = {}
        for line in self.lines:
            found.update(examined(line.parts, str(line.file)))
        return found

    def unread(self) -> list[str]:
        """Return a sentence for each setting that changes nothing in any of its lines."""
        first = dict(self.lines[0].unread)
        everywhere = set(first).intersection(*(dict(line.unread) for line in self.lines))
        return [sentence for key, sentence in first.items() if key in everywhere]

    def refuse_user_code(self) -> None:
        """Refuse it where a scenario names a class.

        Raises:
            InputError: with the first such file and key.
        """
        for line in self.lines:
            refuse_user_code(line.parts, str(line.file))

    def document(self) -> dict[str, Any]:
        """Return it as plain data: what `sweep.json` holds."""
        return {
            "schema": SCHEMA,
            "version": __version__,
            "build": build_hash(),
            "lines": [line.document() for line in self.lines],
        }


def crossed(
    scenarios: Sequence[str],
    *,
    seeds: range,
    robot: str | None = None,
    settings: Sequence[str] = (),
    vary: Sequence[str] = (),
) -> Request:
    """Return every scenario with every variant over the same seeds.

    Raises:
        InputError: a scenario, a robot or a setting is bad, or two lines would be the same.
    """
    lines = [
        make_line(name, seeds, robot, tuple(settings), chosen)
        for name in scenarios
        for chosen in variants(vary)
    ]
    return checked(lines)


def checked(lines: Sequence[Line]) -> Request:
    """Return lines as a request.

    Raises:
        InputError: two of them have the same name.
    """
    seen: dict[tuple[str, str, str], Line] = {}
    for line in lines:
        name = (line.scenario, line.robot, line.variant)
        if name in seen:
            files = " and ".join(sorted({str(seen[name].file), str(line.file)}))
            raise InputError(f"sweep: {' '.join(filter(None, name))} is there twice ({files})")
        seen[name] = line
    return Request(tuple(lines))


def make_line(
    name: str,
    seeds: Sequence[int],
    robot: str | None,
    settings: tuple[str, ...],
    variant: tuple[str, ...] = (),
) -> Line:
    """Return a line, its scenario read and checked with the first seed.

    Raises:
        InputError: the scenario, the robot or a setting is bad.
    """
    file = find_scenario(name).resolve()
    both = (*settings, *variant)
    made = load_scenario(file, robot=robot, seed=seeds[0], overrides=both)
    loaded = load_robot(made.robot)
    parts = _parts(file, made, seeds, robot, both)
    return Line(
        file=file,
        scenario=made.name,
        robot=loaded.name,
        robot_given=robot,
        variant=", ".join(variant),
        settings=both,
        seeds=tuple(seeds),
        parts=parts,
        hash=line_hash(file, made, loaded, [both, robot]),
        classes=tuple((name, class_hash(name)) for name in dict.fromkeys(p.target for p in parts)),
        unread=tuple(unread(made).items()),
    )


def _parts(
    file: Path, first: Scenario, seeds: Sequence[int], robot: str | None, settings: Sequence[str]
) -> tuple[ForeignPart, ...]:
    """Return the parts in Python of a line's episodes; each is looked at where parts are drawn."""
    parts = dict.fromkeys(foreign_parts(first.navigation.slots()))
    words = [key.split(".")[0].strip() for key in (*settings, *_drawn(file))]
    if "vary" in words or "navigation" in words[len(settings) :]:
        for seed in seeds[1:]:
            made = load_scenario(file, robot=robot, seed=seed, overrides=settings)
            parts.update(dict.fromkeys(foreign_parts(made.navigation.slots())))
    return tuple(parts)


def _drawn(file: Path) -> list[str]:
    table = read_toml(file).get("vary", {})
    return list(table) if isinstance(table, dict) else []
