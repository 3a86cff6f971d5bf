"""Damaged files, some hundred of them: ``tests/benchmarks/fuzz.py`` in short."""

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]


@pytest.mark.skipif(sys.platform != "linux", reason="memory is measured in Linux' way")
def test_damaged_files_are_refused_in_one_line_quickly_and_cheaply():
    finished = subprocess.run(
        [sys.executable, "-m", "benchmarks.fuzz", "--cases", "306", "--seed", "5"],
        cwd=TESTS, capture_output=True, text=True,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stdout + finished.stderr
    assert "0 failures" in finished.stdout
