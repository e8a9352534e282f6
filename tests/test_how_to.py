"""What how-to pages and tutorial show is run, page by page: files are written, commands typed.

A block whose first line is `# file: NAME` is a file. A line `$ command` of a console block is
typed into bash in a new folder; it must succeed, unless it ends with `# exits N`. Lines below it
are what it prints, with any numbers; `...` stands for anything. A command that ends with
`# takes ...` is left to `make docs-test`, and so is what needs its `--out`.
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
TUTORIAL = sorted((ROOT / "docs" / "tutorial").glob("[0-9]*.md"))
MOST_LINES = 120
"""Two screens."""
MOST_LINES_OF_TUTORIAL = 150
"""Programs stand there whole, with what they print."""
STATUS = "__status__"
MENAGERIE = Path(os.environ.get("TREADWELL_DATA", "")).resolve() / "robots"
"""Models of a public collection, which are no part of the project."""
ON_MENAGERIE = {"robot_from_a_collection"}
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


def quick(typed: list[tuple[str, int]]) -> list[tuple[str, int]]:
    """The commands that take no time, and need nothing that others leave."""
    found, left_out = [], set()
    for command, status in typed:
        words = command.partition("  #")[0].split()
        if re.search(r"#.*\btakes\b", command) or left_out & {word.split("/")[0] for word in words}:
            if "--out" in words:
                left_out.add(words[words.index("--out") + 1].split("/")[0])
        else:
            found.append((command, status))
    return found


def shown(text: str) -> list[tuple[str, list[str]]]:
    """The commands, and the lines that a page shows below each."""
    found: list[tuple[str, list[str]]] = []
    for language, lines in blocks(text):
        for line in lines if language == "console" else []:
            if line.startswith("$ "):
                found.append((line[2:], []))
            elif found:
                found[-1][1].append(line)
    return found


def not_printed(lines: list[str], printed: str) -> list[str]:
    """The lines of a page that a command did not print, in their order; numbers may differ."""
    said = [plain(line) for line in printed.splitlines()]
    missing = []
    for line in lines:
        parts = [re.escape(plain(part)) for part in line.split("...")]
        wanted = re.compile(r".*".join(parts))
        at = next((i for i, one in enumerate(said) if wanted.fullmatch(one)), None)
        if at is None:
            missing.append(line)
        elif line.strip() != "...":
            said = said[at + 1 :]
    return missing


def plain(line: str) -> str:
    """A line without its numbers, and with single spaces."""
    return re.sub(r"\d+(?:\.\d+)?", "0", " ".join(line.split()))


def script(typed: list[tuple[str, int]]) -> str:
    """One shell for all: what a command exports, or where it goes, holds for the next."""
    lines = [f"{command}\necho {STATUS} $? >&3; echo {STATUS}" for command, _ in typed]
    return "\n".join(lines) + "\n"


def environment() -> dict[str, str]:
    """The package's own programs first, as in an environment that was activated."""
    programs = Path(sys.executable).parent
    inherited = {key: os.environ[key] for key in os.environ if key != "TREADWELL_CORE"}
    ours = {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}", "COLUMNS": "200"}
    return {**inherited, **ours, "MENAGERIE": str(MENAGERIE)}


def run(text: str, folder: Path, *, long: bool = True) -> list[tuple[str, int, int]]:
    """Command, expected and found status of each; -1 for one that was not reached."""
    for name, content in files(text).items():
        path = folder / name
        assert path.resolve().is_relative_to(folder.resolve()), name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    typed, said = commands(text) if long else quick(commands(text)), folder / ".said"
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


LONG = {
    "add_world_model",
    "known_map",
    "look_at_a_run",
    "map_your_data",
    "own_planner",
    "own_robot",
    "replay",
    "robot_from_a_collection",
    "sweep_and_compare",
    "test_with_pytest",
}
"""Pages whose commands take more than ten seconds."""
TYPED = [pytest.param(p, marks=[pytest.mark.long] * (p.stem in LONG), id=p.stem) for p in PAGES]


@pytest.mark.parametrize("page", TYPED)
def test_the_commands_of_a_page_do_what_it_says(page: Path, tmp_path: Path) -> None:
    if page.stem in ON_MENAGERIE and not (MENAGERIE / "booster_t1").is_dir():
        pytest.skip("TREADWELL_DATA does not say where robots/booster_t1 is")
    wrong = [
        (c, wanted, got) for c, wanted, got in run(page.read_text(), tmp_path) if wanted != got
    ]
    assert not wrong, f"{wrong}\n{(tmp_path / '.log').read_text()[-3000:]}"


def check_tutorial(page: Path, folder: Path, *, long: bool) -> None:
    """Fail where a command ends otherwise than a page says, or prints other words."""
    text = page.read_text()
    found = run(text, folder, long=long)
    log = (folder / ".log").read_text()
    assert not [one for one in found if one[1] != one[2]], f"{found}\n{log[-3000:]}"
    printed = dict(zip([one[0] for one in found], log.split(f"{STATUS}\n"), strict=False))
    for command, lines in shown(text):
        if command in printed:
            missing = not_printed(lines, printed[command])
            assert not missing, f"{page.name}: {command}: {missing} not in\n{printed[command]}"


@pytest.mark.parametrize("page", TUTORIAL, ids=lambda page: page.stem)
def test_the_quick_commands_of_the_tutorial_print_what_it_says(page: Path, tmp_path: Path) -> None:
    check_tutorial(page, tmp_path, long=False)


@pytest.mark.docs
@pytest.mark.parametrize("page", TUTORIAL, ids=lambda page: page.stem)
def test_all_commands_of_the_tutorial_print_what_it_says(page: Path, tmp_path: Path) -> None:
    check_tutorial(page, tmp_path, long=True)


@pytest.mark.parametrize("page", [*PAGES, *TUTORIAL], ids=lambda page: page.stem)
def test_a_page_is_short_and_has_commands_and_links_that_lead_somewhere(page: Path) -> None:
    text = page.read_text()
    most = MOST_LINES_OF_TUTORIAL if page in TUTORIAL else MOST_LINES
    assert len(text.splitlines()) <= most
    assert commands(text)
    links = re.findall(r"\]\(([^)#]+)[^)]*\)", text)
    assert not [link for link in links if "://" not in link and not (page.parent / link).exists()]


def test_there_are_pages() -> None:
    assert {"own_planner", "own_part", "own_part_in_rust", "gymnasium"} <= {p.stem for p in PAGES}
    assert [page.stem[0] for page in TUTORIAL] == list("123456")


def test_what_takes_long_and_what_needs_it_are_no_quick_commands() -> None:
    typed = ["a --out x  # takes a minute", "b x", "c", "d x/y --out z", "e z", "f --out w", "g w"]
    assert [one for one, _ in quick([(one, 0) for one in typed])] == ["c", "f --out w", "g w"]


def test_a_line_that_is_not_printed_is_found() -> None:
    printed = "outcome   goal_reached\n  time 3.2 s\n"
    assert not_printed(["...", "  outcome goal_reached", "time 14 s"], printed) == []
    assert not_printed(["out... goal_reached", "...", "time 1 s"], printed) == []
    assert not_printed(["outcome fell"], printed) == ["outcome fell"]
    assert not_printed(["time 1 s", "outcome goal_reached"], printed) == ["outcome goal_reached"]


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
