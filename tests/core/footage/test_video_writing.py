"""Videos written whole or not at all."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.footage import video_writing
from silhouette_mocap.core.footage.video_writing import write_video


def grey(level: int) -> np.ndarray:
    return np.full((48, 64, 3), level, np.uint8)


def test_a_video_holds_every_picture_in_order(tmp_path):
    path = tmp_path / "ö v.mp4"
    write_video(path, map(grey, (135, 165, 180, 195, 210)), 25.0)
    stored = cv2.VideoCapture(str(path))
    levels = [stored.read()[1].mean() for _ in range(5)]
    np.testing.assert_allclose(levels, [135, 165, 180, 195, 210], atol=6)
    assert not stored.read()[0] and list(tmp_path.iterdir()) == [path]


def test_a_video_that_is_given_up_leaves_nothing_behind(tmp_path):
    def pictures():
        yield grey(0)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(tmp_path / "o.mp4", pictures(), 25.0)
    assert not list(tmp_path.iterdir())


def test_a_video_cut_short_by_the_disk_is_a_fault(tmp_path, monkeypatch):
    check = video_writing._check

    def cut(written, path, count):
        written.write_bytes(written.read_bytes()[:-200])
        check(written, path, count)

    monkeypatch.setattr(video_writing, "_check", cut)
    with pytest.raises(MocapError, match=r"o\.mp4: cannot be written to its end; free space"):
        write_video(tmp_path / "o.mp4", map(grey, range(0, 200, 20)), 25.0)
    assert not list(tmp_path.iterdir())
