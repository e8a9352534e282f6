"""The site of the documentation: what it is made of, and, once it is built, that it holds together.

`make docs-test` builds it and runs what is marked `docs`.
"""

import json
import re
from pathlib import Path

import links
import pytest
import site_of_pages as site


def test_every_page_stands_in_the_menu_and_every_entry_is_a_page() -> None:
    made = set(site.interface_pages(rust=None))
    assert site.in_menu(site.menu()) == {str(page) for page in site.pages()} | made


def test_every_module_of_the_interface_is_there() -> None:
    for modules in site.PYTHON.values():
        for name in modules:
            path = site.ROOT / "python" / Path(*name.split("."))
            forms = (path / "__init__.py", path.with_suffix(".py"), path.with_suffix(".pyi"))
            assert any(form.is_file() for form in forms), name


def test_the_page_of_the_core_leads_to_its_crates_where_there_are_pages_of_them() -> None:
    plain = site.interface_pages(rust=None)["api/rust.md"]
    assert "<code>planning</code>" in plain
    assert "../rust/" not in plain
    linked = site.interface_pages(rust=Path("doc"))["api/rust.md"]
    assert '<a href="../rust/planning/index.html">' in linked
    assert '<a href="../rust/_core/index.html"><code>bindings</code></a>' in linked


def test_a_link_that_leads_nowhere_is_found(tmp_path: Path) -> None:
    (tmp_path / "rust").mkdir()
    (tmp_path / "rust" / "index.html").write_text('<a href="missing.html">')
    (tmp_path / "other.html").write_text('<h1 id="here"></h1>')
    (tmp_path / "index.html").write_text(
        '<a href="other.html#here"><a href="rust/"><a href="https://a.b/c"><a href="#top">'
        '<a href="other.html#gone"><img src="no.png"><script src="//cdn.net/x.js"></script>'
        '<p id="top">'
    )
    assert links.broken(tmp_path) == [
        "index.html: fetches //cdn.net/x.js",
        "index.html: other.html#gone leads nowhere",
        "index.html: no.png leads nowhere",
    ]


CODE = re.compile(r"^```.*?^ *```$|^ {4,}[^-*\s].*?$|`[^`]*`", re.DOTALL | re.MULTILINE)
EMPHASIS = re.compile(r"(?<![\w*])(\*\*?)(?=[^\s*])(?:[^*\n]|\n(?!\s*\n))*?(?<=[^\s*])\1(?![\w*])")


def loose_stars(page: str) -> list[str]:
    """The lines with a star that is not escaped, and neither code nor emphasis nor an item's."""
    text = EMPHASIS.sub("", CODE.sub("code", page.replace("\\*", "")))
    return [line for line in text.splitlines() if "*" in re.sub(r"^\s*\* ", "", line)]


def test_a_star_that_would_begin_or_end_emphasis_is_found() -> None:
    assert loose_stars("by A* and\nfor D*'s sake") == ["by A* and", "for D*'s sake"]
    assert loose_stars("a fresh A*, D* Lite") == ["a fresh A*, D* Lite"]
    assert not loose_stars("* A\\*, *so*, **so**, **not `a * b`**, (*it*), *over\ntwo lines*.")
    assert not loose_stars("```\n2 * 3\n```\n")


def test_no_page_has_a_star_that_markdown_takes_for_emphasis() -> None:
    """The site's Markdown takes the stars of `A*, D*` for a pair; GitHub's does not."""
    texts = {str(page): (site.ROOT / page).read_text() for page in site.pages()}
    texts |= site.interface_pages(rust=None)
    readmes = [p for f in ("rust", "models") for p in (site.ROOT / f).glob("*/README.md")]
    texts |= {str(page.relative_to(site.ROOT)): page.read_text() for page in readmes}
    found = {name: lines for name, text in texts.items() if (lines := loose_stars(text))}
    assert not found


@pytest.mark.docs
def test_the_built_site_has_no_broken_link_and_fetches_nothing() -> None:
    assert (site.SITE / "index.html").is_file(), "`make docs` first"
    assert links.broken(site.SITE) == []


@pytest.mark.docs
@pytest.mark.parametrize("page", ["api/runs.html", "api/mapping.html"])
def test_examples_of_docstrings_are_blocks_of_code(page: str) -> None:
    text = (site.SITE / page).read_text()
    assert '<span class="gp">' in text  # a prompt
    assert "<blockquote>" not in text


@pytest.mark.docs
@pytest.mark.parametrize(
    ("word", "page"),
    [
        ("slalom", "index.html"),
        ("p_sense", "docs/reference/parameters/fog.html"),
        ("plan_footsteps", "api/mapping.html"),
        ("load on the left and the right sole", "api/what_parts_are_given.html"),  # from Rust
        ("target_from_source", "ARCHITECTURE.html"),
    ],
)
def test_what_a_reader_looks_for_is_in_the_index_of_the_search(word: str, page: str) -> None:
    found = json.loads((site.SITE / "search.json").read_text())["items"]
    texts = [f"{one['title']} {one['text']}" for one in found if one["location"].startswith(page)]
    assert any(word in text for text in texts)
