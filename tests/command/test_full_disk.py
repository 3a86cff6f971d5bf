"""A full disk in the middle of a fit: told in one line, mended by space and --resume."""

import shutil
import subprocess
import sys

import pytest
from silhouette_mocap.core.motion.motion import read_motion

# a disk of its own, visible to nobody else; later it grows
ON_A_SMALL_DISK = """
mount -t tmpfs -o size=300k tmpfs "$1" || exit 99
"$2" -m silhouette_mocap fit "$3" --out "$1/out" --progress none --frames 0:1
echo "code $?" >&2
mount -o remount,size=50m "$1"
"$2" -m silhouette_mocap fit "$3" --out "$1/out" --progress none --frames 0:1 --resume || exit 1
cp "$1"/out/* "$4"
"""


def own_disks_are_allowed() -> bool:
    unshare = shutil.which("unshare")
    made = ["unshare", "-rm", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    return bool(unshare) and subprocess.run(made, capture_output=True).returncode == 0


@pytest.mark.skipif(not own_disks_are_allowed(), reason="this system mounts no disks for its users")
def test_a_fit_on_a_full_disk_says_so_and_goes_on_when_there_is_space(small_take, tmp_path):
    disk, kept = tmp_path / "disk", tmp_path / "kept"
    disk.mkdir()
    kept.mkdir()
    words = [disk, sys.executable, small_take, kept]
    finished = subprocess.run(
        ["unshare", "-rm", "sh", "-c", ON_A_SMALL_DISK, "sh", *words],
        capture_output=True, text=True,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stderr
    line, code, *rest = finished.stderr.splitlines()
    assert "cannot be written (No space left on device); free space on that disk" in line
    assert code == "code 2" and not rest
    assert read_motion(kept / "motion.npz").frames.tolist() == [0, 1]
    assert (kept / "overlay.mp4").exists()
