"""Claims about what is said of the processor that the physics ran on."""

import html
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from run_folders import plain_run

from treadwell import processor as module
from treadwell.cli.app import execute
from treadwell.processor import described, likely_reason, processor

TABLE = """processor\t: 0
model name\t: Some  Chip @ 2.00GHz
flags\t\t: fpu sse2 avx fma avx2 avx512f avx512vl

processor\t: 1
model name\t: Other
flags\t\t: fpu
"""


def test_model_and_instructions_of_the_first_processor_are_told() -> None:
    assert described(TABLE).endswith(", Some Chip @ 2.00GHz, avx avx2 fma avx512f")


def test_what_the_c_library_is_told_not_to_use_is_left_out() -> None:
    hidden = described(TABLE, "glibc.cpu.hwcaps=-AVX2,-FMA")
    assert hidden.endswith(", avx avx512f")


@pytest.mark.parametrize("table", ["", "flags", "model name\t:", "Features\t: fp asimd\n"])
def test_a_machine_that_says_little_still_has_a_name(table: str) -> None:
    assert described(table)
    assert "avx" not in described(table)


def test_a_machine_without_the_table_has_a_name(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(module, "CPUINFO", tmp_path / "nothing")
    assert processor.__wrapped__()


def test_only_another_processor_is_a_reason() -> None:
    assert likely_reason(processor()) == ""
    assert likely_reason(None) == ""
    assert likely_reason("a", "a") == ""
    assert likely_reason("a", "b") == "likely because it ran on another processor: a; here: b"


def test_it_is_the_same_in_another_process() -> None:
    code = "from treadwell.processor import processor; print(processor())"
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert told.stdout.strip() == processor()


ONE_SEED = "one seed gives one result"
KIND = "one kind of processor"
ROOT = Path(__file__).resolve().parent.parent


@pytest.mark.parametrize("verb", ["run", "check", "sweep"])
def test_who_gives_a_seed_is_told_what_it_holds_for(
    verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute([verb, "--help"]) == 0
    said = " ".join(re.sub(r"[^a-z -]", " ", capsys.readouterr().out.lower()).split())
    assert f"{ONE_SEED} on {KIND}" in said


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/reference/result.md",
        "docs/reference/scenario.md",
        "docs/how_to/look_at_a_run.md",
        "docs/how_to/sweep_and_compare.md",
        "docs/how_to/gymnasium.md",
        "docs/how_to/own_planner.md",
    ],
)
def test_every_page_that_promises_the_same_result_says_on_what(page: str) -> None:
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    assert KIND in text
    assert "on the same machine" not in text


def test_a_report_says_on_what_its_command_gives_the_same(tmp_path: Path) -> None:
    shutil.copytree(plain_run(), tmp_path / "run")
    assert execute(["report", str(tmp_path / "run")]) == 0
    page = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    assert KIND in page
    assert html.escape(processor()) in page
