"""The page: sections put into the template. No script, nothing from outside, everything escaped."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from treadwell.errors import RecordingError
from treadwell.files import write_text
from treadwell.reporting.sections import RunSection
from treadwell.reporting.sweep_section import SweepSection

NAME: Final = "report.html"
_TEMPLATES: Final = Path(__file__).resolve().parent / "templates"


def page(runs: Sequence[RunSection], sweeps: Sequence[SweepSection]) -> str:
    """Return the page of runs and sweeps, what failed before what passed."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from treadwell.version import __version__

    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    ordered = sorted(runs, key=lambda run: run.passed)
    words: dict[str, Any] = {
        "title": _title(runs, sweeps),
        "runs": ordered,
        "sweeps": sweeps,
        "version": __version__,
        "passed": sum(run.passed for run in runs),
        "index": len(runs) > 1 or (bool(sweeps) and bool(runs)),
    }
    return environment.get_template("report.html.j2").render(words)


def write_page(path: Path, text: str) -> None:
    """Write the page whole or not at all.

    Raises:
        RecordingError: it cannot be written.
    """
    # What a file may hold and UTF-8 may not, half of a pair of surrogates, becomes a mark.
    text = text.encode("utf-8", "replace").decode("utf-8").replace("\x00", "\ufffd")
    try:
        write_text(path, text)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror or error}") from error


def _title(runs: Sequence[RunSection], sweeps: Sequence[SweepSection]) -> str:
    if len(runs) == 1 and not sweeps:
        return runs[0].title
    if len(sweeps) == 1 and not runs:
        return sweeps[0].title
    parts = [f"{len(runs)} run{'s' if len(runs) > 1 else ''}"] if runs else []
    parts += [f"{len(sweeps)} sweep{'s' if len(sweeps) > 1 else ''}"] if sweeps else []
    return " and ".join(parts)
