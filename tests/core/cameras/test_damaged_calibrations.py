"""What damage to a calibration once led to."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import read_calibration
from silhouette_mocap.core.errors import MocapError

TOML = """[cam]
size = [640, 480]
matrix = [[600.0, 0, 320], [0, 600, 240], [0, 0, 1]]
distortions = [0.0, 0.0, 0.0, 0.0]
rotation = [0.0, 0.0, 0.0]
translation = [0.0, 0.0, 4.0]
"""


def refused(path, content: str) -> str:
    path.write_text(content, "utf-8")
    with pytest.raises(MocapError) as caught:
        read_calibration(path)
    assert caught.value.file == path
    return caught.value.problem


@pytest.mark.parametrize("number", ["9" * 299, "1e308", "-1e13"])
def test_numbers_far_too_large_are_refused(tmp_path, number):
    problem = refused(tmp_path / "a.toml", TOML.replace("4.0]", f"{number}]"))
    assert problem == "translation holds a number far too large for a camera"


@pytest.mark.parametrize("encoding", ["UTF-80", "UTF-7777", "idna"])
def test_an_encoding_that_nobody_knows_is_refused(tmp_path, encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><calibration ><fov_video/></calibration>'
    assert "is not complete XML" in refused(tmp_path / "a.qca.txt", text)


def test_entities_are_refused_before_they_are_expanded(tmp_path):
    text = "<!DOCTYPE c [<!ENTITY a 'lol'>]><calibration ><fov_video/>&a;</calibration>"
    assert refused(tmp_path / "a.qca.txt", text) == "declares entities"


def test_several_documents_in_one_yaml_are_refused_not_read_without_end(tmp_path):
    path = tmp_path / "cameras.yml"
    storage = cv2.FileStorage(str(path), cv2.FileStorage_WRITE)
    storage.write("K_cam", np.eye(3))
    storage.release()
    head, body = path.read_text("utf-8").split("---\n")
    problem = 'has more than "---" between its first line and the cameras'
    # the second made OpenCV 4.11 search for ever
    for damaged in (
        f"{head}---\n{body}---\n{body}",
        f"{head}   data: [ 1. ]\n---\n   - cam\n{body}",
    ):
        assert refused(path, damaged) == problem


def test_a_file_too_large_for_a_calibration_is_not_read(tmp_path):
    assert refused(tmp_path / "a.toml", "#" * (8 * 2**20 + 1)) == "is too large for a calibration"
