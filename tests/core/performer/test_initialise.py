"""From a small take to the performer's body."""

import json
from dataclasses import replace

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.kinematics import rest_height
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.performer import files
from silhouette_mocap.core.performer.initialise import InitialiseRequest, initialise
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.take import InitialPose, read_take
from small_take import Notes


@pytest.fixture(scope="module")
def found(small_take, tmp_path_factory):
    out = tmp_path_factory.mktemp("performer")
    return initialise(read_take(small_take), InitialiseRequest(out), Silence())


def test_the_body_is_the_performers_and_serves_a_fit_as_it_is(found, small_take, tmp_path):
    _, written = found
    body = read_body(written[0])
    # one px of 29 mm at each end, of 1.75 m
    assert rest_height(body) == pytest.approx(rest_height(template("sixteen_segment")), rel=0.03)
    take = read_take(small_take)
    take = replace(take, performer=replace(take.performer, body=written[0]))
    fit(take, FitRequest(tmp_path, frames=(0, 1)), Silence())
    again = read_body(tmp_path / "body.npz")
    np.testing.assert_array_equal(again.offsets, body.offsets)
    for ours, theirs in zip(body.surfaces, again.surfaces, strict=True):
        np.testing.assert_array_equal(ours.vertices, theirs.vertices)


def test_measures_and_pictures_tell_how_it_was_found(found):
    _, written = found
    names = [path.name for path in written]
    assert names[:3] == ["body.npz", "measures.json", "shape.png"]
    assert [name for name in names if name.startswith("contour_")] == [
        f"contour_cam_0{k}.png" for k in range(1, 6)
    ]
    for path in written[2:]:
        assert cv2.imread(str(path)).std() > 5
    told = json.loads(written[1].read_text("utf-8"))
    forearm = next(length for length in told["lengths"] if length["name"] == "forearm")
    body = template("sixteen_segment")
    true = np.linalg.norm(body.tails[body.joint_names.index("left_elbow")])
    assert forearm["metres"] == pytest.approx(true, rel=0.06)
    assert 0 < forearm["deviation"] < 0.05
    assert told["contour"]["elbow_observed"] is False
    assert set(told["contour"]["measures"]) == {
        "forearm", "arm", "trunk", "upper_back", "virtual_leg",
    }  # fmt: skip
    assert told["straight_joints"] == ["elbow", "knee"]


def test_further_frames_with_bent_limbs_are_used_on_request(small_take, tmp_path):
    progress = Notes()
    request = InitialiseRequest(tmp_path, further=(None, 3))
    performer, _ = initialise(read_take(small_take), request, progress)
    assert any("shape from frames 0, 1, 2, 3" in note for note in progress.told)
    # the left elbow bends by 34 degrees in the last frame
    assert performer.straight == ("knee",)


def test_a_contour_that_cannot_be_read_is_told_and_does_no_harm(small_take, tmp_path):
    take, progress = read_take(small_take), Notes()
    narrow = replace(take, initial_pose=InitialPose((0, 1), "elbows"))
    performer, written = initialise(narrow, InitialiseRequest(tmp_path), progress)
    assert performer.skeleton is None
    assert any("the body comes from the silhouettes as a whole" in note for note in progress.told)
    assert json.loads(written[1].read_text("utf-8"))["contour"] is None


def test_a_body_that_is_fitted_already_is_not_fitted_again(small_take, tmp_path):
    write_body(tmp_path / "actor.npz", template("sixteen_segment"))
    take = read_take(small_take)
    take = replace(take, performer=replace(take.performer, body=tmp_path / "actor.npz"))
    with pytest.raises(MocapError, match=r"fitted already, actor\.npz"):
        initialise(take, InitialiseRequest(tmp_path / "out"), Silence())
    assert not (tmp_path / "out").exists()


def test_the_command_prints_lengths_with_their_uncertainty(small_take, tmp_path, capsys):
    assert main(["initialise", str(small_take), "--out", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert "m tall; lengths" in shown
    forearm = next(line for line in shown.splitlines() if line.split()[:1] == ["forearm"])
    assert "mm ±" in forearm and forearm.endswith("%")
    assert "no frame bends elbow or knee" in shown
    assert "virtual leg" in shown
    assert "contour_cam_01.png" in shown


def test_the_body_of_a_fit_is_not_replaced(small_take, tmp_path):
    fit(read_take(small_take), FitRequest(tmp_path, frames=(0, 0)), Silence())
    before = (tmp_path / "body.npz").read_bytes()
    with pytest.raises(MocapError, match="holds a fit, whose body would be replaced"):
        initialise(read_take(small_take), InitialiseRequest(tmp_path), Silence())
    assert (tmp_path / "body.npz").read_bytes() == before


def test_nothing_is_written_where_pictures_cannot_be_drawn(small_take, tmp_path, monkeypatch):
    def fails(*_):
        raise MocapError("cannot be read", "check the file")

    monkeypatch.setattr(files, "_contour_pictures", fails)
    with pytest.raises(MocapError):
        initialise(read_take(small_take), InitialiseRequest(tmp_path), Silence())
    assert not list(tmp_path.iterdir())
