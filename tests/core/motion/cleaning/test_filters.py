from itertools import pairwise

import numpy as np
import pytest
from silhouette_mocap.core.motion.cleaning.filters import butterworth, one_euro


@pytest.mark.parametrize("rate", [30.0, 120.0])
@pytest.mark.parametrize("frequency", [3.0, 5.0, 7.0])
def test_butterworth_leaves_what_its_second_order_run_twice_leaves_and_does_not_delay(
    rate, frequency
):
    time = np.arange(round(20 * rate)) / rate
    sine = np.sin(2 * np.pi * frequency * time)[:, None]
    ratio = np.tan(np.pi * frequency / rate) / np.tan(np.pi * 5.0 / rate)
    found = butterworth(sine, rate, 5.0)
    middle = slice(len(time) // 4, -len(time) // 4)
    assert np.abs(found - sine / (1 + ratio**4))[middle].max() < 0.01


@pytest.mark.parametrize("count", [3, 7])
def test_butterworth_takes_few_frames(count):
    assert np.isfinite(butterworth(np.ones((count, 1)), 15.0, 6.0)).all()


def test_one_euro_is_what_its_authors_wrote():
    """Algorithm 1 of the paper, number by number, with a speed per signal of one component."""
    rng = np.random.default_rng(3)
    values, rate, least, beta = rng.normal(size=40), 60.0, 1.5, 4.0

    def alpha(cut_off):
        return 1.0 / (1.0 + 1.0 / (2 * np.pi * cut_off) * rate)

    expected, slow = [values[0]], 0.0
    for before, value in pairwise(values):
        speed = (value - before) * rate
        slow = alpha(1.0) * speed + (1 - alpha(1.0)) * slow
        share = alpha(least + beta * abs(slow))
        expected.append(share * value + (1 - share) * expected[-1])
    assert np.allclose(one_euro(values[:, None], rate, least)[:, 0], expected)


def test_one_euro_knows_the_past_alone():
    values = np.random.default_rng(5).normal(size=(30, 2))
    changed = values.copy()
    changed[20:] += 5
    assert np.array_equal(one_euro(values, 30.0, 2.0)[:20], one_euro(changed, 30.0, 2.0)[:20])
