"""The verb `export`: a run's files in the formats of other tools."""

from pathlib import Path
from typing import Any

from treadwell.cli.output import write_message


def exported(
    run_dir: Path, to: str, out: Path | None, storage: str | None = None
) -> dict[str, Any]:
    """Write the files and return which.

    Raises:
        InputError: there is no such run or format, or the run lacks what the format shows.
        RecordingError: a file cannot be written.
    """
    from treadwell.exports.export import export

    files = export(run_dir, to, out, storage=storage)
    for path in files:
        write_message(f"wrote {path} ({path.stat().st_size / 1000:.0f} kB)")
    return {"run": str(run_dir), "to": to, "files": [str(path) for path in files]}
