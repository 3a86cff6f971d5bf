"""The DOF table of a body as Markdown, for the documentation."""

import numpy as np

from .body import Body, DofKind

HEADER = ("#", "name", "joint", "kind", "axis", "lowest", "highest", "rest spread", "positive")


def dof_table(body: Body) -> str:
    """One Markdown line per DOF: degrees for angles, metres for translations, — where unbounded."""
    lines = [HEADER, ("---",) * len(HEADER), *(_cells(body, row) for row in range(len(body.dofs)))]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def _cells(body: Body, row: int) -> tuple[str, ...]:
    dofs = body.dofs
    kind = DofKind(int(dofs.kinds[row]))
    axis = ", ".join(f"{x + 0.0:.2f}" for x in np.round(dofs.axes[row], 2))
    values = (*dofs.limits[row], dofs.rest_spread[row])
    return (
        str(row),
        dofs.names[row],
        body.joint_names[dofs.joints[row]],
        kind.name.lower(),
        axis,
        *(_value(value, kind) for value in values),
        dofs.directions[row],
    )


def _value(value: float, kind: DofKind) -> str:
    if not np.isfinite(value):
        return "—"
    return f"{value:.3f} m" if kind == DofKind.TRANSLATION else f"{np.degrees(value):.0f}°"
