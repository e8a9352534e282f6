"""The site of the documentation: what it is made of, and, once it is built, that it holds together.

`make docs-test` builds it and runs what is marked `docs`.
"""

import json
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
