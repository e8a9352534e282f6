"""Which modules a class in Python depends on, found by reading them alone: nothing is imported.

Followed are the packages that a module is in, and imports wherever they stand in it. What is
installed, and Python's own library, is not followed, but for the package of the class itself.
"""

import ast
import site
import sysconfig
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from treadwell.errors import InputError
from treadwell.module_source import Located, locate

MOST_MODULES: Final = 300
"""Modules that are followed; of more, all of the class's package counts, and what was found."""
DYNAMIC: Final = frozenset(
    {
        "__import__", "import_module", "importlib", "pkgutil", "runpy", "exec", "eval", "globals",
        "vars", "modules", "__subclasses__", "inspect", "gc", "pickle", "__dict__",
    }
)  # fmt: skip
"""Names by which code reaches what it does not name."""


@dataclass(frozen=True, slots=True)
class Module:
    """A module that is depended on.

    Attributes:
        name: dotted.
        content: of its file.
        tree: of its source; None of what is no Python that could be read.
        imports: dotted names of modules, as far as they can be told, that its source names.
        taken: (module, name) of each `from module import name`; the name is a star where all is.
        package: in which it is: what a relative import begins from.
    """

    name: str
    content: bytes
    tree: ast.Module | None
    imports: frozenset[str]
    taken: frozenset[tuple[str, str]] = frozenset()
    package: str = ""

    def origin(self, node: ast.ImportFrom) -> str:
        """Return the module from which one of its own statements imports; "" where none is."""
        return _origin(node, self.package)


@dataclass(frozen=True, slots=True)
class Dependencies:
    """What a class depends on.

    Attributes:
        modules: by name; the class's own and all that it was followed to.
        dynamic: whether one of them reaches what it does not name, or there are too many to follow:
            then `modules` has the whole package.
    """

    modules: dict[str, Module]
    dynamic: bool


def dependencies(module: str) -> Dependencies:
    """Return what a module depends on; empty where there is no such module."""
    own, found = module.partition(".")[0], dict[str, Module]()
    waiting, seen = [module], {module}
    while waiting and len(found) < MOST_MODULES:
        name = waiting.pop(0)
        read = _read(name, own)
        if read is None:
            continue
        found[name] = read
        for other in (*_packages(name), *sorted(read.imports)):
            if other not in seen:
                seen.add(other)
                waiting.append(other)
    dynamic = bool(waiting) or any(_is_dynamic(one) for one in found.values())
    if dynamic:
        found.update(_whole_package(own))
    return Dependencies(dict(sorted(found.items())), dynamic)


def names_in(node: ast.AST) -> Iterator[str]:
    """Yield every name, attribute, imported name and string in a piece of source."""
    for one in ast.walk(node):
        if isinstance(one, ast.Name):
            yield one.id
        elif isinstance(one, ast.Attribute):
            yield one.attr
        elif isinstance(one, ast.Constant) and isinstance(one.value, str):
            yield one.value
        elif isinstance(one, ast.Import | ast.ImportFrom):
            for alias in one.names:
                yield from alias.name.split(".")
            if isinstance(one, ast.ImportFrom) and one.module:
                yield from one.module.split(".")


def _is_dynamic(module: Module) -> bool:
    return module.tree is not None and not DYNAMIC.isdisjoint(names_in(module.tree))


def _read(name: str, own: str) -> Module | None:
    """Return a module; None where there is none, or it is installed and not of the own package."""
    try:
        located = locate(name)
    except InputError:
        return None  # whoever makes the component tells what is missing
    place = located.file or located.compiled
    if name.partition(".")[0] != own and (place is None or _is_installed(place)):
        return None
    return _module(located)


def _module(located: Located) -> Module:
    content = located.source
    if content is None:
        compiled = located.compiled
        readable = compiled is not None and compiled.is_file()
        content = compiled.read_bytes() if compiled is not None and readable else b""
        return Module(located.name, content, None, frozenset())
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return Module(located.name, content, None, frozenset())
    package = located.name if located.folders is not None else located.name.rpartition(".")[0]
    imports = frozenset(_imports(tree, package))
    return Module(located.name, content, tree, imports, frozenset(_taken(tree, package)), package)


def _taken(tree: ast.Module, package: str) -> Iterator[tuple[str, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            yield from ((_origin(node, package), alias.name) for alias in node.names)


def _origin(node: ast.ImportFrom, package: str) -> str:
    if not node.level:
        return node.module or ""
    words = package.split(".")
    base = ".".join(words[: len(words) - node.level + 1])
    return f"{base}.{node.module or ''}".strip(".")


def _imports(tree: ast.Module, package: str) -> Iterator[str]:
    """Yield what a source imports; of `from a import b` both, since `a.b` may be a module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name
                yield from _packages(alias.name)
        elif isinstance(node, ast.ImportFrom):
            origin = _origin(node, package)
            if not origin:
                continue
            yield origin
            yield from _packages(origin)
            yield from (f"{origin}.{alias.name}" for alias in node.names if alias.name != "*")


def _packages(name: str) -> list[str]:
    """Return the packages that a module is in: importing it runs them."""
    words = name.split(".")
    return [".".join(words[:depth]) for depth in range(1, len(words))]


def _whole_package(own: str) -> dict[str, Module]:
    """Return every source of a package, or the one of a module in none."""
    try:
        located = locate(own)
    except InputError:
        return {}
    found = {own: _module(located)}
    for folder in located.folders or ():
        root = Path(folder)
        for path in sorted(root.rglob("*.py")):
            words = path.relative_to(root).with_suffix("").parts
            name = ".".join((own, *(words[:-1] if words[-1] == "__init__" else words)))
            if path.is_file():
                package = (name,) if words[-1] == "__init__" else None
                found[name] = _module(Located(name, package, path, path.read_bytes()))
    return found


@cache
def _installed() -> tuple[Path, ...]:
    """Return the folders of Python's library and of installed packages."""
    paths = sysconfig.get_paths()
    named = [paths[key] for key in ("stdlib", "platstdlib", "purelib", "platlib")]
    named += [*site.getsitepackages(), site.getusersitepackages()]
    return tuple(Path(name).resolve() for name in dict.fromkeys(named))


def _is_installed(path: Path) -> bool:
    from treadwell.data import PACKAGE

    place = path.resolve()
    return any(place.is_relative_to(folder) for folder in (*_installed(), PACKAGE))
