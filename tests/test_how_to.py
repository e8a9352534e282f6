"""What the how-to pages show is run, page by page: their files are written, their commands typed.

A block whose first line is `# file: NAME` is a file. A line `$ command` of a console block is
typed into bash in a new folder; it must succeed, unless it ends with `# exits N`.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs" / "how_to").glob("*.md"))
MOST_LINES = 120
"""Two screens."""
STATUS = "__status__"
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def blocks(text: str) -> Iterator[tuple[str, list[str]]]:
    """Language and lines of each fenced block."""
    for language, body in re.findall(r"^```(\w*)[^\n]*\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        yield language, body.splitlines()


def files(text: str) -> dict[str, str]:
    """Name -> content of the files that a page shows."""
    found = {}
    for _, lines in blocks(text):
        named = re.fullmatch(r"(?:#|//) file: ([\w./-]+)", lines[0]) if lines else None
        if named:
            found[named[1]] = "\n".join(lines) + "\n"
    return found


def commands(text: str) -> list[tuple[str, int]]:
    """The commands in order, and the status that each ends with."""
    found = []
    for language, lines in blocks(text):
        for line in lines if language == "console" else []:
            if line.startswith("$ "):
                says = re.search(r"#.*\bexits (\d+)", line)
                found.append((line[2:], int(says[1]) if says else 0))
    return found


def script(typed: list[tuple[str, int]]) -> str:
    """One shell for all: what a command exports, or where it goes, holds for the next."""
    lines = [f"{command}\necho {STATUS} $? >&3" for command, _ in typed]
    return "\n".join(lines) + "\n"


def environment() -> dict[str, str]:
    """The package's own programs first, as in an environment that was activated."""
    programs = Path(sys.executable).parent
    inherited = {key: os.environ[key] for key in os.environ if key != "TREADWELL_CORE"}
    return {**inherited, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}", "COLUMNS": "200"}


def run(text: str, folder: Path) -> list[tuple[str, int, int]]:
    """Command, expected and found status of each; -1 for one that was not reached."""
    for name, content in files(text).items():
        path = folder / name
        assert path.resolve().is_relative_to(folder.resolve()), name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    typed, said = commands(text), folder / ".said"
    log, statuses = folder / ".log", folder / ".statuses"
    said.write_text(script(typed))
    subprocess.run(
        ["bash", "-c", f"exec 3>{statuses} >{log} 2>&1 </dev/null; source {said}"],
        cwd=folder,
        env=environment(),
        check=False,
    )
    found = [int(line.split()[1]) for line in statuses.read_text().splitlines()]
    found += [-1] * (len(typed) - len(found))
    return [(command, wanted, got) for (command, wanted), got in zip(typed, found, strict=True)]


LONG = {"look_at_a_run", "own_robot", "replay", "sweep_and_compare"}
"""Pages whose commands take more than ten seconds."""
TYPED = [pytest.param(p, marks=[pytest.mark.long] * (p.stem in LONG), id=p.stem) for p in PAGES]


@pytest.mark.parametrize("page", TYPED)
def test_the_commands_of_a_page_do_what_it_says(page: Path, tmp_path: Path) -> None:
    wrong = [
        (c, wanted, got) for c, wanted, got in run(page.read_text(), tmp_path) if wanted != got
    ]
    assert not wrong, f"{wrong}\n{(tmp_path / '.log').read_text()[-3000:]}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_is_short_and_has_commands_and_links_that_lead_somewhere(page: Path) -> None:
    text = page.read_text()
    assert len(text.splitlines()) <= MOST_LINES
    assert commands(text)
    links = re.findall(r"\]\(([^)#]+)[^)]*\)", text)
    assert not [link for link in links if "://" not in link and not (page.parent / link).exists()]


def test_there_are_pages() -> None:
    assert {"own_planner", "own_part", "own_part_in_rust", "gymnasium"} <= {p.stem for p in PAGES}


def test_a_command_that_fails_is_found_and_one_that_may_is_not(tmp_path: Path) -> None:
    text = """
```python
# file: sub/hello.py
print("hello")
```
```console
$ export NAME=sub
what is printed
$ python $NAME/hello.py | grep hello
$ false  # exits 1
$ false
$ true  # exits 2
```
"""
    ends = [(wanted, got) for _, wanted, got in run(text, tmp_path)]
    assert ends == [(0, 0), (0, 0), (1, 1), (0, 1), (2, 0)]
    assert files(text) == {"sub/hello.py": '# file: sub/hello.py\nprint("hello")\n'}
