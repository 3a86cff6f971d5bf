"""Where the rings of a lofted mesh stand and how wide they are, so that few of them do.

Of all choices of a given number of rings the one is taken whose straight pieces leave the least
squared distance from the outline, found by dynamic programming (Bellman 1961, On the approximation
of curves by line segments using dynamic programming). What lies beyond the axis's ends counts less:
there a piece of a body mostly stands inside its neighbour.
"""

import numpy as np

BEYOND_WEIGHT = 0.25
"""What a length beyond the axis counts, as a share of one along it; elbows and knees bare it."""
_TIE_UNITS = 1e9
"""Symmetric shapes have ties; whole units let every processor break them alike."""


def sample_weights(stations: np.ndarray) -> np.ndarray:
    """(M,) lengths that samples at rising ``stations`` (M,) stand for, less beyond 0 to 1."""
    beyond = (stations < 0) | (stations > 1)
    return np.gradient(stations) * np.where(beyond, BEYOND_WEIGHT, 1.0)


def chosen_samples(stations: np.ndarray, radii: np.ndarray, count: int) -> np.ndarray:
    """(count,) rising indices of samples between which straight interpolation serves best.

    Of ``stations`` (M,) and ``radii`` (M, 4), as `Profile.sampled` gives them; all M where
    ``count`` is larger. The two ends, the poles, are always taken.
    """
    last = len(stations) - 1
    gaps = min(count - 1, last)
    costs = _gap_costs(stations, radii)
    rising = np.triu(np.ones(costs.shape, bool), 1)
    best, steps = costs[0], []
    for _ in range(gaps - 1):
        sums = np.where(rising, best[:, None] + costs, np.iinfo(np.int64).max // 2)
        sums[0] = np.iinfo(np.int64).max // 2
        steps.append(sums.argmin(axis=0))
        best = sums.min(axis=0)
    chosen = [last]
    for step in reversed(steps):
        chosen.append(int(step[chosen[-1]]))
    return np.array([0, *chosen[::-1]]) if last else np.array([0])


def _gap_costs(stations: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(M, M) int64: what a straight piece from sample i to j leaves, in `_TIE_UNITS` of all.

    The sum over i..j of the weighted squared distances from the best line; from a pole, where the
    radius is 0, from the best line through it.
    """
    weights = sample_weights(stations)

    def sums(values: np.ndarray) -> np.ndarray:
        running = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
        return running[None, 1:] - running[:-1, None]

    columns = weights[:, None], stations[:, None]
    w, ws, wss = (sums(columns[0] * columns[1] ** power) for power in range(3))
    wr, wsr, wrr = (sums(columns[0] * v) for v in (radii, columns[1] * radii, radii**2))
    with np.errstate(divide="ignore", invalid="ignore"):
        left = wrr - wr**2 / w - (wsr - ws * wr / w) ** 2 / (wss - ws**2 / w)
        for pole, place in ((0, np.s_[0, :]), (-1, np.s_[:, -1])):
            s = stations[pole]
            along = (wsr - s * wr)[place] ** 2 / (wss - 2 * s * ws + s**2 * w)[place]
            left[place] = wrr[place] - along
    costs = np.rint(_TIE_UNITS * left.sum(axis=-1) / wrr[0, -1].sum())
    return np.maximum(np.nan_to_num(costs), 0).astype(np.int64)


def fitted_sections(stations: np.ndarray, radii: np.ndarray, picked: np.ndarray) -> np.ndarray:
    """(len(picked), 4) radii whose straight interpolation is nearest to all samples' radii.

    Rings on the surface itself would lie inside it wherever it bulges; these lie astride. The
    poles at both ends keep no radius.
    """
    weights = np.sqrt(sample_weights(stations))[:, None]
    hats = np.array([np.interp(stations, stations[picked], unit) for unit in np.eye(len(picked))])
    fitted = np.zeros((len(picked), 4))
    fitted[1:-1] = np.linalg.lstsq(weights * hats[1:-1].T, weights * radii, rcond=None)[0]
    return np.maximum(fitted, 0)
