"""Claims about rerun's import: it keeps silent of our choice, and leaves the environment alone."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from treadwell.recording.quiet import first_import

SAVE = """
import os, sys
from treadwell.recording.quiet import first_import
before = dict(os.environ)
with first_import():
    import rerun as rr
assert dict(os.environ) == before
stream = rr.RecordingStream("test", send_properties=False)
stream.save(sys.argv[1], write_footer=False)
stream.log("points", rr.Points3D([[0.0, 0.0, 0.0]]))
stream.disconnect()
"""


@pytest.mark.slow
@pytest.mark.parametrize("level", [None, "info"])
def test_a_recording_without_a_table_of_contents_is_no_news(
    tmp_path: Path, level: str | None
) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "RUST_LOG"}
    told = environment | ({} if level is None else {"RUST_LOG": level})
    done = subprocess.run(
        [sys.executable, "-c", SAVE, str(tmp_path / "t.rrd")],
        env=told,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "footer" not in done.stdout + done.stderr
    assert (tmp_path / "t.rrd").stat().st_size > 100


def test_where_rerun_is_there_already_nothing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    import rerun

    assert rerun.__name__ in sys.modules
    monkeypatch.setenv("RUST_LOG", "error")
    with first_import():
        assert os.environ["RUST_LOG"] == "error"
