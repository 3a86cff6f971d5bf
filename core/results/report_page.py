"""report.html: how well a fit went, for people, in one file that opens offline."""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from urllib.parse import quote

import numpy as np

from ..motion.motion import Motion
from ..motion.overlay import BOTH, MODEL_ONLY, OBSERVED_ONLY
from ..pages.chart import Series, swatch
from ..pages.document import Page, Section, bullets, jpeg_picture, paragraphs, tiles, write_page
from ..pages.markup import Html, element, joined
from ..pages.table import facts, table
from ..pages.wording import counted, data_size, decimal, duration, whole
from .report_charts import motion_charts, spoken
from .verdict import Verdict, verdict
from .worst_frames import BadFrame, worst_frames

_PICTURES = 6
_MOST_FILES = 60


def write_report_page(
    path: Path, motion: Motion, report: dict, picture: Callable[[int], bytes | None]
) -> None:
    """Writes the page, whole or not at all.

    Args:
        path: the .html file; the files beside it are listed.
        motion: the tracked frames, at least one.
        report: what report.json holds.
        picture: the overlay picture of a frame as JPEG; None where there is none.

    Raises:
        MocapError: it cannot be written.
    """
    judged, worst = verdict(motion, report), worst_frames(motion, _PICTURES)
    sections = (
        Section("worst", "Worst frames", _worst(worst, picture)),
        Section("plots", "Frame by frame", _plots(motion, report, [bad.frame for bad in worst])),
        Section("cameras", "Cameras", _cameras(motion, report)),
        Section("error", "Error against the truth", _error(report)),
        Section("notes", "Notes", bullets(report["notes"])),
        Section("settings", "Settings", facts(_plain(_settings(report)))),
        Section("versions", "Versions", facts(_plain(report["versions"]))),
        Section("files", "Files", _files(path.parent)),
    )
    page = Page("fit report", report["take"], _summary(judged, motion, report), sections)
    write_page(path, page)


def _summary(judged: Verdict, motion: Motion, report: dict) -> Html:
    error = report["error_mm"]
    figures = [
        (whole(len(motion.frames)), f"of {counted(judged.expected, 'frame')} tracked"),
        (decimal(judged.iou, 3), "mean IoU"),
        (whole(int(motion.lost.sum())), "lost frames"),
        (f"{decimal(report['contour_px'])} px", "median contour distance"),
        (duration(sum(report["seconds_per_frame"])), "time of the fit"),
    ]
    if error:
        figures.insert(3, (f"{decimal(error['absolute']['mean'], 1)} mm", "mean error"))
    badge = element("span", judged.word, class_=f"badge {judged.tone}")
    return joined((element("p", badge, judged.sentence, class_="verdict"), tiles(figures)))


def _worst(worst: Sequence[BadFrame], picture: Callable[[int], bytes | None]) -> Html:
    explained = element(
        "p", *_colour("observed and model agree", BOTH), *_colour("model only", MODEL_ONLY),
        *_colour("performer only", OBSERVED_ONLY), class_="soft",
    )  # fmt: skip
    shown = (_bad_frame(bad, picture) for bad in worst)
    return joined((explained, element("div", *shown, class_="pictures")))


def _colour(meaning: str, bgr: tuple[int, int, int]) -> tuple[Html, str]:
    red, green, blue = bgr[::-1]
    return element("span", class_="dot", style=f"background:rgb({red},{green},{blue})"), meaning


def _bad_frame(bad: BadFrame, picture: Callable[[int], bytes | None]) -> Html:
    data = picture(bad.frame)
    image = Html() if data is None else jpeg_picture(data, f"all cameras at frame {bad.frame}")
    title = f"Frame {bad.frame}: " + (
        "nobody observed" if np.isnan(bad.iou) else f"IoU {decimal(bad.iou, 3)}"
    )
    lost = (" ", element("span", "lost", class_="badge bad")) if bad.lost else ()
    caption = element("figcaption", element("b", title, *lost), "; ".join(_reasons(bad)))
    return element("figure", image, caption, id=f"frame-{bad.frame}")


def _reasons(bad: BadFrame) -> Iterator[str]:
    if bad.camera is not None:
        here, usual = (decimal(value, 3) for value in bad.camera_iou)
        yield f"worst camera {bad.camera}: IoU {here}, usually {usual}"
    if bad.limb is not None:
        here, usual = (decimal(value, 1) for value in bad.limb_px)
        yield f"worst limb {spoken(bad.limb)}: {here} px off, usually {usual} px"
    if bad.hidden:
        yield f"no camera shows {', '.join(map(spoken, bad.hidden))}"
    if bad.unseen:
        yield f"nobody observed by {', '.join(bad.unseen)}"


def _plots(motion: Motion, report: dict, flagged: Sequence[int]) -> Html:
    note = "Under the mouse: the values at that frame. Else each legend gives the mean. "
    note += "Flags lead to the pictures above."
    lost = int(motion.lost.sum())
    if lost:
        note += f" Shaded: {counted(lost, 'lost frame')}."
    charts = motion_charts(motion, report["seconds_per_frame"], flagged)
    return joined((element("p", note, class_="soft"), charts))


def _cameras(motion: Motion, report: dict) -> Html:
    headings = (
        "camera", "footage px", "working px", "mm per px", "mean IoU", "worst frame", "its IoU",
        "mean XOR px",
    )  # fmt: skip
    rows = []
    for view, name in enumerate(motion.camera_names):
        known = report["cameras"].get(name, {})
        iou, xor = motion.iou[:, view], motion.xor_px[:, view]
        worst = None if np.isnan(iou).all() else int(np.nanargmin(iou))
        label = joined((swatch(Series(name, iou, view).classes), element("span", name)))
        rows.append(
            (
                label,
                _size(known.get("footage_size")),
                _size(known.get("working_size")),
                decimal(known.get("mm_per_px"), 1),
                decimal(report["iou_per_camera"].get(name), 3),
                decimal(None) if worst is None else str(int(motion.frames[worst])),
                decimal(None if worst is None else float(iou[worst]), 3),
                whole(float(xor.mean())),
            )
        )
    return joined(
        (
            bullets([finding["text"] for finding in report["camera_findings"]]),
            table(headings, rows),
            element("p", "XOR px and residuals count working px.", class_="soft"),
        )
    )


def _size(size: list[int] | None) -> str:
    return decimal(None) if size is None else f"{size[0]} × {size[1]}"


def _error(report: dict) -> Html:
    error = report["error_mm"]
    if not error:
        return Html()
    headings = ("point", "mean mm", "median", "95 %", "largest", "mean, offset removed")
    rows = [
        (
            spoken(name),
            *(decimal(point["error"][key], 1) for key in ("mean", "median", "p95", "max")),
            decimal(point["offset_removed"], 1),
        )
        for name, point in error["points"].items()
    ]
    whole_row = (
        element("b", "all points"),
        *(decimal(error["absolute"][key], 1) for key in ("mean", "median", "p95", "max")),
        decimal(error["offset_removed"]["mean"], 1),
    )
    told = (
        f"Worst frame {error['worst_frame']}; of {counted(error['frames'], 'frame')}, "
        f"{error['lost_frames']} are off by more than 150 mm or missing. Offsets removed: what "
        "stays after taking out each point's constant offset, since joint centres are defined "
        "differently from system to system."
    )
    return joined((table(headings, [whole_row, *rows]), element("p", told, class_="soft")))


def _settings(report: dict) -> dict:
    """With the kinds of evaluators that drew the frames, which may be other than asked for."""
    return {**report["settings"], "frames_by_evaluator": report["evaluators"]}


def _plain(values: dict) -> list[tuple[str, str]]:
    return [(spoken(str(key)), _text(value)) for key, value in values.items()]


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value)) or "none"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, dict) else str(value)


def _files(folder: Path) -> Html:
    found = sorted(
        (path for path in folder.iterdir() if path.is_file() and path.name[0] != "."),
        key=lambda path: path.name,
    )
    rows = [(_link(path.name), data_size(path.stat().st_size)) for path in found[:_MOST_FILES]]
    more = len(found) - len(rows)
    further = paragraphs(f"and {counted(more, 'further file')}") if more else Html()
    later = "overlay.mp4 and exports in other formats are written after this page."
    return joined((table((str(folder), "size"), rows), further, element("p", later, class_="soft")))


def _link(name: str) -> Html:
    return element("a", name, href="./" + quote(name, errors="surrogateescape"))
