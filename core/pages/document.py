"""A whole page in one file: style and script inside, nothing fetched from anywhere."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from ..files import whole_file
from .markup import Html, element, joined

# the browser itself refuses whatever is not in the page
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


@dataclass(frozen=True)
class Section:
    """A part of a page.

    Attributes:
        key: its anchor.
        title: its heading.
        content: below it.
    """

    key: str
    title: str
    content: Html


@dataclass(frozen=True)
class Page:
    """What a page shows.

    Attributes:
        kind: what sort of page it is, above the title.
        title: heading, and name of the window.
        summary: below the title.
        sections: in order; those without content are left out.
    """

    kind: str
    title: str
    summary: Html
    sections: Sequence[Section]

    def html(self) -> str:
        """The whole document."""
        shown = [section for section in self.sections if section.content]
        links = (element("a", section.title, href=f"#{section.key}") for section in shown)
        header = element(
            "header", element("p", f"Silhouette Mocap · {self.kind}", class_="kind"),
            element("h1", self.title), self.summary,
        )  # fmt: skip
        parts = (
            element("section", element("h2", part.title), part.content, id=part.key)
            for part in shown
        )
        body = element("body", header, element("nav", *links), element("main", *parts), _script())
        return "<!DOCTYPE html>\n" + element("html", self._head(), body, lang="en") + "\n"

    def _head(self) -> Html:
        return element(
            "head",
            element("meta", charset="utf-8"),
            element("meta", http_equiv="Content-Security-Policy", content=_POLICY),
            element("meta", name="viewport", content="width=device-width, initial-scale=1"),
            element("meta", name="color-scheme", content="light dark"),
            element("title", f"{self.title} · {self.kind}"),
            element("style", Html(_asset("page.css"))),
        )


def write_page(path: Path, page: Page) -> None:
    """Writes the page, whole or not at all.

    Raises:
        MocapError: it cannot be written.
    """
    text = page.html()
    with whole_file(path) as partial:
        partial.write_text(text, "utf-8", newline="\n")


def tiles(values: Sequence[tuple[str, str]]) -> Html:
    """Figures in large print, each (value, what it is)."""
    return element(
        "dl",
        *(
            element("div", element("dd", value), element("dt", name), class_="tile")
            for value, name in values
        ),
        class_="tiles",
    )


def jpeg_picture(data: bytes, description: str) -> Html:
    """A JPEG picture inside the page."""
    return _picture("image/jpeg", data, description)


def png_picture(picture: np.ndarray, description: str) -> Html:
    """A (H, W, 4) uint8 BGRA picture inside the page."""
    return _picture("image/png", cv2.imencode(".png", picture)[1].tobytes(), description)


def _picture(kind: str, data: bytes, description: str) -> Html:
    source = f"data:{kind};base64," + base64.b64encode(data).decode("ascii")
    return element("img", src=source, alt=description)


def bullets(lines: Sequence[str], class_: str | None = None) -> Html:
    """A list; nothing where there are no lines."""
    if not lines:
        return Html()
    return element("ul", *(element("li", line) for line in lines), class_=class_)


def paragraphs(*texts: str) -> Html:
    """Each text a paragraph of its own."""
    return joined(element("p", text) for text in texts)


def _script() -> Html:
    return element("script", Html(_asset("page.js")))


@cache
def _asset(name: str) -> str:
    return Path(__file__).with_name(name).read_text("utf-8")
