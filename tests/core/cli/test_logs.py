"""What is told on request and kept in a log file, and that nothing else is."""

import logging
import subprocess
import sys
import warnings

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cli import main


@pytest.fixture
def command(monkeypatch):
    """Has ``info`` do something else."""

    def does(run):
        def told(arguments, exporter):
            run()
            return 0

        monkeypatch.setattr("silhouette_mocap.core.cli.info.run", told)

    return does


def complaining():
    warnings.warn("planted warning", RuntimeWarning, stacklevel=1)
    logging.getLogger("silhouette_mocap.core.planted").info("planted information")
    logging.getLogger("silhouette_mocap.core.planted").debug("planted detail")


def test_a_command_is_quiet_unless_asked(command, capfd):
    command(complaining)
    assert main(["info", "take.toml"]) == 0
    assert capfd.readouterr() == ("", "")


def test_verbose_tells_what_is_found_but_no_details(command, capfd):
    command(complaining)
    assert main(["info", "take.toml", "-v"]) == 0
    error = capfd.readouterr().err
    assert "s  planted information\n" in error and "planted warning" in error
    assert "planted detail" not in error and "Traceback" not in error


def test_the_log_file_keeps_everything_and_what_was_there_before(command, tmp_path, capfd):
    command(complaining)
    log = tmp_path / "logs" / "farm.log"
    words = ["info", "take.toml", "--log-file", str(log)]
    assert main(words) == main(words) == 0
    assert capfd.readouterr() == ("", "")
    text = log.read_text("utf-8")
    for part in ("planted information", "planted detail", "planted warning", "numpy ", "exit code"):
        assert text.count(part) == 2
    assert f"info take.toml --log-file {log}" in text


def test_the_log_file_has_the_traceback_of_an_internal_error(command, tmp_path, capfd, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    command(lambda: 1 // 0)
    log = tmp_path / "farm.log"
    assert main(["info", "take.toml", "--log-file", str(log)]) == 1
    assert "Traceback" not in capfd.readouterr().err
    assert "Traceback" in log.read_text("utf-8") and "ZeroDivisionError" in log.read_text("utf-8")


def test_a_log_file_that_cannot_be_written_is_a_fault_of_the_input(command, tmp_path, capsys):
    command(complaining)
    assert main(["info", "take.toml", "--log-file", str(tmp_path)]) == 2
    assert f"{tmp_path}: cannot be written" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform != "linux", reason="a device of Linux")
def test_a_log_file_on_a_full_disk_does_not_end_the_work(command, capfd):
    command(complaining)
    assert main(["info", "take.toml", "--log-file", "/dev/full"]) == 0
    assert capfd.readouterr() == ("", "")


def test_loggers_are_left_as_they_were(command, tmp_path):
    loggers = [logging.getLogger(name) for name in ("silhouette_mocap", "py.warnings", None)]

    def state():
        return [(one.level, one.propagate, one.handlers[:]) for one in loggers]

    command(complaining)
    before = state()
    assert main(["info", "take.toml", "-v", "--log-file", str(tmp_path / "a.log")]) == 0
    assert state() == before


@pytest.mark.parametrize("failure", [MemoryError(), RecursionError("too deep"), OSError(5, "I/O")])
def test_any_failure_is_one_line(failure, command, monkeypatch, tmp_path, capfd):
    def failing():
        raise failure

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    command(failing)
    assert main(["info", "take.toml"]) == 1
    line = capfd.readouterr().err
    assert line.count("\n") == 1 and f"internal error ({type(failure).__name__}: " in line
    assert str(next(tmp_path.glob("silhouette_mocap_error_*"))) in line


def test_a_failure_whose_traceback_cannot_be_written_is_one_line(
    command, monkeypatch, tmp_path, capfd
):
    command(lambda: 1 // 0)
    with monkeypatch.context() as patched:
        patched.setattr("tempfile.tempdir", str(tmp_path / "nowhere"))
        assert main(["info", "take.toml"]) == 1
    line = capfd.readouterr().err
    assert line.count("\n") == 1 and "test_logs.py, line" in line and "cannot be written" in line


def test_a_failure_in_reading_the_words_is_one_line(monkeypatch, tmp_path, capfd):
    def failing(text):
        raise OverflowError("planted")

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("silhouette_mocap.core.cli.score.frame_range", failing)
    assert main(["score", "a.npz", "b.npz", "--frames", "0:1"]) == 1
    assert capfd.readouterr().err.count("\n") == 1


@pytest.fixture
def damaged_take(small_take, tmp_path):
    """A take of videos whose pictures are damaged in the middle."""
    folder = tmp_path / "session" / "small"
    (folder / "masks").mkdir(parents=True)
    rng = np.random.default_rng(3)
    for name in ("cam_01", "cam_02", "cam_03", "cam_04", "cam_05"):
        path = folder / "masks" / f"{name}.mp4"
        video = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 15.0, (160, 120))
        for _ in range(4):
            video.write(rng.integers(0, 255, (120, 160, 3), np.uint8))
        video.release()
        data = bytearray(path.read_bytes())
        begin = len(data) * 2 // 3
        data[begin + 600 : begin + 1200 : 7] = b"\xa5" * len(data[begin + 600 : begin + 1200 : 7])
        path.write_bytes(data)
    calibration = small_take.with_name("calibration.toml").read_bytes()
    (folder / "calibration.toml").write_bytes(calibration)
    text = small_take.read_text("utf-8").replace("/{frame:06d}.png", ".mp4")
    (folder / "take.toml").write_text(text, "utf-8")
    return folder / "take.toml"


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of another kind")
def test_a_command_runs_with_closed_streams(small_take, tmp_path):
    program = "import sys; from silhouette_mocap.core.cli import main; sys.exit(main(sys.argv[1:]))"
    words = [sys.executable, "-c", program, "masks", str(small_take), "--out", str(tmp_path)]
    closed = ["sh", "-c", '"$@" >&- 2>&-', "sh"]
    assert subprocess.run([*closed, *words]).returncode == 0
    assert subprocess.run([*closed, *words, "--without", "nobody"]).returncode == 2


def run_alone(*words) -> subprocess.CompletedProcess:
    """The command in a process of its own."""
    program = "import sys; from silhouette_mocap.core.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", program, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True)


def test_decoders_are_heard_in_the_log_file_alone(damaged_take, tmp_path):
    words = ("masks", damaged_take, "--out", tmp_path / "masks", "--progress", "none")
    log = tmp_path / "a.log"
    for more in ((), ("--log-file", log)):
        finished = run_alone(*words, *more)
        assert (finished.returncode, finished.stderr) == (0, "")
        assert "[" not in finished.stdout
    assert "[mpeg4 @" in log.read_text("utf-8")


def test_a_log_file_takes_nothing_from_standard_error(tmp_path):
    log = tmp_path / "a.log"
    told = run_alone("score", "no.npz", "no.npz", "--log-file", log)
    assert told.returncode == 2 and told.stderr.startswith("silhouette-mocap: no.npz: ")
    assert "silhouette-mocap: " not in log.read_text("utf-8")
