import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.motion.curves import followed, hermite, key_slopes, quaternions

KEYS = np.array([0, 1, 5, 6, 13, 20])


def wandering(seed):
    """(21, 3, 4) motions of a joint."""
    rng = np.random.default_rng(seed)
    vectors = np.cumsum(rng.normal(0, 0.2, (21, 3)), axis=0)
    rotations = Rotation.from_rotvec(vectors).as_matrix()
    return np.concatenate([rotations, rng.normal(size=(21, 3, 1))], axis=2)


def test_quaternions_stay_on_one_side_over_whole_turns():
    turning = Rotation.from_rotvec(np.linspace(0, 20, 80)[:, None] * [0, 0.6, 0.8]).as_matrix()
    found = quaternions(turning)
    assert (np.einsum("ti,ti->t", found[1:], found[:-1]) > 0).all() and found[0, 0] > 0
    assert np.allclose(Rotation.from_quat(found[:, [1, 2, 3, 0]]).as_matrix(), turning)


def test_keys_stand_for_themselves_and_rotations_stay_rotations():
    motions = wandering(0)
    found = followed(motions, KEYS)
    assert np.abs(found[KEYS] - motions[KEYS]).max() < 1e-12
    assert np.abs(found - motions).max() > 0.05
    turned = found[..., :3] @ found[..., :3].transpose(0, 2, 1)
    assert np.abs(turned - np.eye(3)).max() < 1e-12
    assert np.array_equal(followed(motions, np.arange(21)), motions)


def test_no_other_slopes_bring_the_curves_nearer():
    values = np.random.default_rng(1).normal(size=(21, 2))

    def off(slopes):
        curve = CubicHermiteSpline(KEYS, values[KEYS], slopes)(np.arange(21))
        natural = np.gradient(values, axis=0)[KEYS]
        return ((curve - values) ** 2).sum() + 1e-2 * ((slopes - natural) ** 2).sum()

    best = key_slopes(values, KEYS)
    for row, column in np.ndindex(best.shape):
        for step in (-1e-3, 1e-3):
            other = best.copy()
            other[row, column] += step
            assert off(other) > off(best)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_a_cubic_is_that_of_scipy(share):
    ends, slopes = np.array([1.0, 3.0]), np.array([-2.0, 5.0])
    expected = CubicHermiteSpline([0, 1], ends, slopes)(share)
    assert hermite(tuple(ends), tuple(slopes), share) == pytest.approx(float(expected))
