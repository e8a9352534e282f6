"""Builds the documentation as one site of plain files: `make docs`.

    python tools/docs/site_of_pages.py                # into build/site; it opens from the disk, too
    python tools/docs/site_of_pages.py --rust FOLDER  # with what `cargo doc` made in FOLDER

Pages are copied side by side as they lie in the repository, so that every link between them is
right in both places. A page that stands in no folder of the menu, a link that leads nowhere and
a name of the interface that is no longer there end the build. What a built page would fetch from
elsewhere is replaced by a copy: the site needs no network, neither to be built nor to be read.
"""

import argparse
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
SITE = BUILD / "site"
STAGE = BUILD / "site_source"
CONFIG = Path(__file__).with_name("mkdocs.yml")
HOME = "README.md"

FOLDERS = {
    "Tutorial": "docs/tutorial",
    "How to": "docs/how_to",
    "Papers": "docs/papers",
    "Reference": "docs/reference",
    "Results": "docs/results",
}
"""Entries of the menu that are a folder each, in their order."""
ABOUT = ("ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/release.md")
ABOUT_FOLDERS = {"Decisions": "docs/decisions", "History": "docs/history"}

PYTHON = {
    "Runs": ("treadwell", "treadwell.runner", "treadwell.episode", "treadwell.replaying.replay"),
    "Parts of your own": ("treadwell.protocols",),
    "What parts are given": ("treadwell._core", "treadwell.observation"),
    "Mapping": ("treadwell.mapping",),
    "Costs of ground": ("treadwell.costs",),
    "Maps of data": ("treadwell.map_making.making", "treadwell.map_making.request"),
    "Sources of data": ("treadwell.sources.source", "treadwell.sources.frame"),
    "Results": ("treadwell.judging.result", "treadwell.map_result"),
    "Scenarios": ("treadwell.scenario.model", "treadwell.scenario.loading"),
    "Sweeps": ("treadwell.sweeps.conduct", "treadwell.sweeps.request"),
    "Comparisons": ("treadwell.comparing.comparison", "treadwell.comparing.statistics"),
    "Exports": ("treadwell.exports.export",),
    "Gymnasium": ("treadwell.environment", "treadwell.environment.course_env"),
    "pytest": ("treadwell.pytest_plugin",),
    "Errors": ("treadwell.errors",),
}
"""Pages of the interface in Python, and the modules that each shows."""
MEMBERS = {
    "treadwell": "false",
    "treadwell._core": "[BodyState, Scan, Planes, FloorView, Goal, Situation, Staircase, Stair, "
    "Climb, Stepping, Step]",
}
"""Of a module that shows more than a reader calls, what is shown."""

WITHOUT_RUST = """
`make docs RUST=1` adds the pages of each, which takes minutes; `cargo doc --no-deps --open` shows
them alone.
"""
RUST_PAGE = """# The core in Rust

Crates of the core, from the ground up: each may use those above it.
{said}
[How they fit together](../ARCHITECTURE.md);
[a part of your own in Rust](../docs/how_to/own_part_in_rust.md).

| crate | what it is for |
| --- | --- |
{rows}
"""

ROOM_FOR_MEANINGS = (
    "<style>.md-typeset table:not([class]) :is(th, td) { min-width: 2rem; padding: 0.6em; } "
    ".md-typeset table:not([class]) td:nth-child(5) { min-width: 11rem; }</style>\n\n"
)
"""Before the pages of the reference: else long defaults leave their fifth column a word's width."""

FETCHED = {"https://unpkg.com/iframe-worker/shim": "assets/iframe-worker.js"}
"""What built pages would load from elsewhere, and where the site has its copy."""

Menu = list[dict[str, "str | Menu"] | str]


def pages() -> list[Path]:
    """Return every page of the repository that the site has, from its top."""
    top = [Path(HOME), *map(Path, ABOUT)]
    return top + sorted(path.relative_to(ROOT) for path in (ROOT / "docs").rglob("*.md"))


def stage(rust: Path | None) -> None:
    """Copy pages and what they lead to, and write the pages that nobody keeps."""
    shutil.rmtree(STAGE, ignore_errors=True)
    for page in pages():
        for name in (page, *_led_to(page)):
            _copy(name)
    for page in (STAGE / "docs/reference").rglob("*.md"):
        page.write_text(ROOM_FOR_MEANINGS + page.read_text(encoding="utf-8"), encoding="utf-8")
    shutil.copy(CONFIG.with_name("site.css"), STAGE / "site.css")
    for name, text in interface_pages(rust).items():
        (STAGE / name).parent.mkdir(parents=True, exist_ok=True)
        (STAGE / name).write_text(text, encoding="utf-8")


def _led_to(page: Path) -> list[Path]:
    """Return the files other than pages that a page shows or links to."""
    text = (ROOT / page).read_text(encoding="utf-8")
    targets = [t for t in re.findall(r"\]\(([^)#\s]+)", text) if "://" not in t]
    found = [(ROOT / page.parent / target).resolve() for target in targets]
    return [p.relative_to(ROOT) for p in found if p.is_file() and p.suffix != ".md"]


def _copy(name: Path) -> None:
    (STAGE / name).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(ROOT / name, STAGE / name)


def interface_pages(rust: Path | None) -> dict[str, str]:
    """Return name and text of the pages of both interfaces."""
    made = {}
    for title, modules in PYTHON.items():
        shown = "\n".join(map(_module, modules))
        made[f"api/{_slug(title)}.md"] = f"# {title}\n\n{shown}"
    made["api/rust.md"] = _rust_page(rust)
    return made


SAID = {"treadwell._core": "All are in `treadwell.protocols`, too: import them from there."}
"""What a module's page says before anything else."""


def _module(name: str) -> str:
    chosen = f"    options:\n      members: {MEMBERS[name]}\n" if name in MEMBERS else ""
    said = f"{SAID[name]}\n\n" if name in SAID else ""
    return f"## `{name}`\n\n{said}::: {name}\n{chosen}"


def _rust_page(rust: Path | None) -> str:
    """Return the page of the crates: name and what each is for, as its first line says."""
    members = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["members"]
    rows = []
    for folder in map(Path, members):
        said = _first_paragraph((ROOT / folder / "src" / "lib.rs").read_text(encoding="utf-8"))
        name = f"<code>{folder.name}</code>"
        if rust:  # no page of the site, so no link of Markdown
            manifest = tomllib.loads((ROOT / folder / "Cargo.toml").read_text())
            library = manifest.get("lib", {}).get("name", folder.name)
            name = f'<a href="../rust/{library}/index.html">{name}</a>'
        rows.append(f"| {name} | {said} |")
    return RUST_PAGE.format(said="" if rust else WITHOUT_RUST, rows="\n".join(rows))


def _first_paragraph(source: str) -> str:
    """Return what a crate says of itself first, without rustdoc's links."""
    lines = itertools.takewhile(lambda line: line.startswith("//! "), source.splitlines())
    said = " ".join(line.removeprefix("//!").strip() for line in lines)
    said = re.sub(r"(?<=[A-Z])\*", r"\\*", said)  # of A*: it is no emphasis
    return re.sub(r"\[(`[^`]+`)\](?:\([^)]*\))?", r"\1", said).replace("|", "\\|")


def _slug(title: str) -> str:
    return title.lower().replace(" ", "_")


def menu() -> Menu:
    """Return the menu: every page stands in it."""
    entries: Menu = [{"Home": HOME}]
    entries += [{title: pages} for title, f in FOLDERS.items() if (pages := _folder(Path(f)))]
    python: Menu = [{title: f"api/{_slug(title)}.md"} for title in PYTHON]
    entries.append({"API": [{"Python": python}, {"Rust": "api/rust.md"}]})
    about: Menu = list(ABOUT)
    about += [{title: _folder(Path(folder))} for title, folder in ABOUT_FOLDERS.items()]
    entries.append({"About": about})
    return entries


def _folder(folder: Path) -> Menu:
    """Return a folder's pages, its README first, and then the folders in it."""
    names = sorted((ROOT / folder).glob("*.md"), key=lambda path: (path.name != HOME, path.name))
    entries: Menu = [str(path.relative_to(ROOT)) for path in names]
    inner = sorted(path.parent for path in (ROOT / folder).glob("*/*.md"))
    for path in dict.fromkeys(inner):
        entries.append({path.name.capitalize(): _folder(path.relative_to(ROOT))})
    return entries


def in_menu(entries: Menu) -> set[str]:
    """Return every page that stands in a menu."""
    found: set[str] = set()
    for entry in entries:
        for value in entry.values() if isinstance(entry, dict) else [entry]:
            found |= {value} if isinstance(value, str) else in_menu(value)
    return found


def build(rust: Path | None) -> None:
    """Stage, and build the site.

    Args:
        rust: the folder that `cargo doc` left; None: the site goes without it.

    Raises:
        ValueError: a page stands in no folder of the menu, or something is missing, with a line
            for each.
    """
    outside = sorted({str(page) for page in pages()} - in_menu(menu()))
    if outside:
        raise ValueError(f"no folder of the menu in {Path(__file__).name} has {outside}")
    stage(rust)
    config = BUILD / "mkdocs.yml"
    config.write_text(json.dumps(configuration(), indent=1))  # all JSON is YAML
    shutil.rmtree(SITE, ignore_errors=True)
    words = [sys.executable, "-m", "zensical", "build", "--strict", "--clean", "-f", str(config)]
    found = {**os.environ, "PYTHONPATH": str(CONFIG.parent)}  # the extension of the interface
    done = subprocess.run(words, cwd=BUILD, env=found, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError(done.stdout + done.stderr)
    keep_to_itself()
    if rust:
        shutil.copytree(rust, SITE / "rust", ignore=shutil.ignore_patterns(".lock"))


def configuration() -> dict[str, object]:
    """Return what the builder is told beside `mkdocs.yml`."""
    paths = [str(ROOT / "python")]
    return {
        "INHERIT": str(CONFIG),
        "docs_dir": STAGE.name,
        "site_dir": SITE.name,
        "nav": menu(),
        "plugins": {"mkdocstrings": {"handlers": {"python": {"paths": paths}}}},
    }


def keep_to_itself() -> None:
    """Let the built pages load their scripts from the site alone."""
    for name in FETCHED.values():
        shutil.copy(CONFIG.parent / "vendor" / Path(name).name, SITE / name)
    for page in SITE.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        up = "../" * (len(page.relative_to(SITE).parts) - 1)
        for fetched, kept in FETCHED.items():
            text = text.replace(f'"{fetched}"', f'"{up}{kept}"')
        page.write_text(text, encoding="utf-8")


def main() -> int:
    """Build the site and say where it is."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--rust", type=Path, help="the folder `doc` that `cargo doc` left")
    try:
        build(parser.parse_args().rust)
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    print(SITE / "index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
