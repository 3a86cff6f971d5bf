"""HTML and SVG put together from elements; every text is escaped on its way in.

Pages show names that come from files. A plain ``str`` is therefore text, never markup: only what
`element` made is `Html` and passes unescaped.
"""

import html
import re
from collections.abc import Iterable

_VOID = frozenset(("br", "col", "hr", "img", "input", "link", "meta", "wbr"))
_SHAPES = frozenset(("circle", "line", "path", "polygon", "polyline", "rect", "image", "use"))
# control characters are allowed in neither HTML nor XML
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufffe\uffff]")


class Html(str):
    """Markup that needs no escaping."""


def element(name: str, /, *children: str, **attributes: object) -> Html:
    """One element.

    Args:
        name: of the element.
        children: texts, which are escaped, or `Html`.
        attributes: by name; a trailing underscore is dropped (``class_``) and others become
            hyphens (``data_frame``). None leaves an attribute out.
    """
    known = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escaped(str(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    if name in _VOID or (name in _SHAPES and not children):
        return Html(f"<{name}{known}/>")
    return Html(f"<{name}{known}>{joined(children)}</{name}>")


def joined(children: Iterable[str]) -> Html:
    """The children one after another."""
    return Html("".join(child if isinstance(child, Html) else escaped(child) for child in children))


def escaped(text: str) -> Html:
    """``text`` as markup; what no page may hold, such as half of a surrogate pair, becomes �."""
    whole = text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
    return Html(html.escape(_FORBIDDEN.sub("\ufffd", whole)))
