"""The command when it is interrupted, or nobody reads it any more."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from silhouette_mocap.core.motion.motion import read_motion


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of another kind")
def test_output_that_nobody_reads_any_more_is_no_error(small_take):
    program = "import sys; from silhouette_mocap.core.cli import main; sys.exit(main(sys.argv[1:]))"
    reader, writer = os.pipe()
    os.close(reader)
    finished = subprocess.run(
        [sys.executable, "-c", program, "info", str(small_take), "--progress=none"],
        stdout=writer, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    os.close(writer)
    assert (finished.returncode, finished.stderr) == (0, "")


# the small take, started at once and with a pause after each frame to be interrupted in
PAUSING = """
import sys, time
import numpy as np
from silhouette_mocap.core import beginning
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.fitting import passes
from silhouette_mocap.core.initialisation.first_pose import FirstFit

def started(body, cameras, silhouettes, request, make_evaluator):
    return FirstFit(body, body.rest_pose, np.ones(len(cameras)), ())

def pausing(*search, track=passes.track):
    for found in track(*search):
        yield found
        time.sleep(1)

beginning.initialised, passes.track = started, pausing
sys.exit(main(sys.argv[1:]))
"""


def paused_in_frame_two(small_take, out) -> subprocess.Popen:
    words = ["fit", str(small_take), "--out", str(out)]
    process = subprocess.Popen(
        [sys.executable, "-c", PAUSING, *words], stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith("fit 2/4"):
            break
    return process


def check_that_it_kept_three_frames(process: subprocess.Popen, out):
    """A frame is told of once it is kept; by then the next one has been found."""
    rest = process.stderr.read()
    assert process.wait(30) == 130, rest
    np.testing.assert_array_equal(read_motion(out / "motion.npz").frames, [0, 1, 2])
    assert "the 3 finished frames are kept" in rest and "interrupted" in rest
    assert "Traceback" not in rest


@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_fit_with_130_and_its_finished_frames(small_take, tmp_path, number):
    process = paused_in_frame_two(small_take, tmp_path)
    process.send_signal(number)
    check_that_it_kept_three_frames(process, tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of another kind")
@pytest.mark.parametrize("pause", [0.0, 0.02])
def test_signals_until_the_very_end_change_nothing(small_take, tmp_path, pause):
    process = paused_in_frame_two(small_take, tmp_path)
    while process.poll() is None:
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        time.sleep(pause)
    check_that_it_kept_three_frames(process, tmp_path)
