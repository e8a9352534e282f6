"""Which functions and classes of a source do nothing but be there: their definition runs no code.

What nobody uses of them can be left out without a change of what the others do.
"""

import ast
from collections import Counter
from collections.abc import Iterator
from typing import Final

_PURE_DECORATORS: Final = frozenset(
    {
        "dataclass", "dataclasses.dataclass", "final", "typing.final", "override", "property",
        "staticmethod", "classmethod", "abstractmethod", "abc.abstractmethod", "overload",
        "runtime_checkable", "cache", "functools.cache", "cached_property", "functools.wraps",
    }
)  # fmt: skip
_PURE_BASES: Final = frozenset({"object", "Protocol", "typing.Protocol", "ABC", "abc.ABC"})
_PURE_CALLS: Final = frozenset({"field", "dataclasses.field"})
_LIBRARY: Final = frozenset({"dataclasses", "typing", "typing_extensions", "abc", "functools"})
_HARMLESS: Final = frozenset(
    word for one in _PURE_DECORATORS | _PURE_BASES | _PURE_CALLS for word in one.split(".")
)
"""Names that mean what they do in Python's library unless a module gives them another meaning."""
_HOOKS: Final = frozenset({"__init_subclass__", "__set_name__", "__class_getitem__"})

Definition = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def meanings(body: list[ast.stmt]) -> Counter[str]:
    """Return how many statements may give each name a meaning."""
    return Counter(bound for statement in body for bound in _bound(statement))


def rebinds(body: list[ast.stmt]) -> bool:
    """Say whether something harmless may mean something else."""
    return not _HARMLESS.isdisjoint(_rebound(body))


def quiet_definitions(
    body: list[ast.stmt], bases: frozenset[str] = frozenset()
) -> dict[str, Definition]:
    """Return the functions and classes, by name, whose definition does nothing but define them."""
    known = meanings(body)
    found: dict[str, Definition] = {}
    if rebinds(body):
        return found
    for statement in body:
        if not isinstance(statement, Definition) or known[statement.name] > 1:
            continue
        if isinstance(statement, ast.ClassDef):
            quiet = _is_quiet_class(statement, found, bases)
        else:
            quiet = _is_quiet_function(statement)
        if quiet and not statement.name.startswith("__"):
            found[statement.name] = statement
    return found


def _rebound(body: list[ast.stmt]) -> Iterator[str]:
    """Yield what may mean something else in a module than it does in Python's library."""
    for statement in body:
        if isinstance(statement, ast.ImportFrom) and statement.names[0].name == "*":
            yield from _HARMLESS
        if isinstance(statement, ast.Import | ast.ImportFrom):
            froms = [statement.module] if isinstance(statement, ast.ImportFrom) else []
            known = all(one in _LIBRARY for one in froms or [n.name for n in statement.names])
            if known and all(one.asname in (None, one.name) for one in statement.names):
                continue
        yield from _bound(statement)


def _bound(statement: ast.stmt) -> set[str]:
    """Return the names that a statement may give a meaning in its module, and perhaps more."""
    found: set[str] = set()
    for node in ast.walk(statement):
        if isinstance(node, ast.Global):
            found.update(node.names)
        elif isinstance(node, Definition) and (
            node is statement or not isinstance(statement, Definition)
        ):
            found.add(node.name)
        elif isinstance(statement, Definition):
            continue  # what it binds within itself is its own
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        elif isinstance(node, ast.alias):
            found.add((node.asname or node.name).partition(".")[0])
        elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
            found.add(node.name)
    return found


def _is_quiet_function(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    arguments = function.args
    evaluated = [*arguments.defaults, *filter(None, arguments.kw_defaults)]
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    every += [one for one in (arguments.vararg, arguments.kwarg) if one is not None]
    evaluated += [one.annotation for one in every if one.annotation is not None]
    evaluated += [function.returns] if function.returns is not None else []
    return _are_pure(function.decorator_list) and all(map(_is_quiet, evaluated))


def _is_quiet_class(
    kind: ast.ClassDef, known: dict[str, Definition], bases: frozenset[str]
) -> bool:
    if kind.keywords or not _are_pure(kind.decorator_list):
        return False
    for base in kind.bases:
        named = ast.unparse(base.value if isinstance(base, ast.Subscript) else base)
        quiet = named in _PURE_BASES or named in bases
        if not quiet and not isinstance(known.get(named), ast.ClassDef):
            return False
    return all(map(_is_quiet_statement, kind.body))


def _is_quiet_statement(statement: ast.stmt) -> bool:
    """Say whether a statement of a class's body does nothing but give it something."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
        return statement.name not in _HOOKS and _is_quiet_function(statement)
    if isinstance(statement, ast.AnnAssign):
        value = statement.value
        return _is_quiet(statement.annotation) and (value is None or _is_quiet(value))
    if isinstance(statement, ast.Assign):
        plain = all(isinstance(to, ast.Name) and to.id not in _HOOKS for to in statement.targets)
        return plain and _is_quiet(statement.value)
    return isinstance(statement, ast.Pass) or (
        isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    )


def _are_pure(decorators: list[ast.expr]) -> bool:
    for one in decorators:
        called = isinstance(one, ast.Call)
        named = ast.unparse(one.func if isinstance(one, ast.Call) else one)
        setter = named.endswith((".setter", ".getter", ".deleter")) and not called
        if not setter and named not in _PURE_DECORATORS:
            return False
        if isinstance(one, ast.Call):
            given = [*one.args, *(keyword.value for keyword in one.keywords)]
            if not all(map(_is_quiet, given)):
                return False
    return True


def _is_quiet(value: ast.expr) -> bool:
    """Say whether evaluating an expression does nothing but give a value."""
    for node in ast.walk(value):
        if isinstance(node, ast.NamedExpr | ast.Await | ast.Yield | ast.YieldFrom):
            return False
        if isinstance(node, ast.Call) and ast.unparse(node.func) not in _PURE_CALLS:
            return False
    return True
