"""A class is found by its source, and nothing of it is run: each module here would leave a mark."""

import sys
import zipfile
from pathlib import Path

import pytest

from treadwell.class_source import check_class
from treadwell.errors import InputError
from treadwell.module_source import locate
from treadwell.plugins import METHODS, PROTOCOLS, arguments, load_component

MARK = "import pathlib\npathlib.Path(__file__).with_suffix('.ran').write_text('')\n"
NEEDED = {"plan": ["view"]}
PLANNER = "class Mine:\n    def plan(self, *given): ...\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on Python's path."""
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def write(folder: Path, **sources: str) -> None:
    """Write modules; two underscores stand for a folder, `init` for a package's own file."""
    for name, source in sources.items():
        path = folder / (name.replace("__", "/").replace("init", "__init__") + ".py")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(MARK + source)


def assert_nothing_ran(folder: Path) -> None:
    assert list(folder.rglob("*.ran")) == []


SEEN = {
    "written there": {"top_a": PLANNER},
    "under a condition": {"top_a": "if True:\n    class Mine:\n        def plan(self, v): ...\n"},
    "in a try": {"top_a": f"try:\n    import x_y_z\nexcept ImportError:\n    pass\n{PLANNER}"},
    "of two imports one": {
        "top_a": "try:\n    from no_such import Mine\nexcept ImportError:\n"
        "    from top_b import Mine\n",
        "top_b": PLANNER,
    },
    "imported": {
        "top_a": "from top_b import Other as Mine\n",
        "top_b": "class Other:\n plan = f\n",
    },
    "imported with all": {"top_a": "from top_b import *\n", "top_b": PLANNER},
    "another name": {"top_a": "class Other:\n    async def plan(self, v): ...\nMine = Other\n"},
    "with defaults": {"top_a": "class Mine:\n    def plan(self, view, far=1, *, near=2): ...\n"},
    "static": {"top_a": "class Mine:\n    @staticmethod\n    def plan(view, /): ...\n"},
    "decorated": {"top_a": "class Mine:\n    @timed\n    def plan(): ...\n"},
    "of a base": {"top_a": "class Base:\n    def plan(self, v): ...\nclass Mine(Base): ...\n"},
    "of a generic base": {
        "top_a": "class Base(Generic[T]):\n    def plan(self, v): ...\nclass Mine(Base[int]): ...\n"
    },
    "of an imported base": {
        "top_a": "import pack.deep as d\nclass Mine(d.Base): ...\n",
        "pack__init": "",
        "pack__deep": "class Base:\n    def plan(self, v): ...\n",
    },
    "of a base in a module by its whole name": {
        "top_a": "import pack.deep\nclass Mine(int, pack.deep.Base): ...\n",
        "pack__init": "",
        "pack__deep": "class Base:\n    def plan(self, v): ...\n",
    },
    "of a base beside an unknown one": {
        "top_a": "from no_such import X\nfrom . import y\nclass Mine(X, Base): ...\n"
        "class Base:\n    def plan(self, v): ...\n"
    },
}


@pytest.mark.parametrize("case", SEEN)
def test_what_stands_in_the_source_is_seen(case: str, folder: Path) -> None:
    write(folder, **SEEN[case])
    check_class("top_a", "Mine", NEEDED)
    assert_nothing_ran(folder)
    assert "top_a" not in sys.modules


REFUSED = {
    "no such class": ({"top_a": "def plan(): ...\n"}, "top_a has no class Mine"),
    "a number": ({"top_a": "Mine = 3\n"}, "top_a has no class Mine"),
    "no such method": ({"top_a": "class Mine: ...\n"}, "Mine has no method plan"),
    "no arguments": (
        {"top_a": "class Mine:\n    def plan(self): ...\n"},
        r"no method plan\(view\)",
    ),
    "too many arguments": (
        {"top_a": "class Mine:\n    def plan(self, v, w): ...\n"},
        r"no method plan\(view\)",
    ),
    "an argument by its name alone": (
        {"top_a": "class Mine:\n    def plan(self, view, *, stairs): ...\n"},
        r"no method plan\(view\)",
    ),
    "covered by another": (
        {"top_a": f"{PLANNER}class Other(Mine):\n    def plan(self): ...\nMine = Other\n"},
        "no method plan",
    ),
    "no method but a number": ({"top_a": "class Mine:\n    plan = 3\n"}, "has no method plan"),
    "made when it runs": ({"top_a": "Mine = type('Mine', (), {})\n"}, "could be seen without"),
    "in a circle": (
        {"top_a": "from top_b import Mine\n", "top_b": "from top_a import Mine\n"},
        "no class Mine",
    ),
    "its own base": ({"top_a": "class Mine(Mine): ...\n"}, "has no method plan"),
    "no Python": ({"top_a": "class Mine(:\n"}, r"top_a\.py: is no Python"),
    "imported from nowhere": ({"top_a": "from no_such import Mine\n"}, "no module no_such"),
    "compiled": ({"top_a": "from mujoco._structs import MjData as Mine\n"}, "no source that"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_not_seen_is_refused(case: str, folder: Path) -> None:
    sources, message = REFUSED[case]
    write(folder, **sources)
    with pytest.raises(InputError, match=message):
        check_class("top_a", "Mine", NEEDED)
    assert_nothing_ran(folder)


def test_packages_are_walked_and_not_imported(folder: Path) -> None:
    """Those without an `__init__.py`, too, and classes that a package hands on from within."""
    write(folder, pack__init="from .inner import Mine\n", pack__inner__init="from ..low import *\n")
    write(folder, pack__low=PLANNER, bare__inside__module=PLANNER)
    check_class("pack", "Mine", NEEDED)
    check_class("pack.inner", "Mine", NEEDED)
    check_class("bare.inside.module", "Mine", NEEDED)
    assert locate("bare.inside.module").file == folder / "bare/inside/module.py"
    with pytest.raises(InputError, match=r"no module pack\.low\.deeper"):
        check_class("pack.low.deeper", "Mine", NEEDED)
    with pytest.raises(InputError, match=r"bare\.inside has no class Mine"):
        check_class("bare.inside", "Mine", NEEDED)
    assert_nothing_ran(folder)


def test_an_archive_is_read_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    archive = tmp_path / "parts.zip"
    with zipfile.ZipFile(archive, "w") as made:
        made.writestr("zipped/__init__.py", "")
        made.writestr("zipped/part.py", f"raise SystemExit\n{PLANNER}")
    monkeypatch.syspath_prepend(archive)
    check_class("zipped.part", "Mine", NEEDED)


def test_a_source_that_is_no_file_is_not_waited_for(folder: Path) -> None:
    (folder / "endless.py").symlink_to("/dev/zero")
    with pytest.raises(InputError, match=r"no module endless|it is no file"):
        check_class("endless", "Mine", NEEDED)


def test_too_many_modules_are_not_followed(folder: Path) -> None:
    write(folder, **{f"chain_{i}": f"from chain_{i + 1} import Mine\n" for i in range(60)})
    with pytest.raises(InputError, match="more than 50 modules"):
        check_class("chain_0", "Mine", NEEDED)


def test_a_module_that_runs_already_is_asked_itself() -> None:
    check_class(__name__, "Late", NEEDED)
    with pytest.raises(InputError, match="Late has no method estimate"):
        check_class(__name__, "Late", {"plan": ["view"], "estimate": ["body"]})
    with pytest.raises(InputError, match="has no class PLANNER"):
        check_class(__name__, "PLANNER", NEEDED)


Late = type("Late", (), {"plan": lambda _self, _view: None})


def test_what_is_called_so_but_takes_other_arguments_is_not_made(tmp_path: Path) -> None:
    """An archive has a `next` as a behaviour has, and is written where one is made."""
    target = tmp_path / "made.tar"
    with pytest.raises(InputError, match=r"TarFile has no method next\(situation\)"):
        load_component("behaviour", "tarfile:TarFile", {"name": str(target), "mode": "w"})
    assert not target.exists()
    for slot in METHODS:
        for method, given in arguments(slot).items():
            assert hasattr(PROTOCOLS[slot], method)
            assert "self" not in given
