"""Writes docs/reference from the code, or says which of its pages are not what the code says.

python tools/docs/reference.py write
python tools/docs/reference.py check
"""

import argparse
import sys
from pathlib import Path

from treadwell.reference.pages import pages

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "reference"


def stale() -> list[str]:
    """Return the pages that are missing, not what the code says, or no longer made."""
    made = pages()
    there = {str(path.relative_to(FOLDER)): path for path in FOLDER.rglob("*.md")}
    wrong = [
        name for name, text in made.items() if name not in there or there[name].read_text() != text
    ]
    return sorted({*wrong, *(there.keys() - made.keys())})


def write() -> None:
    """Write all pages, and remove those that are no longer made."""
    for name in stale():
        path = FOLDER / name
        text = pages().get(name)
        if text is None:
            path.unlink()
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        print(path)


def main() -> int:
    """Write or check; return 1 where a page is stale."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("verb", choices=("write", "check"))
    if parser.parse_args().verb == "write":
        write()
        return 0
    wrong = stale()
    for name in wrong:
        print(f"{FOLDER / name}: is not what the code says; python tools/docs/reference.py write")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
