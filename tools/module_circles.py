"""Finds circles between modules that stand side by side in the core's crates.

    python tools/module_circles.py      # each circle, and one line of code for each of its arrows

A module uses another one when it, or one within it, names it or something that the module above
re-exports from it. A module and those within it may use each other: they are one thing.
"""

import re
from collections import defaultdict
from dataclasses import dataclass, field

from rust_source import Source, sources

_USE = re.compile(r"\b(?:pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
_PATH = re.compile(r"\b(crate|super|self)((?:::\w+)+)")

Module = tuple[str, ...]


@dataclass
class Crate:
    """The modules of a crate, what each re-exports, and what it names."""

    modules: dict[Module, Source] = field(default_factory=dict)
    exports: dict[Module, dict[str, Module]] = field(default_factory=dict)

    def home(self, path: Module) -> Module:
        """Return the module that a path leads to, through re-exports."""
        for _ in range(8):
            at = path
            while at not in self.modules:
                at = at[:-1]
            rest = path[len(at) :]
            if not rest or rest[0] not in self.exports.get(at, {}):
                return at
            path = (*self.exports[at][rest[0]], *rest[1:])
        return at


def split_use(tree: str) -> list[str]:
    """Return the paths of a `use`, one each: `a::{b, c::d}` is `a::b` and `a::c::d`."""
    tree = " ".join(tree.split())
    if "{" not in tree:
        return [tree]
    head, _, rest = tree.partition("{")
    depth, begin, parts = 0, 0, []
    inner = rest.rsplit("}", 1)[0]
    for at, letter in enumerate(inner + ","):
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            parts.append(inner[begin:at].strip())
            begin = at + 1
    return [path for part in parts if part for path in split_use(head + part)]


def _absolute(path: str, module: Module) -> Module | None:
    names = [name.strip() for name in path.split(" as ")[0].split("::")]
    at = list(module)
    while names and names[0] == "super":
        at, names = at[:-1], names[1:]
    if names and names[0] == "crate":
        at, names = [], names[1:]
    elif names and names[0] == "self":
        names = names[1:]
    elif path.startswith("super"):
        pass
    else:
        return (*module, *names)
    return (*at, *names)


def crates() -> dict[str, Crate]:
    """Return all crates of the core."""
    found: dict[str, Crate] = defaultdict(Crate)
    for source in sources():
        found[source.crate].modules[source.module] = source
    for crate in found.values():
        for module, source in crate.modules.items():
            exported = crate.exports.setdefault(module, {})
            for use in _USE.finditer(source.text):
                for path in split_use(use.group(1)):
                    target = _absolute(path, module)
                    name = path.split(" as ")[-1].split("::")[-1].strip()
                    if target and name not in ("*", "self") and target != (*module, name):
                        exported[name] = target
    return found


def arrows(crate: Crate) -> dict[tuple[Module, Module], str]:
    """Return which module uses which beside it, with a place in the code."""
    found: dict[tuple[Module, Module], str] = {}
    for module, source in crate.modules.items():
        named = [
            (use.start(), path)
            for use in _USE.finditer(source.text)
            for path in split_use(use.group(1))
        ]
        named += [(path.start(), path.group()) for path in _PATH.finditer(source.text)]
        for at, path in named:
            if not path.startswith(("crate", "super", "self")):
                continue
            target = _absolute(path, module)
            used = crate.home(target) if target else ()
            shared = 0
            while shared < min(len(module), len(used)) and module[shared] == used[shared]:
                shared += 1
            if shared < min(len(module), len(used)):
                key = (module[: shared + 1], used[: shared + 1])
                found.setdefault(key, f"{source.name}:{source.line(at)}")
    return found


def circles(links: dict[tuple[Module, Module], str]) -> list[list[Module]]:
    """Return the groups of modules in which each leads to each other (Tarjan)."""
    after: dict[Module, list[Module]] = defaultdict(list)
    for user, used in links:
        after[user].append(used)
    number: dict[Module, int] = {}
    low: dict[Module, int] = {}
    stack: list[Module] = []
    groups: list[list[Module]] = []

    def visit(at: Module) -> None:
        number[at] = low[at] = len(number)
        stack.append(at)
        for other in after[at]:
            if other not in number:
                visit(other)
            if other in stack:
                low[at] = min(low[at], low[other])
        if low[at] == number[at]:
            group = stack[stack.index(at) :]
            del stack[stack.index(at) :]
            if len(group) > 1:
                groups.append(sorted(group))

    for module in sorted(after):
        if module not in number:
            visit(module)
    return groups


def all_circles() -> dict[str, dict[str, str]]:
    """Return every circle as `crate: a, b` with its arrows."""
    found = {}
    for name, crate in sorted(crates().items()):
        links = arrows(crate)
        for group in circles(links):
            words = ", ".join("::".join(module) for module in group)
            found[f"{name}: {words}"] = {
                f"{'::'.join(a)} -> {'::'.join(b)}": place
                for (a, b), place in sorted(links.items())
                if a in group and b in group
            }
    return found


def main() -> None:
    """Print the circles."""
    found = all_circles()
    for circle, links in found.items():
        print(circle)
        for link, place in links.items():
            print(f"    {link}: {place}")
    print(f"circles between modules: {len(found)}")


if __name__ == "__main__":
    main()
