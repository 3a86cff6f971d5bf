"""Tables of a page."""

from collections.abc import Iterable, Sequence

from .markup import Html, element


def table(headings: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> Html:
    """A table that scrolls sideways where it does not fit.

    Args:
        headings: of the columns.
        rows: texts or `Html`.
        words: how many columns, from the left, hold words; the others hold numbers.
    """

    def cells(name: str, row: Sequence[str]) -> Html:
        classes = [None] * words + ["number"] * (len(headings) - words)
        pairs = zip(row, classes, strict=True)
        return element("tr", *(element(name, cell, class_=kind) for cell, kind in pairs))

    head = element("thead", cells("th", headings))
    body = element("tbody", *(cells("td", row) for row in rows))
    return element("div", element("table", head, body), class_="scroll")


def facts(pairs: Iterable[tuple[str, str]]) -> Html:
    """Names and what they are, line by line."""
    rows = (element("tr", element("th", name), element("td", value)) for name, value in pairs)
    return element(
        "div", element("table", element("tbody", *rows), class_="facts"), class_="scroll"
    )
