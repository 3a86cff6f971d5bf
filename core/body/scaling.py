"""Bodies of another size."""

from dataclasses import replace

from .body import Body, Surface


def scaled(body: Body, factor: float) -> Body:
    """``body`` grown uniformly by ``factor``; angles and limits stay."""
    surfaces = tuple(
        Surface(s.vertices * factor, s.triangles, s.vertex_starts, s.triangle_starts)
        for s in body.surfaces
    )
    return replace(
        body,
        offsets=body.offsets * factor,
        tails=body.tails * factor,
        surfaces=surfaces,
        point_offsets=body.point_offsets * factor,
    )
