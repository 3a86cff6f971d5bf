"""The performer's measures, as a fitted shape tells them."""

from dataclasses import dataclass

from ..body.kinematics import rest_height
from .shape_fit import ShapeFit

_TOO_SURE = 1.5
"""Times the deviations that prior and silhouettes leave, by which lengths are really off: measured
with takes whose performers' lengths are known."""


@dataclass(frozen=True)
class Length:
    """A bone's length, or that of an end.

    Attributes:
        name: of its segment, without its side.
        metres: how long.
        deviation: how uncertain that is, standard deviation in metres.
        against: how much longer it is than in the template scaled to the performer's height, as a
            share.
    """

    name: str
    metres: float
    deviation: float
    against: float


def lengths_of(fit: ShapeFit) -> tuple[Length, ...]:
    """The lengths of all bones, left and right being one."""
    share = rest_height(fit.body) / rest_height(fit.template)
    usual = fit.model.bones(fit.template)
    return tuple(
        Length(
            name=fit.model.factors[index].name.rsplit(" ", 1)[0].replace("_", " "),
            metres=metres,
            deviation=_TOO_SURE * float(fit.deviations[index]) * metres,
            against=metres / (share * usual[index]) - 1.0,
        )
        for index, metres in fit.model.bones(fit.body).items()
    )
