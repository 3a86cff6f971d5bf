"""report.html against the motion it shows."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from motion_made_up import motion_of, report_of
from silhouette_mocap.core.results.report_page import write_report_page

PICTURE = b"\xff\xd8 a picture"


@pytest.fixture
def motion():
    rng = np.random.default_rng(3)
    iou = rng.uniform(0.7, 0.9, (60, 3))
    iou[20, 1] = 0.1
    iou[40:45, 2] = np.nan
    names = ("front", '<b>left</b>&"', "back\udcff")
    confidence = rng.uniform(0.5, 1.0, (60, 14))
    return motion_of(
        iou, camera_names=names, frames=np.arange(100, 160), lost=np.arange(60) == 20,
        confidence=confidence,
    )  # fmt: skip


def page_of(motion, folder, picture=lambda frame: PICTURE, **report) -> str:
    write_report_page(folder / "report.html", motion, report_of(motion, **report), picture)
    return (folder / "report.html").read_text("utf-8")


def charts_of(text):
    figures = re.findall(r'<figure class="chart".*?</figure>', text)
    return {
        figure.findtext("figcaption/b"): figure for figure in map(ElementTree.fromstring, figures)
    }


def drawn_values(figure, line):
    low, high = float(figure.get("data-low")), float(figure.get("data-high"))
    points = [p for shape in line for p in shape.get("points").split()]
    return np.array([high - float(p.split(",")[1]) / 1000 * (high - low) for p in points])


def test_the_charts_show_the_motion(motion, tmp_path):
    charts = charts_of(page_of(motion, tmp_path))
    figure = charts["Agreement"]
    lines = figure.findall("div/svg/g")
    assert len(lines) == 4 and lines[3].get("class") == "line bold"
    for line, column in zip(lines, motion.iou.T, strict=False):
        finite = column[np.isfinite(column)]
        np.testing.assert_allclose(drawn_values(figure, line), finite, atol=1e-4)
    np.testing.assert_allclose(
        drawn_values(figure, lines[3]), np.nanmean(motion.iou, axis=1), atol=1e-4
    )
    xor = charts["Differing pixels"]
    np.testing.assert_allclose(
        drawn_values(xor, xor.findall("div/svg/g")[0]), motion.xor_px[:, 0], atol=0.11
    )


def test_confidence_is_the_lowest_point_of_each_limb(motion, tmp_path):
    figure = charts_of(page_of(motion, tmp_path))["Confidence"]
    elbow, wrist = (motion.point_names.index(f"left_{name}") for name in ("elbow", "wrist"))
    wanted = motion.confidence[:, [elbow, wrist]].min(axis=1)
    line = figure.findall("div/svg/g")[1]
    np.testing.assert_allclose(drawn_values(figure, line), wanted, atol=1e-4)


def test_lost_frames_are_shaded(motion, tmp_path):
    for figure in charts_of(page_of(motion, tmp_path)).values():
        (band,) = figure.iter("rect")
        assert float(band.get("x")) == pytest.approx(1000 * 19.5 / 59, abs=0.1)


def test_the_worst_frame_comes_first_with_its_picture_and_reason(motion, tmp_path):
    asked = []
    text = page_of(motion, tmp_path, picture=lambda frame: asked.append(frame) or PICTURE)
    assert asked[0] == 120 and len(asked) == 6
    assert text.count("data:image/jpeg;base64,/9gg") == 6
    assert (
        "Frame 120: IoU" in text
        and "worst camera &lt;b&gt;left&lt;/b&gt;&amp;&quot;: IoU 0.100" in text
    )


def test_flags_lead_from_the_chart_to_the_pictures(motion, tmp_path):
    text = page_of(motion, tmp_path)
    flags = re.findall(
        r'<a class="flag" href="#(frame-\d+)" title="[^"]+" style="left:([\d.]+)%', text
    )
    assert len(flags) == 6 and all(f'<figure id="{name}">' in text for name, _ in flags)
    lefts = dict(flags)
    assert float(lefts["frame-120"]) == pytest.approx(100 * 20 / 59, abs=0.01)


def test_a_picture_that_is_gone_is_left_out(motion, tmp_path):
    text = page_of(motion, tmp_path, picture=lambda frame: None)
    assert "image/jpeg" not in text and "Frame 120" in text


def test_names_and_notes_are_escaped(motion, tmp_path):
    text = page_of(motion, tmp_path, notes=["<script>alert(1)</script>"], take="</title><script>")
    assert "<b>left</b>" not in text and "<script>alert" not in text
    assert "</title><script>" not in text and "back\ufffd" in text


def test_nothing_is_fetched(motion, tmp_path):
    assert not re.search(r"https?:|url\(", page_of(motion, tmp_path))


def test_the_table_of_cameras_tells_size_scale_and_worst_frame(motion, tmp_path):
    text = page_of(motion, tmp_path)
    row = re.search(r"<tr><td>.{0,300}<span>front</span></td>(.*?)</tr>", text)[1]
    worst = int(motion.iou[:, 0].argmin())
    wanted = [
        "1920 × 1080", "960 × 540", "3.2", "0.812", str(100 + worst),
        f"{motion.iou[worst, 0]:.3f}", f"{motion.xor_px[:, 0].mean():.0f}",
    ]  # fmt: skip
    assert re.findall(r">([^<]+)</td>", row) == wanted


def test_the_error_stands_point_by_point_where_there_is_truth(motion, tmp_path):
    spread = {"mean": 29.04, "median": 20.0, "p95": 60.0, "max": 162.2}
    points = {"left_wrist": {"error": {**spread, "mean": 77.7}, "offset_removed": 11.4}}
    error = {
        "frames": 60, "lost_frames": 2, "worst_frame": 138, "absolute": spread, "points": points,
        "offset_removed": {**spread, "mean": None},
    }  # fmt: skip
    text = page_of(motion, tmp_path, error_mm=error)
    assert '<td>left wrist</td><td class="number">77.7</td>' in text
    assert "Error against the truth" not in page_of(motion, tmp_path)


def test_files_beside_the_page_are_listed(motion, tmp_path):
    (tmp_path / "a #1.npz").write_bytes(bytes(2500))
    (tmp_path / ".hidden").write_bytes(b"")
    text = page_of(motion, tmp_path)
    assert '<a href="./a%20%231.npz">a #1.npz</a></td><td class="number">2 KB</td>' in text
    assert ">.hidden<" not in text


@pytest.mark.parametrize("frames", [1, 2])
def test_the_shortest_motions_have_a_page(frames, tmp_path):
    iou = np.full((frames, 2), np.nan)
    motion = motion_of(iou, limb_residual=np.full((frames, 5), np.nan))
    text = page_of(motion, tmp_path)
    assert "nobody observed" in text and "nan" not in re.sub(r"<s(tyle|cript)>.*?</s\1>", "", text)


def test_a_long_motion_stays_small(tmp_path):
    rng = np.random.default_rng(4)
    motion = motion_of(
        rng.uniform(0.7, 0.9, (10_000, 8)), limb_residual=rng.uniform(1, 2, (10_000, 5)),
        confidence=rng.uniform(0.5, 1, (10_000, 14)),
    )  # fmt: skip
    page_of(motion, tmp_path, picture=lambda frame: None)
    assert (tmp_path / "report.html").stat().st_size < 1_000_000
