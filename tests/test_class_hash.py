"""What a class does has a hash of its own: its text may change, what it does may not."""

import textwrap
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadwell.class_hash import class_hash

PLANNERS = '''
"""Two planners."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

STEP = 0.1


def ahead(x: float) -> float:
    """Return a step."""
    return x + STEP


def unused(x: float) -> float:
    return x


@dataclass(frozen=True)
class Base:
    weight: float = 1.0

    def plan(self, view):
        return [self.weight]


class Mine(Base):
    """A planner."""

    def plan(self, view):
        # a comment
        return [ahead(1.0)]


class Other:
    def plan(self, view):
        return [unused(2.0)]


__all__ = ["Mine", "Other"]

if __name__ == "__main__":
    print(Other())
'''


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(str(tmp_path))
    return tmp_path


class Sources:
    """Writes modules, and says what becomes of hashes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def write(self, **modules: str) -> None:
        for name, text in modules.items():
            (self.folder / f"{name}.py").write_text(textwrap.dedent(text))

    def hash(self, target: str, **modules: str) -> str:
        self.write(**modules)
        return class_hash(target)


@pytest.fixture
def sources(folder: Path) -> Sources:
    return Sources(folder)


def hashes(sources: Sources, text: str) -> tuple[str, str]:
    sources.write(hashed_planners=text)
    return class_hash("hashed_planners:Mine"), class_hash("hashed_planners:Other")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("# a comment", "# another\n        # and one more"),
        ('"""A planner."""', '"""A planner,\n\n    and a good one."""'),
        ('    """A planner."""\n', ""),
        ('"""Two planners."""', '"""A page of words."""'),
        ("return x + STEP", "return (x\n        + STEP)"),
        ("return x + STEP", "return x+STEP"),
        ("STEP = 0.1", "STEP = 0.10\n\n\n"),
        ('["Mine", "Other"]', "['Other']"),
        ("print(Other())", "print(Mine(), Other())"),
    ],
)
def test_comments_docstrings_and_layout_do_not_count(sources: Sources, old: str, new: str) -> None:
    before = hashes(sources, PLANNERS)
    assert old in PLANNERS
    assert hashes(sources, PLANNERS.replace(old, new)) == before
    assert before[0] != before[1]


@pytest.mark.parametrize(
    ("old", "new", "edited"),
    [
        ("ahead(1.0)", "ahead(2.0)", (True, False)),
        ("x + STEP", "x - STEP", (True, False)),
        ("weight: float = 1.0", "weight: float = 2.0", (True, False)),
        ("@dataclass(frozen=True)", "@dataclass", (True, False)),
        ("unused(2.0)", "unused(3.0)", (False, True)),
        ("return x\n", "return -x\n", (False, True)),
        ("STEP = 0.1", "STEP = 0.2", (True, True)),
        ("import numpy as np", "import math as np", (True, True)),
        ("class Other:", "class Other(metaclass=Meta):", (True, True)),
        ("class Other:", "class Other(np.ndarray):", (True, True)),
        ("class Other:\n", "class Other:\n    np.seterr(all='raise')\n", (True, True)),
        ("def unused(x: float)", "def unused(x: float = np.seterr())", (True, True)),
        ("def unused", "@register\ndef unused", (True, True)),
        ("return [self.weight]", "return [Other().plan(view)]", (True, False)),
    ],
)
def test_what_a_class_can_reach_counts_and_what_only_another_can_does_not(
    sources: Sources, old: str, new: str, edited: tuple[bool, bool]
) -> None:
    before = hashes(sources, PLANNERS)
    assert old in PLANNERS
    after = hashes(sources, PLANNERS.replace(old, new))
    assert tuple(a != b for a, b in zip(before, after, strict=True)) == edited


@pytest.mark.parametrize(
    "line",
    [
        "Mine.chosen = globals()['Ot' + 'her']",
        "import sys; Mine.chosen = sys.modules[__name__]",
        "REGISTRY = {'other': Other}",
        "from functools import reduce as dataclass",
        "def dataclass(kind): return kind",
        "import hashed_planners",
        "Mine.names = __file__",
    ],
)
def test_where_a_class_may_reach_more_more_counts(sources: Sources, line: str) -> None:
    text = PLANNERS.replace("__all__", f"{line}\n__all__")
    before = hashes(sources, text)
    after = hashes(sources, text.replace("unused(2.0)", "unused(3.0)"))
    assert before[0] != after[0]
    assert before[1] != after[1]


def test_a_class_that_reads_docstrings_depends_on_them(sources: Sources) -> None:
    reads = PLANNERS.replace("return [ahead(1.0)]", "return [len(self.__doc__)]")
    before = hashes(sources, reads)[0]
    assert hashes(sources, reads.replace('"""A planner."""', '"""More."""'))[0] != before


def test_a_hook_of_a_base_that_sees_its_subclasses_counts(sources: Sources) -> None:
    hooked = PLANNERS.replace("class Other:", "class Other(Base):").replace(
        "    weight: float", "    def __init_subclass__(cls): pass\n    weight: float"
    )
    before = hashes(sources, hooked)[0]
    assert hashes(sources, hooked.replace("unused(2.0)", "unused(3.0)"))[0] != before


@pytest.mark.parametrize(
    "imported",
    [
        "from hashed_helper import STEP",
        "import hashed_helper",
        "def f():\n    from hashed_helper import STEP",
        "from hashed_between import STEP",
        "try:\n    import no_such_module_at_all\nexcept ImportError:\n    import hashed_helper",
    ],
)
def test_a_module_of_the_users_that_is_imported_counts(sources: Sources, imported: str) -> None:
    sources.write(hashed_between="from hashed_helper import STEP\n")
    main = f"{imported}\nclass Mine: ...\n"
    before = sources.hash("hashed_main:Mine", hashed_main=main, hashed_helper="STEP = 1\n")
    same = sources.hash("hashed_main:Mine", hashed_helper="STEP = 1  # one\n")
    assert same == before
    assert sources.hash("hashed_main:Mine", hashed_helper="STEP = 2\n") != before


BASES = """
class Grid:
    def way(self):
        return [1.0]

class Aside:
    def way(self):
        return [2.0]
"""
DERIVED = """
from hashed_bases import Grid

class Mine(Grid):
    def plan(self): return self.way()

class Other(Grid):
    def plan(self): return []
"""


@pytest.mark.parametrize(
    ("old", "new", "edited"),
    [
        ("return []", "return [3.0]", False),  # a neighbour that has the base of another file, too
        ("[2.0]", "[3.0]", False),  # a neighbour of the base
        ("class Aside:", "class Aside(Grid):", False),
        ("[1.0]", "[3.0]", True),
        ("class Aside:", "class Aside(metaclass=Meta):", True),
        ("    def way(self):\n        return [1.0]", "    way = register()", True),
    ],
)
def test_of_a_base_in_another_file_what_is_used_counts(
    sources: Sources, old: str, new: str, edited: bool
) -> None:
    texts = {"hashed_bases": BASES, "hashed_derived": DERIVED}
    before = sources.hash("hashed_derived:Mine", **texts)
    changed = {name: text.replace(old, new) for name, text in texts.items()}
    assert changed != texts
    assert (sources.hash("hashed_derived:Mine", **changed) != before) == edited


@pytest.mark.parametrize(
    "line",
    [
        "import hashed_bases",
        "from hashed_bases import *",
        "CHOSEN = __import__('hashed_bases')",
        "def f():\n    import hashed_bases as all_of_it\n",
    ],
)
def test_who_has_a_whole_module_may_use_all_of_it(sources: Sources, line: str) -> None:
    texts = {"hashed_bases": BASES, "hashed_derived": f"{DERIVED}{line}\n"}
    before = sources.hash("hashed_derived:Mine", **texts)
    texts["hashed_bases"] = BASES.replace("[2.0]", "[3.0]")
    assert sources.hash("hashed_derived:Mine", **texts) != before


def test_a_base_that_sees_its_subclasses_counts_from_another_file_too(sources: Sources) -> None:
    hooked = BASES.replace("class Grid:", "class Grid:\n    def __init_subclass__(cls): pass")
    texts = {"hashed_bases": hooked, "hashed_derived": DERIVED}
    before = sources.hash("hashed_derived:Mine", **texts)
    texts["hashed_derived"] = DERIVED.replace("return []", "return [3.0]")
    assert sources.hash("hashed_derived:Mine", **texts) != before


def test_a_neighbour_with_a_base_of_the_package_does_not_count(sources: Sources) -> None:
    text = DERIVED.replace("hashed_bases import Grid", "treadwell.protocols import Planner as Grid")
    before = sources.hash("hashed_derived:Mine", hashed_derived=text)
    edited = text.replace("return []", "return [3.0]")
    assert sources.hash("hashed_derived:Mine", hashed_derived=edited) == before


@pytest.mark.parametrize("found", [False, True])
def test_of_a_package_what_is_imported_counts_and_all_of_it_where_that_cannot_be_told(
    folder: Path, found: bool
) -> None:
    package = folder / f"hashed_package_{found}"
    (package / "sub").mkdir(parents=True)
    main = "from . import helper\nfrom .sub.deep import X\nclass A: ...\n"
    files = {
        "__init__.py": "",
        "a.py": ("import importlib\n" if found else "") + main,
        "helper.py": "STEP = 1\n",
        "sub/__init__.py": "",
        "sub/deep.py": "X = 1\n",
        "b.py": "Y = 1\n",
    }
    for name, text in files.items():
        (package / name).write_text(text)
    before = class_hash(f"{package.name}.a:A")
    for name, text in files.items():
        (package / name).write_text(text + "Z = 3\n")
        counts = found or name != "b.py"
        assert (class_hash(f"{package.name}.a:A") != before) == counts, name
        (package / name).write_text(text)
    assert class_hash(f"{package.name}.a:A") == before


def test_what_is_no_python_or_not_there_has_a_hash_too(sources: Sources) -> None:
    assert sources.hash("hashed_broken:X", hashed_broken="def (") != sources.hash(
        "hashed_broken:X", hashed_broken="def ( #"
    )
    assert class_hash("there_is_no_such_module_at_all:X") == class_hash("nor_is_there_this:X")
    deep = "x = " + "-" * 3000 + "1\n"
    assert sources.hash("hashed_deep:X", hashed_deep=deep)


def test_a_deep_source_counts_by_its_text(sources: Sources) -> None:
    deep = "x = " + "(" * 80 + "1" + ")" * 80 + "\nclass X: ...\n"
    before = sources.hash("hashed_nested:X", hashed_nested=deep)
    assert sources.hash("hashed_nested:X", hashed_nested=deep.replace("1", "2")) != before


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_words_put_anywhere_between_lines_change_nothing(data: st.DataObject) -> None:
    import ast

    from treadwell.class_hash import _meaning

    lines = PLANNERS.splitlines()
    before = _meaning(ast.parse(PLANNERS), frozenset({"Mine"}))
    for _ in range(4):
        at = data.draw(st.integers(0, len(lines)))
        lines.insert(at, data.draw(st.sampled_from(["", "# words", "    # words", "\t"])))
    assert _meaning(ast.parse("\n".join(lines)), frozenset({"Mine"})) == before
