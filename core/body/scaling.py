"""A body of another size."""

from dataclasses import replace

from .body import Body


def scaled(body: Body, factor: float) -> Body:
    """The body with every length and girth times ``factor``.

    Angles, limits (translations included) and rest priors stay as they are.

    Raises:
        ValueError: a factor that is not above 0.
    """
    if not factor > 0:
        raise ValueError(f"expected a factor above 0, got {factor}")
    surfaces = tuple(
        replace(s, vertices=s.vertices * factor, outline_distance=s.outline_distance * factor)
        for s in body.surfaces
    )
    return replace(
        body,
        offsets=body.offsets * factor,
        tails=body.tails * factor,
        point_offsets=body.point_offsets * factor,
        surfaces=surfaces,
    )
