"""Claims about what is said of the processor that the physics ran on."""

import subprocess
import sys
from pathlib import Path

import pytest

from treadwell import processor as module
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
