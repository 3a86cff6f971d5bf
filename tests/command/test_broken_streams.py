"""Full disks and closed pipes behind the output change no exit code."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="devices and shell of Linux")
NOBODY_READS = "import os; r, w = os.pipe(); os.close(r); os.dup2(w, {0}); "
FULL_DISK = "import os; os.dup2(os.open('/dev/full', os.O_WRONLY), {0}); "
GO_ON = "os.execv(sys.executable, [sys.executable, '-m', 'silhouette_mocap', *sys.argv[1:]])"


def run_with(broken: str, *words) -> subprocess.CompletedProcess:
    program = f"import sys; {broken}{GO_ON}"
    command = [sys.executable, "-c", program, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.mark.parametrize("progress", ["bar", "json", "none"])
@pytest.mark.parametrize("broken", [NOBODY_READS, FULL_DISK])
def test_broken_standard_error_changes_no_exit_code(broken, progress, small_take, tmp_path):
    told = ("--progress", progress)
    words = ("masks", small_take, "--out", tmp_path, *told)
    finished = run_with(broken.format(2), *words)
    assert finished.returncode == 0 and "wrote" in finished.stdout
    assert run_with(broken.format(2), "info", tmp_path / "none.toml", *told).returncode == 2


def test_whoever_reads_no_result_changes_no_exit_code(small_take, tmp_path):
    nobody_reads = NOBODY_READS.format(1)
    finished = run_with(nobody_reads, "masks", small_take, "--out", tmp_path, "--progress", "none")
    assert (finished.returncode, finished.stderr) == (0, "")
    sheet = tmp_path / "sheet.html"
    finished = run_with(nobody_reads, "info", small_take, "--sheet", sheet, "--progress", "none")
    assert (finished.returncode, finished.stderr) == (0, "") and sheet.exists()
    finished = run_with(nobody_reads, "info", small_take, "--root", tmp_path / "elsewhere")
    assert finished.returncode == 2
    assert run_with(nobody_reads, "--help").returncode == 0


def test_a_result_that_no_disk_holds_is_a_fault(small_take):
    finished = run_with(FULL_DISK.format(1), "info", small_take, "--progress", "none")
    line = "standard output: cannot be written (No space left on device); free space"
    assert line in finished.stderr and finished.stderr.count("\n") == 1
    assert finished.returncode == 2
