import numpy as np
from silhouette_mocap.core.fitting.view_trust import view_weights


def test_views_that_agree_are_trusted():
    shown = np.array([1000, 2000, 1500, 800])
    np.testing.assert_array_equal(view_weights(shown * 0.08, shown), 1)
    # a pose that fits none of them is no fault of a view
    np.testing.assert_array_equal(view_weights(shown * 0.7, shown), 1)


def test_a_view_that_shows_something_else_counts_for_next_to_nothing():
    shown = np.full(5, 1000)
    weights = view_weights(np.array([80, 90, 1000, 70, 100]), shown)
    assert weights[2] < 0.01
    np.testing.assert_array_equal(np.delete(weights, 2), 1)


def test_the_further_a_view_is_off_the_less_it_counts():
    shown = np.full(4, 1000)
    found = [view_weights(np.array([80, 80, 80, px]), shown)[3] for px in (100, 200, 300, 500)]
    assert found[0] == 1
    assert found == sorted(found, reverse=True)


def test_views_that_show_nobody_say_nothing_about_the_others():
    weights = view_weights(np.array([80, 0, 90, 0]), np.array([1000, 0, 1000, 0]))
    np.testing.assert_array_equal(weights, 1)
    np.testing.assert_array_equal(view_weights(np.zeros(3), np.zeros(3)), 1)
