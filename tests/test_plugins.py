"""Finding a user's class by `package.module:Class`."""

from pathlib import Path

import pytest
from user_parts import PARTS, Straight

from treadwell.errors import InputError
from treadwell.plugins import METHODS, check_component, load_component

PLANNER = "class Planner:\n    def plan(self, *given): ...\n"


@pytest.mark.parametrize("slot", METHODS)
def test_a_class_is_found_and_made(slot: str) -> None:
    kind = PARTS[slot]
    assert type(load_component(slot, f"user_parts:{kind.__name__}", {})).__name__ == kind.__name__


def test_parameters_are_keyword_arguments() -> None:
    made = load_component("planner", "user_parts:Straight", {"points": 9})
    assert getattr(made, "points", None) == 9


def test_a_module_that_fails_on_import_is_bad_input_with_its_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "halfway.py").write_text(f"import nothing_of_that_name\n{PLANNER}")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r"navigation\.planner: cannot import halfway: .*nothing_"):
        load_component("planner", "halfway:Planner", {})


def test_an_attribute_that_is_no_class_is_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "number.py").write_text("Planner = 3\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match="number has no class Planner"):
        load_component("planner", "number:Planner", {})


def test_a_module_that_leaves_ends_nothing_but_is_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "leaving.py").write_text(f"import sys\nsys.exit(0)\n{PLANNER}")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match="cannot import leaving: SystemExit"):
        load_component("planner", "leaving:Planner", {})


def test_a_class_that_is_no_component_is_not_called(tmp_path: Path) -> None:
    """Else a scenario file could run any program."""
    made = tmp_path / "made"
    with pytest.raises(InputError, match="subprocess:Popen: Popen has no method plan"):
        load_component("planner", "subprocess:Popen", {"args": ["touch", str(made)]})
    with pytest.raises(InputError, match="subprocess has no class run"):
        load_component("planner", "subprocess:run", {"args": ["touch", str(made)]})
    assert not made.exists()


def test_a_missing_method_is_named() -> None:
    check_component("planner", Straight())
    with pytest.raises(InputError, match="localizer: Straight has no method correct, estimate"):
        check_component("localizer", Straight())
