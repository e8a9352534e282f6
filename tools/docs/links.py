"""Whether every link of a built site leads somewhere, and whether a page fetches anything.

python tools/docs/links.py build/site
"""

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}
"""What a browser fetches by itself; of `link` not all, but none may lead away."""


class Page(HTMLParser):
    """A page's anchors, where its links lead, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take in one tag."""
        values = {name: value for name, value in attrs if value is not None}
        self.anchors |= {values[key] for key in ("id", "name") if key in values}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag in LOADED and LOADED[tag] in values:
            self.loaded.append(values[LOADED[tag]])


@cache
def read(path: Path) -> Page:
    """Return a page of the site."""
    return Page(path.read_text(encoding="utf-8"))


def broken(site: Path, leave_out: tuple[str, ...] = ("rust",)) -> list[str]:
    """Return a sentence for each link or picture that leads nowhere, and for what is fetched.

    Args:
        site: folder of the built site.
        leave_out: folders at its top whose own pages others wrote; links to them are followed.
    """
    found = []
    for path in sorted(site.rglob("*.html")):
        name = path.relative_to(site)
        if name.parts[0] in leave_out or name.name == "404.html":  # 404's links start at a server
            continue
        page = read(path)
        found += [f"{name}: fetches {one}" for one in page.loaded if urlsplit(one).netloc]
        wrong = [one for one in (*page.links, *page.loaded) if not _leads(one, path)]
        found += [f"{name}: {one} leads nowhere" for one in dict.fromkeys(wrong)]
    return found


def _leads(link: str, path: Path) -> bool:
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return True  # nobody asks the network
    target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
    if target.is_dir():
        target /= "index.html"
    if not target.is_file():
        return False
    anchor = unquote(parts.fragment)
    return not anchor or target.suffix != ".html" or anchor in read(target).anchors


def main() -> int:
    """Say what is broken; return 1 where something is."""
    found = broken(Path(sys.argv[1]))
    sys.stdout.write("".join(f"{sentence}\n" for sentence in found))
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
