"""The pages of `docs/results`: what a subject's JSON must hold, and the Markdown made from it."""

import json
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from treadwell.reference.words import escaped

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "results"
INTRODUCTION = """# Results

What was measured last, one page a subject: figure, what was wanted, seeds, command, commit, date.
A figure in bold misses what was wanted. How the figures came about, with older counts and what went
wrong, is told in [docs/history](../history/README.md).

- **Noise and seeds**: all noise is on and the seeds were not tuned on, unless a table says
  otherwise. Development seeds are those that were looked at while the code was written.
- **Rare events**: of a rate of which nothing was seen in n trials, the upper 95 % bound is about
  3/n.
- **Single seeds**: one seed is one result on one kind of processor; counts over many seeds are not
  touched by this ([why](../decisions/one_seed_one_processor.md)).
- **Machine**: 2 cores of a shared x86-64 server (AMD EPYC), 24 GB, no GPU; Rust 1.95, release
  build; MuJoCo 4.0.1. Others used it at the same time: ratios that were taken in one run say more
  than absolute times.

These pages are generated: `python tools/docs/results.py render` makes them from the JSON files
beside them, and measuring commands write those ([how](../../CONTRIBUTING.md#measuring)).
Commands other than `treadwell`, and files in `benches`, `tests` and `rust`, are of a clone.
"""

Text = Annotated[str, Field(min_length=1)]
Day = Annotated[str, Field(pattern=r"^\d{4}-\d\d-\d\d$")]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Row(_Strict):
    """A figure. Command, seeds, commit and date are given where they are not the table's."""

    what: Text
    measured: Text | dict[str, str]
    """One figure, or one for each column."""
    wanted: Text | None = None
    command: Text | None = None
    seeds: Text | None = None
    commit: Text | None = None
    date: Day | None = None


class Table(_Strict):
    """Figures that one command measured."""

    title: Text
    command: Text | None = None
    commit: Text | None = None
    date: Day | None = None
    seeds: Text | None = None
    note: Text | None = None
    missing: Text | None = None
    """Why command or commit is not given."""
    rows: Annotated[list[Row], Field(min_length=1)]

    @model_validator(mode="after")
    def _says_where_from(self) -> "Table":
        for row in self.rows:
            known = (row.command or self.command) and (row.commit or self.commit)
            if not known and not self.missing:
                raise ValueError(f"{row.what!r} needs command and commit, or `missing` says why")
        return self


class Picture(_Strict):
    """A picture, by its path from the page."""

    file: Text
    shows: Text


class Subject(_Strict):
    """A page."""

    schema_: Literal["treadwell.results/1"] = Field(alias="schema")
    subject: Text
    title: Text
    about: Text
    tables: list[Table]
    pictures: list[Picture] | None = None


def subjects(folder: Path = FOLDER) -> list[str]:
    """Return the subjects that there are."""
    return sorted(path.stem for path in folder.glob("*.json"))


def load(subject: str, folder: Path = FOLDER) -> Subject:
    """Read a subject's file.

    Raises:
        ValueError: there is no such subject, or its file is not as it must be.
    """
    path = folder / f"{subject}.json"
    if not path.is_file():
        known = ", ".join(subjects(folder))
        raise ValueError(f"there is no {path.name} in {folder}; there are {known}")
    try:
        made = Subject.model_validate_json(path.read_text(encoding="utf-8"))
    except ValidationError as error:
        raise ValueError(f"{path.name}: {error}") from None
    if made.subject != subject:
        raise ValueError(f"{path.name}: subject must be {subject!r}, got {made.subject!r}")
    return made


def save(page: Subject, folder: Path = FOLDER) -> None:
    """Write a subject's file."""
    document = page.model_dump(by_alias=True, exclude_none=True)
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    (folder / f"{page.subject}.json").write_text(text, encoding="utf-8")


def markdown(page: Subject) -> str:
    """Return a subject as its page."""
    lines = [
        f"# {page.title}",
        "",
        f"<!-- Made from {page.subject}.json by tools/docs/results.py: change that, not this. -->",
        "",
        page.about,
    ]
    for table in page.tables:
        lines += ["", f"## {table.title}", "", _source(table), "", *_grid(table)]
    if page.pictures:
        lines += ["", *(f"![{picture.shows}]({picture.file})" for picture in page.pictures)]
    return escaped("\n".join(lines) + "\n")


def index(folder: Path = FOLDER) -> str:
    """Return the page that leads to all others."""
    pages = [load(subject, folder) for subject in subjects(folder)]
    rows = [f"| [{page.title}]({page.subject}.md) | {_cell(page.about)} |" for page in pages]
    lines = ["", "| subject | what it holds |", "| --- | --- |", *rows, ""]
    return INTRODUCTION + escaped("\n".join(lines))


def _source(table: Table) -> str:
    """Return where a table's figures are from, as one paragraph of a line."""
    said = [f"`{table.command}`."] if table.command else []
    said += [f"Seeds {table.seeds}."] if table.seeds else []
    said += [f"Commit {_commit(table.commit, table.date)}."] if table.commit else []
    said += [f"Recorded {table.date}."] if table.date and not table.commit else []
    return " ".join([*said, *filter(None, (table.missing, table.note))])


def _commit(name: str | None, date: str | None) -> str:
    short, _, rest = (name or "").partition(" ")
    return ", ".join(filter(None, (f"`{short}` {rest}".strip() if short else "", date)))


def _grid(table: Table) -> list[str]:
    """Return a table's lines; a column that would be empty is left out."""
    figures = [_figures(row) for row in table.rows]
    names = list(dict.fromkeys(name for row in figures for name in row))
    columns: dict[str, list[str]] = {"what": [row.what for row in table.rows]}
    columns |= {name: [row.get(name, "") for row in figures] for name in names}
    columns["wanted"] = [row.wanted or "" for row in table.rows]
    columns["seeds"] = [row.seeds or "" for row in table.rows]
    columns["commit"] = [_commit(row.commit, row.date) for row in table.rows]
    columns["command"] = [f"`{row.command}`" if row.command else "" for row in table.rows]
    shown = {name: cells for name, cells in columns.items() if any(cells)}
    head = ["| " + " | ".join(shown) + " |", "| " + " | ".join("---" for _ in shown) + " |"]
    rows = zip(*shown.values(), strict=True)
    return head + ["| " + " | ".join(_cell(text) or "-" for text in row) + " |" for row in rows]


def _figures(row: Row) -> dict[str, str]:
    return {"measured": row.measured} if isinstance(row.measured, str) else row.measured


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
