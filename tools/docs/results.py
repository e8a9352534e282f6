"""The measured figures: one JSON file a subject in `docs/results`, and the pages made from them.

    python tools/docs/results.py render          # write every page and the index
    python tools/docs/results.py check           # 1 when a page is not what its JSON says
    python tools/docs/results.py take SUBJECT TITLE --from FILE   # a table from what `--json` wrote

`take` reads what `treadwell experiment`, `sweep`, `compare` and `bench` write with `--json`;
without `--from` it reads standard input. TITLE is the table's title; of an experiment and of a
comparison it also chooses the table. The scripts in `benches` write their own rows: `--results
SUBJECT` calls `record`.

A table says what was measured last. `record` replaces the table of the same title, fills in commit
and date, and keeps what is wanted of a row that has the same words; how a figure came about is told
in `docs/history`.
"""

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from documents import rows_of
from pages import FOLDER, Row, Table, index, load, markdown, save, subjects

ROOT = Path(__file__).resolve().parents[2]
LONGEST_PAGE = 100
INDEX = "README.md"


def render(folder: Path = FOLDER) -> Iterator[tuple[Path, str]]:
    """Yield every page's path and what it must say."""
    for subject in subjects(folder):
        yield folder / f"{subject}.md", markdown(load(subject, folder))
    yield folder / INDEX, index(folder)


def wrong_pages(folder: Path = FOLDER) -> list[str]:
    """Return what is wrong with the pages, a sentence each."""
    made = dict(render(folder))
    found = []
    for path, text in made.items():
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            found.append(
                f"{path.name} is not what its JSON says: python tools/docs/results.py render"
            )
        if len(text.splitlines()) > LONGEST_PAGE:
            found.append(f"{path.name} has more than {LONGEST_PAGE} lines: split the subject")
    found += [f"{path.name} has no JSON" for path in folder.glob("*.md") if path not in made]
    return found


def record(
    subject: str,
    table_title: str,
    command: str,
    seeds: str | None,
    rows: Sequence[dict[str, Any]],
    *,
    note: str | None = None,
    commit: str | None = None,
    folder: Path = FOLDER,
) -> None:
    """Write a table into a subject's file and its pages, in place of the one of the same title.

    Args:
        subject: whose file; it must be there.
        table_title: of the table to replace, or of a new one at the end.
        command: what repeats the measurement.
        seeds: that were used, as a reader would type them.
        rows: each with `what` and `measured`, perhaps `wanted`.
        note: one sentence that a reader needs beside the table.
        commit: that was measured; by default what is checked out now.
        folder: where the files are.

    Raises:
        ValueError: there is no such subject, or a row is not as it must be.
    """
    page = load(subject, folder)
    titles = [table.title for table in page.tables]
    before = page.tables[titles.index(table_title)].rows if table_title in titles else []
    wanted = {row.what: row.wanted for row in before}
    table = Table(
        title=table_title,
        command=command,
        commit=commit or checked_out(),
        date=datetime.now(UTC).date().isoformat(),
        seeds=seeds,
        note=note,
        rows=[Row(**{"wanted": wanted.get(str(row["what"]))} | row) for row in rows],
    )
    if table_title in titles:
        page.tables[titles.index(table_title)] = table
    else:
        page.tables.append(table)
    save(page, folder)
    _write(folder)


def checked_out(root: Path = ROOT) -> str:
    """Return the commit that is checked out, and whether what was measured differs from it."""
    short = _git(root, "rev-parse", "--short=7", "HEAD")
    changed = _git(root, "status", "--porcelain", "--", ".", ":!docs/results")
    return f"{short} with uncommitted changes" if changed else short


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _write(folder: Path) -> None:
    for path, text in render(folder):
        path.write_text(text, encoding="utf-8")


def _take(asked: argparse.Namespace) -> None:
    text = sys.stdin.read() if asked.file is None else asked.file.read_text(encoding="utf-8")
    taken = rows_of(json.loads(text), asked.title)
    command, seeds = asked.command or taken.command, asked.seeds or taken.seeds
    if not command:
        raise ValueError("this document does not say what command wrote it: give --command")
    record(asked.subject, asked.title, command, seeds, taken.rows)


def main(words: Sequence[str] | None = None) -> int:
    """Do what a verb asks for; 1 where a page is wrong, 2 where something asked for is bad."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    verbs.add_parser("render", help="write every page and the index")
    verbs.add_parser("check", help="say which page is not what its JSON says")
    take = verbs.add_parser("take", help="write a table from what a command's --json wrote")
    take.add_argument("subject")
    take.add_argument("title", help="of the table; of an experiment, one of its tables")
    take.add_argument("--from", dest="file", type=Path, help="file; standard input without it")
    take.add_argument("--command", help="what repeats it, where the document does not say")
    take.add_argument("--seeds", help="that were used, where the document does not say")
    asked = parser.parse_args(words)
    try:
        if asked.verb == "take":
            _take(asked)
        elif asked.verb == "render":
            _write(FOLDER)
        else:
            found = wrong_pages()
            sys.stdout.write("".join(f"{sentence}\n" for sentence in found))
            return int(bool(found))
    except (ValueError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
