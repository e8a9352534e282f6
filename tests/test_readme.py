"""What the pages tell a reader to type exists, and what they lead to is there."""

import re
import shlex
from pathlib import Path

import pytest

import treadwell
from treadwell import mapping
from treadwell.cli.app import execute

ROOT = Path(__file__).resolve().parent.parent
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
README = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def commands(program: str) -> list[list[str]]:
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    words = [shlex.split(line, comments=True) for line in lines]
    return [found[1:] for found in words if found and found[0] == program]


def test_the_readme_shows_the_commands_a_newcomer_needs() -> None:
    assert ["demo"] in commands("make")
    assert ["test"] in commands("make")
    assert {"run", "list", "check", "verify", "inspect"} <= {
        words[0] for words in commands("treadwell")
    }


@pytest.mark.parametrize("target", [words[0] for words in commands("make")])
def test_a_make_target_exists(target: str) -> None:
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)


# The bench takes half a minute.
LONG = {"bench": [pytest.mark.long]}


@pytest.mark.parametrize(
    "words",
    [pytest.param(words, marks=LONG.get(words[0], [])) for words in commands("treadwell")],
    ids=" ".join,
)
def test_a_command_is_understood(words: list[str], tmp_path: Path) -> None:
    """Runs are checked; what needs a run or a file of the reader's, or serves, shows its help."""
    own = [word for word in words[1:] if word.startswith("runs/") or word == "my_course.toml"]
    if own or words[0] == "serve":
        assert execute([*words, "--help"]) == 0
    elif words[0] == "run":
        assert execute(["check", *words[1:]]) == 0
    else:
        assert execute(words) == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_link_leads_somewhere(page: Path) -> None:
    links = re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text())
    missing = [link for link in links if "://" not in link and not (page.parent / link).exists()]
    assert not missing


def test_the_names_in_the_python_example_exist() -> None:
    (example,) = blocks("python")
    names = set(re.findall(r"treadwell\.([a-zA-Z_]+)\(", example))
    assert names == {"run", "Episode", "sweep", "compare"}
    assert all(hasattr(treadwell, name) for name in names)
    of_library = set(re.findall(r"mapping\.([a-zA-Z_]+)\(", example))
    assert of_library == {"Camera", "Map", "find_stairs", "plan"} <= set(mapping.__all__)
    for part in re.findall(r"step\.(\w+)", example):
        from treadwell.episode import Step

        assert part in Step.__annotations__


def test_the_scenario_of_the_readme_is_one(tmp_path: Path) -> None:
    (example,) = blocks("toml")
    path = tmp_path / "two_boxes.toml"
    path.write_text(example)
    assert execute(["check", str(path), "--seed", "3"]) == 0
