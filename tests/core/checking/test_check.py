"""A take checked as a whole, and its sheet."""

import base64
import re
import shutil
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.beginning import initial_frames
from silhouette_mocap.core.cameras.arrangement import millimetres_per_pixel
from silhouette_mocap.core.checking.check import CheckRequest, checked
from silhouette_mocap.core.checking.estimate import Estimate
from silhouette_mocap.core.checking.footage_check import FootageCheck
from silhouette_mocap.core.checking.sheet import write_check_sheet
from silhouette_mocap.core.checking.words import estimate_words, readiness, take_words
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import SILENCE
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.silhouettes.source import SilhouetteSource
from silhouette_mocap.core.take.reading import read_take
from silhouette_mocap.core.take.views import open_views


def check_of(path, **options):
    request = CheckRequest(initial_frames, NativeEvaluator, seconds=60.0, **options)
    return checked(read_take(path), request)


@pytest.fixture
def folder(small_take, tmp_path):
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


@pytest.fixture(scope="module")
def sound(small_take):
    return check_of(small_take)


def test_a_sound_take_has_all_facts(sound, small_take):
    assert not sound.faults and sound.frames == (0, 3)
    assert sound.units == "metres, as the take says"
    cameras = open_views(read_take(small_take)).cameras
    for facts, camera in zip(sound.cameras, cameras, strict=True):
        assert facts.height_m == pytest.approx(camera.centre[2])
        scale = millimetres_per_pixel(camera, sound.performer.centre)
        assert facts.mm_per_px == pytest.approx(scale)
    # a body of 1.75 m stands at the origin; pixels are 29 mm
    np.testing.assert_allclose(sound.performer.centre[:2], 0, atol=0.06)
    assert 1.6 < sound.performer.height_m < 1.9


def test_the_estimate_grows_with_the_frames(sound):
    estimate = sound.estimate
    assert estimate.frames == 4 and 0 < estimate.frame_s < 30
    longer = replace(estimate, frames=104)
    assert longer.total_s == pytest.approx(estimate.total_s + 100 * estimate.frame_s)


def test_the_files_are_those_of_a_fit_and_about_as_large(sound, quick_start, small_take, tmp_path):
    take, request = read_take(small_take), FitRequest(tmp_path / "out")
    files = fit(take, request, SILENCE).files
    estimated = sound.estimate.results_bytes
    assert set(estimated) == {path.name for path in files}
    for path in files:
        assert 0.5 < estimated[path.name] / path.stat().st_size < 2, path.name


def test_every_fault_is_found_at_once(folder):
    shutil.rmtree(folder / "masks" / "cam_05")
    (folder / "masks" / "cam_02" / "000003.png").write_bytes(b"junk")
    text = (folder / "take.toml").read_text("utf-8").replace("sixteen_segment", "nobody.npz")
    (folder / "take.toml").write_text(text, "utf-8")

    def forbidden():
        raise MocapError("no Blender", "install it")

    check = check_of(folder / "take.toml", further=(forbidden,))
    told = [str(fault) for fault in check.faults]
    assert len(told) == 4 and check.estimate is None
    for word in ("cam_05", "cam_02, frame 3", "nobody.npz", "no Blender; install it"):
        assert sum(word in line for line in told) == 1
    assert [facts.camera.name for facts in check.cameras] == [
        "cam_01",
        "cam_02",
        "cam_03",
        "cam_04",
    ]


@pytest.mark.parametrize("missing", [4, 5])
def test_cameras_without_footage_are_all_that_is_told_of(folder, missing):
    for number in range(1, missing + 1):
        shutil.rmtree(folder / "masks" / f"cam_0{number}")
    faults = check_of(folder / "take.toml").faults
    assert [fault.camera for fault in faults] == [f"cam_0{n}" for n in range(1, missing + 1)]


def test_frames_of_the_initial_pose_are_read_once(small_take, monkeypatch):
    read, whole = Counter(), SilhouetteSource.read

    def reading(source, frame):
        read[source.footage.camera, frame] += 1
        return whole(source, frame)

    monkeypatch.setattr(SilhouetteSource, "read", reading)
    request = CheckRequest(lambda *_: (0, 1, 2, 3), NativeEvaluator)
    monkeypatch.setattr("silhouette_mocap.core.checking.check.checked_footage", no_footage)
    assert not checked(read_take(small_take), request).faults
    assert len(read) == 20 and set(read.values()) == {1}


def no_footage(views, seconds):
    return FootageCheck((), (), 0.0)


def test_a_take_that_cannot_be_opened_has_its_fault_and_no_camera(folder):
    (folder / "calibration.toml").unlink()
    check = check_of(folder / "take.toml")
    assert len(check.faults) == 1 and not check.cameras and check.frames is None
    assert "unknown" in dict(take_words(check))["take"]


def test_an_initial_pose_outside_of_the_take_is_a_fault_beside_the_cameras(folder):
    text = (folder / "take.toml").read_text("utf-8")
    text = text.replace("frames = [0, 3]\n", "").replace("[0, 1]", "[7, 9]")
    (folder / "take.toml").write_text(text, "utf-8")
    check = check_of(folder / "take.toml")
    assert "initial pose" in str(check.faults[0]) and check.performer is None
    assert len(check.cameras) == 5 and np.isnan(check.cameras[0].mm_per_px)


def test_a_take_without_an_initial_pose_is_looked_at_where_it_shows_somebody(folder):
    path = folder / "take.toml"
    lines = path.read_text("utf-8").splitlines()
    kept = [line for line in lines if not line.startswith("initial_pose")]
    path.write_text("\n".join(kept), "utf-8")
    for mask in folder.glob("masks/*/000000.png"):
        cv2.imwrite(str(mask), np.zeros((120, 160), np.uint8))
    check = check_of(path)
    assert not check.faults and check.performer is not None
    assert dict(take_words(check))["initial"] == "pose not given, a frame is found"


def test_a_given_height_is_taken(folder):
    path = folder / "take.toml"
    path.write_text(path.read_text("utf-8") + "height_m = 1.81\n", "utf-8")
    assert check_of(path).performer.height_m == 1.81


def test_readiness_is_one_sentence(sound):
    assert readiness(sound).startswith("All that fit needs is there: 4 frames of 5 cameras, about")
    fault = replace(sound, faults=(MocapError("x"), MocapError("y")))
    assert readiness(fault) == "2 faults to mend before a fit can start."


def test_the_estimate_in_words():
    estimate = Estimate(100, 8.0, 0.1, 1.2, 0.2, 3e8, 9e6, {"motion.npz": 2e5, "overlay.mp4": 4e6})
    words = dict(estimate_words(estimate))
    assert words["time"] == (
        "about 2 min 38 s on this machine: 8.0 s for the first pose, then 1.50 s per frame "
        "(0.10 reading, 1.20 fitting, 0.20 overlay)"
    )
    assert words["disk"] == "about 9.0 MB during the fit, 4.2 MB after"
    assert words["files"] == "motion.npz 200 KB, overlay.mp4 4.0 MB"


class Texts(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.pictures, self.texts = [], []
        self.feed(text)

    def handle_startendtag(self, tag, attributes):
        self.pictures += [value for key, value in attributes if key == "src"]

    def handle_data(self, data):
        self.texts.append(data)


def sheet_of(check, tmp_path):
    write_check_sheet(tmp_path / "sheet.html", check)
    text = (tmp_path / "sheet.html").read_text("utf-8")
    assert not re.search(r"https?:|url\(", text)
    return text, Texts(text)


def test_the_sheet_shows_facts_plans_and_pictures(sound, tmp_path):
    text, page = sheet_of(sound, tmp_path)
    assert len(page.pictures) == 5 and text.count('class="plan"') == 2
    for facts in sound.cameras:
        assert f"{facts.height_m:.2f}" in page.texts and f"{facts.mm_per_px:.1f}" in page.texts
    assert "Ready" in page.texts and "cam_03" in page.texts


def test_the_thumbnail_shows_the_silhouette(sound, tmp_path):
    _, page = sheet_of(sound, tmp_path)
    data = page.pictures[0].partition("base64,")[2]
    picture = cv2.imdecode(np.frombuffer(base64.b64decode(data), np.uint8), 1)
    seen = sound.footage[0].silhouette.foreground
    blue = picture[..., 0].astype(int) - picture[..., 2] > 60
    assert (blue & seen).sum() / (blue | seen).sum() > 0.9


def test_faults_stand_on_top_of_the_sheet_escaped(sound, tmp_path):
    check = replace(sound, faults=(MocapError("is <broken>", camera="cam_01"),), estimate=None)
    text, page = sheet_of(check, tmp_path)
    assert "camera cam_01: is <broken>" in page.texts and "Not ready" in page.texts
    assert text.index("&lt;broken&gt;") < text.index("<nav>")


def test_a_sheet_of_nothing_but_faults_can_be_written(folder, tmp_path):
    (folder / "calibration.toml").unlink()
    text, page = sheet_of(check_of(folder / "take.toml"), tmp_path)
    assert "Not ready" in page.texts and "<svg" not in text
