"""Whole pages: one file that fetches nothing."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from silhouette_mocap.core import pages
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.pages.document import (
    Page,
    Section,
    bullets,
    jpeg_picture,
    tiles,
    write_page,
)
from silhouette_mocap.core.pages.markup import Html, element
from silhouette_mocap.core.pages.table import facts, table

FOLDER = Path(pages.__file__).parent


class Reader(HTMLParser):
    """Checks that elements nest, and collects texts and links."""

    def __init__(self, text):
        super().__init__()
        self.open, self.links, self.texts = [], [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)
        self.links += [value for key, value in attributes if key in ("href", "src", "data")]

    def handle_startendtag(self, tag, attributes):
        self.links += [value for key, value in attributes if key in ("href", "src", "data")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "script"):
            self.texts.append(data)


SOMETHING = element("p", "x")


def page_of(content=SOMETHING):
    sections = (Section("one", "One & only", content), Section("none", "Left out", Html()))
    return Page("report", "take <1>", element("p", "fine"), sections)


def test_elements_nest_and_titles_are_escaped():
    reader = Reader(page_of().html())
    assert "take <1>" in reader.texts and "One & only" in reader.texts


def test_sections_without_content_are_left_out():
    assert "Left out" not in page_of().html()


def test_nothing_is_fetched():
    content = jpeg_picture(b"\xff\xd8picture", "a picture")
    text = page_of(content).html()
    links = Reader(text).links
    assert links and all(link.startswith(("#", "data:image/jpeg;base64,")) for link in links)
    assert not re.search(r"https?:|url\(|@import|\ssrcset", text)
    assert "default-src &#x27;none&#x27;" in text


def test_style_and_script_cannot_end_their_element():
    for asset in FOLDER.glob("page.*"):
        assert "</" not in asset.read_text("utf-8")


def test_all_files_of_the_package_are_shipped():
    suffixes = {path.suffix for path in FOLDER.iterdir() if path.is_file()} - {".py"}
    root = FOLDER.parents[1]
    for name in ("setup.py", "MANIFEST.in"):
        text = (root / name).read_text("utf-8")
        assert all(f"*{suffix}" in text for suffix in suffixes)


def test_a_page_that_cannot_be_written_is_a_fault(tmp_path):
    with pytest.raises(MocapError, match="cannot be written"):
        write_page(tmp_path / "missing" / "page.html", page_of())


def test_pages_are_utf_8(tmp_path):
    write_page(tmp_path / "p.html", page_of(element("p", "Bühne\udcff")))
    assert "Bühne\ufffd" in (tmp_path / "p.html").read_bytes().decode("utf-8")


def test_tables_tell_words_from_numbers_and_escape_both():
    text = table(("a", "b"), [("<x>", "1")])
    assert "<td>&lt;x&gt;</td>" in text and '<td class="number">1</td>' in text
    with pytest.raises(ValueError):
        table(("a", "b"), [("only one",)])


def test_small_parts():
    assert bullets([]) == "" and bullets(["<"]) == "<ul><li>&lt;</li></ul>"
    assert "<th>a&amp;b</th><td>c</td>" in facts([("a&b", "c")])
    assert "<dd>3</dd><dt>frames</dt>" in tiles([("3", "frames")])
