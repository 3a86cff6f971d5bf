"""The result of a fit in further formats, when the take has changed since."""

import shutil

import pytest
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.results.exporting import export
from silhouette_mocap.core.take import read_take


@pytest.fixture
def fitted(quick_start, small_take, tmp_path):
    """A take fitted without cam_03, whose first frame alone was wanted; and the result."""
    folder = shutil.copytree(small_take.parent, tmp_path / "session" / "small")
    take = read_take(folder / "take.toml")
    fit(take, FitRequest(tmp_path, frames=(0, 0), without=("cam_03",)), Silence())
    return take, tmp_path


def asked(take, folder, *formats):
    requests = []

    def exporter(request):
        requests.append(request)
        return ()

    export(take, folder, formats, exporter)
    return requests[0]


def test_only_what_was_tracked_with_must_still_be_there(fitted):
    take, out = fitted
    masks = take.path.parent / "masks"
    shutil.rmtree(masks / "cam_03")
    (masks / "cam_01" / "000001.png").unlink()
    request = asked(take, out, "blend", "fbx")
    used = ["cam_01", "cam_02", "cam_04", "cam_05"]
    assert [camera.name for camera in request.cameras] == list(request.footage) == used


def test_what_shows_no_footage_needs_none(fitted):
    take, out = fitted
    shutil.rmtree(take.path.parent / "masks")
    request = asked(take, out, "fbx", "bvh", "trc")
    assert request.cameras == () and request.formats == ("fbx", "bvh", "trc")
