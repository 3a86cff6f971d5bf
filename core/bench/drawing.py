"""What pictures of figures are drawn with: texts, lines, a legend, and the paper below."""

from collections.abc import Sequence

from ..pages.markup import Html, element

WIDTH, TOP, BOTTOM = 860, 44, 42
"""px of a picture, and of its margins above and below."""
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_STYLE = (
    "text{font:12px system-ui,sans-serif;fill:#16191f}.title{font-weight:600;font-size:14px}"
    ".soft{fill:#5b6472}.grid{stroke:#dde1e7}.paper{fill:#fff}"
)


def legend(series: Sequence[str], left: float, step: float = 130) -> list[Html]:
    """Colours and names below the title, from ``left`` on."""
    shapes = []
    for k, name in enumerate(series):
        x = left + step * k
        fill = COLOURS[k % len(COLOURS)]
        shapes.append(element("rect", x=x, y=TOP - 9, width=12, height=12, fill=fill))
        shapes.append(text(name, x + 18, TOP + 1, "start"))
    return shapes


def axis_unit(unit: str, height: float) -> Html:
    """What the axis below shows."""
    return text(unit, WIDTH - 12, height - 8, "end", "soft")


def line(x1: float, y1: float, x2: float, y2: float) -> Html:
    """A line of the grid."""
    ends = {"x1": x1, "y1": y1, "x2": x2, "y2": y2}
    return element("line", **{k: f"{v:.1f}" for k, v in ends.items()}, class_="grid")


def text(words: str, x: float, y: float, anchor: str, class_: str | None = None) -> Html:
    """Words whose start, middle or end is at ``x``."""
    return element("text", words, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=class_)


def picture(title: str, height: float, shapes: Sequence[Html]) -> str:
    """SVG with a title."""
    paper = element("rect", width="100%", height="100%", class_="paper")
    head = element("text", title, x=12, y=22, class_="title")
    whole = element(
        "svg", element("style", Html(_STYLE)), paper, head, *shapes,
        xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {WIDTH} {height:.0f}",
        role="img", aria_label=title,
    )  # fmt: skip
    return whole + "\n"
