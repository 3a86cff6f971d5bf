"""Elements, and that no text becomes markup."""

import pytest
from silhouette_mocap.core.pages.markup import Html, element, escaped, joined


def test_texts_are_escaped_and_elements_are_not():
    made = element("p", "a < b & c", element("b", '"d"'), class_="x", data_frame=3)
    assert made == '<p class="x" data-frame="3">a &lt; b &amp; c<b>&quot;d&quot;</b></p>'


def test_attributes_are_escaped_and_none_leaves_one_out():
    assert element("img", alt='"><script>', src=None) == '<img alt="&quot;&gt;&lt;script&gt;"/>'


def test_an_attribute_may_be_called_name():
    assert element("meta", name="a") == '<meta name="a"/>'


def test_empty_elements_are_closed_but_for_those_that_cannot_hold_anything():
    assert element("td") == "<td></td>"
    assert element("line", x1=0) == '<line x1="0"/>'


@pytest.mark.parametrize("text", ["\udce4", "\x00", "\x1b", "\x9f", "\uffff", "a\ud83d"])
def test_what_no_page_may_hold_is_replaced(text):
    shown = escaped(text)
    assert "\ufffd" in shown and shown.encode("utf-8")


def test_letters_outside_of_the_basic_plane_stay():
    assert escaped("Bühne 🎬 後\n") == "Bühne 🎬 後\n"


def test_joined_escapes_what_is_no_markup():
    assert joined(["<", Html("<br/>")]) == "&lt;<br/>"
