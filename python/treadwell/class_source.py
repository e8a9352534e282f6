"""A class that a file names, looked at without running any of it: does it have these methods?

A scenario is input. Importing what it names would run that module, and the packages around it, only
to find that there is no such class; so its source is read first. What counts as seen:

- The module is found on Python's path, a package's folders walked without importing it.
- The class stands in its source (also within an `if` or a `try`), under another name of the same
  module, or is imported there from a module for which the same holds.
- Each method stands in the class, or in a base for which the same holds.

What is compiled, or made only when the module runs, cannot be looked into and is refused; a class
in Python around it, with the methods written out, can. A module that was imported already has run:
of it the class itself is asked.
"""

import ast
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from pkgutil import get_importer
from typing import Final

from treadwell.errors import InputError
from treadwell.files import read_content

LARGEST_SOURCE: Final = 10_000_000
"""Bytes of a module's source."""
MOST_MODULES: Final = 50
"""Modules that are looked at on the way from a name to its class and the class's bases."""


@dataclass(frozen=True, slots=True)
class Located:
    """Where a module is.

    Attributes:
        name: the module's.
        folders: in which its submodules lie; None: it is no package.
        file: its source; None: it has none that could be read.
        source: its content.
    """

    name: str
    folders: tuple[str, ...] | None
    file: Path | None = None
    source: bytes | None = None


def locate(module: str) -> Located:
    """Return where a module is; nothing of it is run, nor of the packages that it is in.

    Raises:
        InputError: there is none, or its source cannot be read.
    """
    located: Located | None = None
    words = module.split(".")
    for depth in range(1, len(words) + 1):
        name = ".".join(words[:depth])
        loaded = sys.modules.get(name)
        if loaded is None:
            spec = _spec(name, None if located is None else located.folders or ())
        else:
            spec = getattr(loaded, "__spec__", None) or ModuleSpec(name, None)
        if spec is None:
            raise InputError(f"there is no module {name} on Python's path")
        located = _located(name, spec)
    assert located is not None
    return located


def check_class(module: str, name: str, methods: Sequence[str]) -> None:
    """Make sure, by its source alone, that a module has a class with these methods.

    Raises:
        InputError: it has not, or it cannot be seen; the sentence says which, without a place.
    """
    loaded = sys.modules.get(module)
    if loaded is not None:
        kind = vars(loaded).get(name)
        if not isinstance(kind, type):
            raise InputError(f"{module} has no class {name}")
        missing = [method for method in methods if not callable(getattr(kind, method, None))]
    else:
        missing = _Reader().missing(module, name, methods)
    if missing:
        raise InputError(f"{name} has no method {', '.join(missing)}")


class _Reader:
    """Follows names from source to source."""

    def __init__(self) -> None:
        self._bodies: dict[str, list[ast.stmt]] = {}
        self._packages: dict[str, bool] = {}
        self._left = MOST_MODULES

    def missing(self, module: str, name: str, methods: Sequence[str]) -> list[str]:
        """Return the methods that neither the class nor a base of it is seen to have."""
        found = self._class(module, name, set())
        if found is None:
            raise InputError(f"{module} has no class {name} that could be seen without running it")
        return self._lacking(*found, list(methods), set())

    def _lacking(
        self, home: str, node: ast.ClassDef, methods: list[str], seen: set[tuple[str, str]]
    ) -> list[str]:
        methods = [method for method in methods if method not in _names_in(node.body)]
        for base in node.bases:
            named = _dotted(base.value if isinstance(base, ast.Subscript) else base)
            if not methods or named is None or (home, named) in seen:
                continue
            seen.add((home, named))
            try:
                found = self._dotted_class(home, named)
            except InputError:
                continue  # a base that cannot be read brings no method that could be seen
            if found is not None:
                methods = self._lacking(*found, methods, seen)
        return methods

    def _dotted_class(self, home: str, named: str) -> tuple[str, ast.ClassDef] | None:
        """Return the class that `Name`, or `module.Name`, means in a module."""
        before, _, name = named.rpartition(".")
        if not before:
            return self._class(home, name, set())
        first, _, rest = before.partition(".")
        for statement in self._statements(home):
            if isinstance(statement, ast.Import):
                for alias in statement.names:
                    if alias.asname is None and alias.name == before:
                        return self._class(before, name, set())
                    if alias.asname == first:
                        return self._class(_joined(alias.name, rest), name, set())
            elif isinstance(statement, ast.ImportFrom):
                for alias in statement.names:
                    if (alias.asname or alias.name) == first:
                        package = _joined(self._origin(home, statement), alias.name)
                        return self._class(_joined(package, rest), name, set())
        return None

    def _class(
        self, module: str, name: str, seen: set[tuple[str, str]]
    ) -> tuple[str, ast.ClassDef] | None:
        """Return the module and the statement that makes a class; None where none is seen."""
        if (module, name) in seen:
            return None
        seen.add((module, name))
        found, fault = None, None
        for statement in self._statements(module):  # the last one holds, as when it is run
            if isinstance(statement, ast.ClassDef) and statement.name == name:
                found = module, statement
                continue
            for origin, other in self._others(module, statement, name):
                try:
                    found = self._class(origin, other, seen) or found
                except InputError as error:
                    fault = error  # of a `try` with two imports, one will do
        if found is None and fault is not None:
            raise fault
        return found

    def _others(self, module: str, statement: ast.stmt, name: str) -> Iterator[tuple[str, str]]:
        """Yield (module, name) of what a statement gives a name to."""
        if isinstance(statement, ast.ImportFrom):
            for alias in statement.names:
                if alias.name == "*" or (alias.asname or alias.name) == name:
                    origin = self._origin(module, statement)
                    yield origin, name if alias.name == "*" else alias.name
        elif isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Name):
            names = [to.id for to in statement.targets if isinstance(to, ast.Name)]
            yield from ((module, statement.value.id) for to in names if to == name)

    def _origin(self, module: str, statement: ast.ImportFrom) -> str:
        """Return the absolute name of the module from which a statement imports."""
        if not statement.level:
            return statement.module or ""
        words = module.split(".")
        up = statement.level - (1 if self._packages.get(module) else 0)
        return _joined(".".join(words[: len(words) - up]), statement.module or "")

    def _statements(self, module: str) -> Iterator[ast.stmt]:
        """Yield the statements of a module that run when it is imported, but for those of loops."""
        if module not in self._bodies:
            self._left -= 1
            if self._left < 0:
                raise InputError(f"more than {MOST_MODULES} modules lead to the class")
            located = locate(module)
            self._packages[module] = located.folders is not None
            self._bodies[module] = _parsed(located)
        return _flat(self._bodies[module])


def _spec(name: str, folders: Sequence[str] | None) -> ModuleSpec | None:
    """Return a module's spec; `folders` are those of its package, None for one in no package."""
    try:
        if folders is None:
            return find_spec(name)  # asks the finders; there is no package that it would run
        portions: list[str] = []
        for folder in folders:
            finder = get_importer(folder)
            spec = None if finder is None else finder.find_spec(name, None)
            if spec is not None and spec.loader is not None:
                return spec
            portions += [] if spec is None else spec.submodule_search_locations or []
    except Exception as error:  # finders of others: what they raise is theirs
        raise InputError(f"{name} cannot be looked for: {error!r}") from None
    if not portions:
        return None
    spec = ModuleSpec(name, None, is_package=True)
    spec.submodule_search_locations = portions
    return spec


def _located(name: str, spec: ModuleSpec) -> Located:
    places = spec.submodule_search_locations
    folders = None if places is None else tuple(places)
    origin = Path(spec.origin) if spec.has_location and spec.origin else None
    if origin is None or origin.suffix not in {".py", ".pyw"}:
        return Located(name, folders)
    if origin.exists():
        return Located(name, folders, origin, read_content(origin, LARGEST_SOURCE))
    get_source = getattr(spec.loader, "get_source", None)  # of an archive
    try:
        text = None if get_source is None else get_source(name)
    except (ImportError, OSError, SyntaxError, UnicodeDecodeError):
        text = None
    return Located(name, folders, origin, None if text is None else text.encode())


def _parsed(located: Located) -> list[ast.stmt]:
    if located.source is None:
        if located.file is None and located.folders is not None:
            return []  # a folder without an __init__.py
        raise InputError(
            f"{located.name} has no source that could be read: what is compiled is not run to see "
            "what it has; name a class in Python around it, with the methods written out"
        )
    try:
        return ast.parse(located.source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(f"{located.file or located.name}: is no Python: {error}") from None


def _flat(statements: Sequence[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield statements, and those within `if`, `try` and `with`."""
    for statement in statements:
        yield statement
        if isinstance(statement, ast.If | ast.Try | ast.With):
            yield from _flat(statement.body)
        if isinstance(statement, ast.If | ast.Try):
            yield from _flat(statement.orelse)
        if isinstance(statement, ast.Try):
            for handler in statement.handlers:
                yield from _flat(handler.body)
            yield from _flat(statement.finalbody)


def _names_in(body: Sequence[ast.stmt]) -> set[str]:
    """Return what a class's own statements define: methods, and other names for them."""
    names: set[str] = set()
    for statement in _flat(body):
        if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
            names.add(statement.name)
        elif isinstance(statement, ast.Assign) and not isinstance(statement.value, ast.Constant):
            names |= {to.id for to in statement.targets if isinstance(to, ast.Name)}
    return names


def _dotted(node: ast.expr) -> str | None:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        before = _dotted(node.value)
        return None if before is None else f"{before}.{node.attr}"
    return None


def _joined(before: str, after: str) -> str:
    return f"{before}.{after}" if before and after else before or after
