"""A small fit is killed and resumed: ``tests/benchmarks/kills.py`` in short."""

import subprocess
import sys
from pathlib import Path

import pytest

KILLS = Path(__file__).parents[1] / "benchmarks" / "kills.py"


@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
def test_a_killed_fit_is_resumed_bit_by_bit(small_take):
    finished = subprocess.run(
        [sys.executable, str(KILLS), str(small_take), "--kills", "1", "--frames", ":1"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stdout + finished.stderr
    assert "1 results equal bit by bit" in finished.stdout
