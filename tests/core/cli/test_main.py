"""What the commands answer, and their exit codes."""

import shutil
from pathlib import Path

import pytest
from silhouette_mocap.core.cli import fit as fit_command
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.cli.main import COMMANDS
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.motion import read_motion
from silhouette_mocap.core.native import library


def failing(monkeypatch, failure):
    def run(arguments, exporter):
        raise failure

    monkeypatch.setattr("silhouette_mocap.core.cli.info.run", run)


def test_no_command_is_one_line_and_two(capsys):
    assert main([]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and "see silhouette-mocap --help" in error


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command, capsys):
    assert main([command, "--help"]) == 0
    assert f"example: silhouette-mocap {command}" in " ".join(capsys.readouterr().out.split())


def test_a_fault_of_the_input_is_one_line_and_two(monkeypatch, capsys):
    failing(monkeypatch, MocapError("is\nbroken", "mend it", file="a.png", camera="c", frame=3))
    assert main(["info", "take.toml"]) == 2
    assert capsys.readouterr().err == (
        "silhouette-mocap: a.png, camera c, frame 3: is broken; mend it\n"
    )


def test_a_full_disk_is_a_fault_of_the_input(monkeypatch, capsys):
    failing(monkeypatch, OSError(28, "No space left on device", "out/motion.npz"))
    assert main(["info", "take.toml"]) == 2
    line = capsys.readouterr().err
    assert "out/motion.npz: cannot be written (No space left on device); free space" in line


def test_an_internal_error_is_one_and_names_the_file_with_the_traceback(monkeypatch, capsys):
    failing(monkeypatch, ZeroDivisionError("planted"))
    assert main(["info", "take.toml"]) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    named = Path(next(word for word in error.split() if "silhouette_mocap_error_" in word))
    assert "ZeroDivisionError: planted" in named.read_text("utf-8")
    named.unlink()


@pytest.mark.parametrize(
    ("stop", "code", "shown"),
    [
        (SystemExit(), 0, ""),
        (SystemExit(0), 0, ""),
        (SystemExit(7), 7, ""),
        (SystemExit("no such thing"), 1, "silhouette-mocap: no such thing\n"),
    ],
)
def test_an_exit_with_a_text_is_no_success(stop, code, shown, monkeypatch, capsys):
    failing(monkeypatch, stop)
    assert main(["info", "take.toml"]) == code
    assert capsys.readouterr().err == shown


def test_a_platform_without_a_kernel_is_two(monkeypatch, tmp_path, small_take, capsys):
    monkeypatch.setenv("SILHOUETTE_MOCAP_TARGET", "amiga-68k")
    monkeypatch.setattr("silhouette_mocap.core.rendering.choice.load", library.load.__wrapped__)
    assert main(["fit", str(small_take), "--out", str(tmp_path), "--progress", "none"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("silhouette-mocap: there is no native kernel for amiga-68k")


def test_an_interrupt_is_130(monkeypatch, capsys):
    failing(monkeypatch, KeyboardInterrupt())
    assert main(["info", "take.toml"]) == 130


def test_a_missing_take_is_two(tmp_path, capsys):
    assert main(["fit", str(tmp_path / "take.toml"), "--out", str(tmp_path)]) == 2
    assert "no such file" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["--frames", "3"],
        ["--frames", "a:b"],
        ["--export", "fbx,doc"],
        ["--tracker", "magic"],
        ["--progress", "jason"],
        ["--out"],
        ["--frame", "0:1"],
    ],
)
def test_wrong_words_are_two(words, small_take, tmp_path, capsys):
    assert main(["fit", str(small_take), "--out", str(tmp_path), *words]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_format_that_needs_blender_is_refused_before_the_fit(small_take, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["fit", str(small_take), "--out", str(out), "--export", "fbx"]) == 2
    assert "pip install silhouette-mocap[blender]" in capsys.readouterr().err
    assert not out.exists()


def test_fit_then_score_then_export(quick_start, small_take, tmp_path, capsys):
    words = ["--without", "cam_05", "--frames", ":1", "--export", "trc", "--strict"]
    assert main(["fit", str(small_take), "--out", str(tmp_path), *words]) == 0
    shown = capsys.readouterr()
    assert "2 frames, IoU 0.9" in shown.out and "error to the truth" in shown.out
    assert "fit 2/2  frame 1" in shown.err
    assert read_motion(tmp_path / "motion.npz").camera_names == (
        "cam_01", "cam_02", "cam_03", "cam_04",
    )  # fmt: skip
    truth = str(small_take.with_name("truth.npz"))
    for prediction in ("motion.npz", "small.trc"):
        words = ["score", str(tmp_path / prediction), truth, "--frames", "0:1", "--json"]
        assert main([*words, str(tmp_path / "score.json")]) == 0
        assert "2 frames, 0 missing, 0 lost" in capsys.readouterr().out
    words = ["export", str(small_take), "--out", str(tmp_path), "--export", "trc"]
    assert main(words) == 0


def test_lost_frames_are_told_and_are_three_only_if_strict(
    quick_start, small_take, tmp_path, monkeypatch, capsys
):
    recorded = fit_command.fit

    def losing(take, request, progress):
        result = recorded(take, request, progress)
        result.report["lost_frames"] = [0]
        return result

    monkeypatch.setattr("silhouette_mocap.core.cli.fit.fit", losing)
    words = ["fit", str(small_take), "--out", str(tmp_path), "--frames", "0:0"]
    assert main(words) == 0
    assert "frames lost: 0" in capsys.readouterr().err
    assert main([*words, "--strict"]) == 3


def test_info_tells_what_is_there(small_take, capsys):
    assert main(["info", str(small_take)]) == 0
    out = capsys.readouterr().out
    assert "all that fit needs is there" in out and "cam_05" in out and "truth.npz" in out


def test_info_names_everything_that_is_missing(small_take, tmp_path, capsys):
    folder = tmp_path / "copy"
    (folder / "masks").mkdir(parents=True)
    for name in ("cam_01", "cam_02", "cam_03", "cam_04", "cam_05"):
        (folder / "masks" / name).symlink_to(small_take.parent / "masks" / name)
    (folder / "masks" / "cam_03").unlink()
    (folder / "calibration.toml").write_bytes(small_take.with_name("calibration.toml").read_bytes())
    text = small_take.read_text("utf-8").replace("sixteen_segment", "centaur.npz")
    (folder / "take.toml").write_text(text, "utf-8")
    root = str(tmp_path.parent.parent)
    assert main(["info", str(folder / "take.toml"), "--root", root]) == 2
    error = capsys.readouterr().err
    assert "cam_03" in error and "centaur" in error


def test_info_names_every_camera_that_is_missing(small_take, tmp_path, capsys):
    folder = tmp_path / "session" / "small"
    shutil.copytree(small_take.parent, folder, ignore=shutil.ignore_patterns("cam_0?"))
    assert main(["info", str(folder / "take.toml"), "--progress=none"]) == 2
    error = capsys.readouterr().err
    assert [error.count(f"camera cam_0{i}: ") for i in range(1, 6)] == [1] * 5


def test_info_tells_of_the_other_cameras_too(small_take, tmp_path, capsys):
    folder = shutil.copytree(small_take.parent, tmp_path / "session" / "small")
    (folder / "masks" / "cam_02" / "000003.png").unlink()
    assert main(["info", str(folder / "take.toml"), "--progress=none"]) == 2
    shown = capsys.readouterr()
    assert "cam_02, frame 3: missing" in shown.err and shown.err.count("\n") == 1
    assert "footage     cam_03: frames 0 to 3" in shown.out


def test_nothing_to_export_is_two(small_take, tmp_path, capsys):
    assert main(["export", str(small_take), "--out", str(tmp_path)]) == 2
    assert "names no formats; name some with --export" in capsys.readouterr().err


def test_masks_are_written_with_a_quality_line_per_camera(small_take, tmp_path, capsys):
    words = ["masks", str(small_take), "--out", str(tmp_path), "--progress", "none"]
    assert main(words) == 0
    shown = capsys.readouterr()
    assert shown.out.count("cam_0") == 5 and not shown.err
    assert len(list(tmp_path.glob("cam_0?/00000?.png"))) == 20


@pytest.mark.parametrize("option", ["--out", "--log-file", "--root"])
def test_no_path_is_no_path(option, small_take, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["masks", str(small_take), "--out", str(tmp_path / "masks"), option, ""]) == 2
    error = capsys.readouterr().err
    assert f"argument {option}: expected a path, got nothing" in error and error.count("\n") == 1
    assert not list(tmp_path.iterdir())
