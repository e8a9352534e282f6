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
import inspect
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from treadwell.errors import InputError
from treadwell.module_source import flat, locate, parsed

MOST_MODULES: Final = 50
"""Modules that are looked at on the way from a name to its class and the class's bases."""
Methods = Mapping[str, Sequence[str]]
"""A method's name -> the arguments that it is called with, by their names; without `self`."""


def check_class(module: str, name: str, methods: Methods) -> None:
    """Make sure, by its source alone, that a module has a class with these methods.

    A method has to take its arguments: what is called so but is something else is not made, either,
    since to make it may do anything.

    Raises:
        InputError: it has not, or it cannot be seen; the sentence says which, without a place.
    """
    loaded = sys.modules.get(module)
    if loaded is not None:
        kind = vars(loaded).get(name)
        if not isinstance(kind, type):
            raise InputError(f"{module} has no class {name}")
        check_methods(kind, methods)
    else:
        _refuse(name, _Reader().missing(module, name, methods), methods)


def check_methods(kind: type, methods: Methods) -> None:
    """Make sure that a class that is there has these methods, and that they take their arguments.

    Raises:
        InputError: it has not; the sentence says which, without a place.
    """
    missing = [method for method in methods if not _takes(kind, method, methods[method])]
    _refuse(kind.__name__, missing, methods)


def _refuse(name: str, missing: Sequence[str], methods: Methods) -> None:
    if missing:
        listed = ", ".join(f"{method}({', '.join(methods[method])})" for method in missing)
        raise InputError(f"{name} has no method {listed}, or not with these arguments")


class _Reader:
    """Follows names from source to source."""

    def __init__(self) -> None:
        self._bodies: dict[str, list[ast.stmt]] = {}
        self._packages: dict[str, bool] = {}
        self._left = MOST_MODULES

    def missing(self, module: str, name: str, methods: Methods) -> list[str]:
        """Return the methods that neither the class nor a base of it is seen to have."""
        found = self._class(module, name, set())
        if found is None:
            raise InputError(f"{module} has no class {name} that could be seen without running it")
        taken: dict[str, bool] = {}
        self._gather(*found, methods, taken, set())
        return [method for method in methods if not taken.get(method, False)]

    def _gather(
        self,
        home: str,
        node: ast.ClassDef,
        methods: Methods,
        taken: dict[str, bool],
        seen: set[tuple[str, str]],
    ) -> None:
        """Note of each method whether it takes its arguments, as the class or a base has it."""
        own: dict[str, bool] = {}
        for statement in flat(node.body):
            for name, takes in _defined(statement, methods):
                own[name] = own.get(name, False) or takes
        taken.update({name: takes for name, takes in own.items() if name not in taken})
        for base in node.bases:
            named = _dotted(base.value if isinstance(base, ast.Subscript) else base)
            if named is None or (home, named) in seen or taken.keys() >= methods.keys():
                continue
            seen.add((home, named))
            try:
                found = self._dotted_class(home, named)
            except InputError:
                continue  # a base that cannot be read brings no method that could be seen
            if found is not None:
                self._gather(*found, methods, taken, seen)

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
            self._bodies[module] = parsed(located)
        return flat(self._bodies[module])


def _defined(statement: ast.stmt, methods: Methods) -> Iterator[tuple[str, bool]]:
    """Yield what a statement of a class makes a method of, and whether it takes its arguments."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
        if statement.name in methods:
            yield statement.name, _has_room(statement, len(methods[statement.name]))
    elif isinstance(statement, ast.Assign) and not isinstance(statement.value, ast.Constant):
        yield from ((to.id, True) for to in statement.targets if isinstance(to, ast.Name))


def _has_room(function: ast.FunctionDef | ast.AsyncFunctionDef, count: int) -> bool:
    """Say whether a method takes so many arguments; of a decorated one it cannot be told."""
    decorators = [_dotted(one) for one in function.decorator_list]
    if set(decorators) - {"staticmethod", "classmethod"}:
        return True
    given, asked = count + ("staticmethod" not in decorators), function.args
    most = len(asked.posonlyargs) + len(asked.args)
    least = most - len(asked.defaults) + sum(one is None for one in asked.kw_defaults)
    return least <= given and (given <= most or asked.vararg is not None)


def _takes(kind: type, method: str, arguments: Sequence[str]) -> bool:
    """Say whether a class that is there has a method that takes these arguments."""
    function = getattr(kind, method, None)
    if not callable(function):
        return False
    bound = isinstance(inspect.getattr_static(kind, method), staticmethod | classmethod)
    try:
        inspect.signature(function).bind(*([] if bound else [None]), *arguments)
    except TypeError:
        return False
    except ValueError:
        return True  # of what is compiled it cannot be told
    return True


def _dotted(node: ast.expr) -> str | None:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        before = _dotted(node.value)
        return None if before is None else f"{before}.{node.attr}"
    return None


def _joined(before: str, after: str) -> str:
    return f"{before}.{after}" if before and after else before or after
