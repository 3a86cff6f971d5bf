"""Rows of shades against the values they show."""

import base64
import re

import cv2
import numpy as np
from silhouette_mocap.core.pages.axis import Axis
from silhouette_mocap.core.pages.heat import Heat, heat_figure, lowest_in_columns, shaded


def heat_of(values, frames=None, names=None):
    values = np.array(values, float)
    frames = np.arange(len(values)) if frames is None else np.array(frames)
    names = [f"row {k}" for k in range(values.shape[1])] if names is None else names
    return Heat("title", "unit", frames, names, values, Axis(0.5, 1.0))


def pictures_of(text):
    data = re.findall(r"data:image/png;base64,([^\"]+)", text)
    return [
        cv2.imdecode(np.frombuffer(base64.b64decode(d), np.uint8), cv2.IMREAD_UNCHANGED)
        for d in data
    ]


def test_few_frames_have_a_column_each():
    values = np.random.default_rng(5).uniform(0.5, 1.0, (60, 3))
    np.testing.assert_array_equal(lowest_in_columns(heat_of(values)), values.T)


def test_a_column_of_many_frames_shows_the_lowest():
    values = np.random.default_rng(6).uniform(0.5, 1.0, (10_000, 2))
    found = lowest_in_columns(heat_of(values, frames=np.arange(7, 10_007)))
    np.testing.assert_array_equal(found, values.reshape(1000, 10, 2).min(axis=1).T)


def test_what_is_missing_is_transparent():
    found = lowest_in_columns(heat_of([[0.6, np.nan], [np.nan, np.nan], [0.7, 0.8]], [3, 4, 6]))
    np.testing.assert_array_equal(found, [[0.6, np.nan, np.nan, 0.7], [np.nan] * 3 + [0.8]])
    picture = shaded(found, Axis(0.5, 1.0))
    np.testing.assert_array_equal(picture[..., 3], np.where(np.isnan(found), 0, 255))


def test_shades_brighten_with_the_value_and_stop_at_the_ends():
    picture = shaded(np.array([[0.1, 0.5, 0.6, 0.8, 1.0, 1.2]]), Axis(0.5, 1.0))[0]
    brightness = picture[:, :3].astype(int).sum(axis=1)
    assert (picture[0] == picture[1]).all() and (picture[4] == picture[5]).all()
    assert (np.diff(brightness[1:5]) > 0).all()


def test_the_figure_holds_the_picture_and_names_its_rows():
    heat = heat_of(np.full((20, 2), 0.9), names=["<a>", "b"])
    text = heat_figure(heat)
    picture, ramp = pictures_of(text)
    assert picture.shape == (2, 20, 4) and ramp.shape == (1, 64, 4)
    assert "&lt;a&gt;</span>" in text and "0.50 or less" in text


def test_frame_marks_stand_in_the_middle_of_their_column():
    marks = re.findall(r'class="x" style="left:([\d.]+)%">(\d+)<', heat_figure(heat_of([[1], [1]])))
    assert marks == [("25.00", "0"), ("75.00", "1")]
