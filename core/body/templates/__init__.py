"""Bodies made by code, by name."""

from collections.abc import Callable

from ...errors import MocapError
from ..body import Body
from .eleven_segment import eleven_segment
from .nine_joint import nine_joint
from .performer import performer
from .proportions import Proportions
from .sixteen_segment import sixteen_segment

TEMPLATES: dict[str, Callable[..., Body]] = {
    "performer": performer,
    "sixteen_segment": sixteen_segment,
    "eleven_segment": eleven_segment,
    "nine_joint": nine_joint,
}


def template(name: str, proportions: Proportions | None = None) -> Body:
    """The template called ``name``, the average adult unless ``proportions`` are given.

    Raises:
        MocapError: no such template.
    """
    if name not in TEMPLATES:
        raise MocapError(f"unknown body {name!r}", f"choose one of {', '.join(sorted(TEMPLATES))}")
    return TEMPLATES[name](proportions)
