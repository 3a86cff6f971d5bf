"""The sheet of a take: what its cameras see and how they stand, on one page."""

import re
from pathlib import Path

import cv2
import numpy as np

from ..motion.overlay import Tile, coloured
from ..pages.chart import Series, swatch
from ..pages.document import Page, Section, bullets, jpeg_picture, tiles, write_page
from ..pages.markup import Html, element, joined
from ..pages.table import facts, table
from ..pages.wording import data_size, decimal, duration, whole
from .check import TakeCheck
from .footage_check import FootageFacts
from .studio_plan import Studio, plan_from_above, view_from_the_side
from .words import (
    CAMERA_HEADINGS,
    camera_words,
    estimate_words,
    footage_words,
    looked_words,
    opposite_words,
    readiness,
    scale_words,
    size_words,
    take_words,
)

_THUMBNAIL_PX = 480
_KIND = "take sheet"
SHEET = re.compile(f"<!DOCTYPE html>.*· {_KIND}</title>".encode(), re.DOTALL)
"""What every sheet begins with."""


def write_check_sheet(path: Path, check: TakeCheck) -> None:
    """Writes the page, whole or not at all.

    Raises:
        MocapError: it cannot be written.
    """
    sections = (
        Section("notes", "Notes", bullets(check.notes)),
        Section("studio", "Studio", _studio(check)),
        Section("pictures", "First pictures", _pictures(check)),
        Section("footage", "Footage", _footage(check)),
        Section("take", "Take", facts(take_words(check))),
        Section(
            "estimate", "Estimate",
            facts(estimate_words(check.estimate)) if check.estimate else Html(),
        ),
    )  # fmt: skip
    write_page(path, Page(_KIND, check.take.name, _summary(check), sections))


def _summary(check: TakeCheck) -> Html:
    word, tone = ("Not ready", "bad") if check.faults else ("Ready", "good")
    badge = element("span", word, class_=f"badge {tone}")
    verdict = element("p", badge, readiness(check), class_="verdict")
    faults = bullets([str(fault) for fault in check.faults], "faults")
    return joined((verdict, faults, tiles(_figures(check))))


def _figures(check: TakeCheck) -> list[tuple[str, str]]:
    figures = [(whole(len(check.cameras)), "cameras")]
    if check.frames is not None:
        figures.append((whole(check.frames[1] - check.frames[0] + 1), "frames"))
    figures.append((scale_words(check.cameras), "mm per px at the performer"))
    if check.performer is not None:
        figures.append((f"{decimal(check.performer.height_m)} m", "performer's height"))
    if check.estimate is not None:
        figures.append((f"≈ {duration(check.estimate.total_s)}", "to fit, on this machine"))
        figures.append((f"≈ {data_size(check.estimate.meanwhile_bytes)}", "of disk meanwhile"))
    return figures


def _studio(check: TakeCheck) -> Html:
    if not check.cameras:
        return Html()
    studio = Studio(check.cameras, check.opposite, check.performer, check.take.floor)
    told = facts(
        [("units", check.units or "unknown"), ("face each other", opposite_words(check.opposite))]
    )
    drawings = element(
        "div",
        element("figure", plan_from_above(studio), element("figcaption", "From above")),
        element("figure", view_from_the_side(studio), element("figcaption", "From the side"), told),
        class_="plans",
    )
    rows = []
    for view, camera in enumerate(check.cameras):
        name, *rest = camera_words(camera)
        rows.append((_name(name, view), *rest))
    return joined((drawings, table(CAMERA_HEADINGS, rows, words=2)))


def _name(name: str, view: int) -> Html:
    line = swatch(Series(name, np.zeros(0), view).classes)
    return joined((line, element("span", name)))


def _pictures(check: TakeCheck) -> Html:
    shown = [_thumbnail(footage) for footage in check.footage if footage.picture is not None]
    return element("div", *shown, class_="pictures small") if shown else Html()


def _thumbnail(footage: FootageFacts) -> Html:
    assert footage.picture is not None and footage.silhouette is not None
    nothing = np.zeros(footage.silhouette.foreground.shape, bool)
    over = coloured(Tile("", footage.picture, footage.silhouette, nothing))
    both = over if footage.is_masks else np.hstack([footage.picture, over])
    shrink = _THUMBNAIL_PX / max(both.shape[:2])
    if shrink < 1:
        both = cv2.resize(both, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA)
    data = cv2.imencode(".jpg", both, (cv2.IMWRITE_JPEG_QUALITY, 85))[1].tobytes()
    caption = element(
        "figcaption", element("b", footage.camera),
        f"{size_words(footage.size)} px; {looked_words(footage)}",
    )  # fmt: skip
    image = jpeg_picture(data, f"first picture and silhouette of {footage.camera}")
    return element("figure", image, caption)


def _footage(check: TakeCheck) -> Html:
    return facts([(footage.camera, footage_words(footage)) for footage in check.footage])
