import time

import numpy as np
import pytest
from silhouette_mocap.core.bench.stage import candidates_about
from silhouette_mocap.core.bench.turns import Rates, Turns, Variant, measured, order

TURNS = Turns(count=3, seconds=0.004, poses=64, largest_batch=8)


def sums(poses):
    return poses.sum(axis=1).round().astype(int)


def test_medians_and_ratios_are_those_of_the_turns():
    per_turn = np.array([[10.0, 40.0], [20.0, 20.0], [60.0, 90.0]])
    rates = Rates(("slow", "quick"), per_turn, (1, 1), (0, 0))
    assert rates.medians == {"slow": 20.0, "quick": 40.0}
    assert rates.fastest == {"slow": 60.0, "quick": 90.0}
    # of 4, 1 and 1.5 times; the medians' own ratio would be 2
    assert rates.ratio("quick", "slow") == 1.5
    assert rates.ratio("quick", "absent") is None
    assert rates.best(("slow", "quick", "absent")) == "quick"
    assert rates.best(("absent",)) is None


def test_every_turn_begins_with_another_variant_and_runs_all():
    assert [order(turn, 3) for turn in range(4)] == [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 1, 2]]


def test_variants_take_turns():
    ran = []

    def running(name):
        return Variant(name, lambda poses: ran.append(name) or sums(poses))

    measured([running("a"), running("b")], candidates_about(np.zeros(4), [1], 1.0, 64), TURNS)
    blocks = [name for name, before in zip(ran, [None, *ran], strict=False) if name != before]
    # one to warm up, then a turn that begins with a, one with b, one with a
    assert blocks == ["a", "b", "a", "b", "a", "b"]


def test_no_candidate_comes_twice_within_a_turn_and_turns_differ():
    seen, turns = [], []
    poses = candidates_about(np.zeros(5), [2, 3], 0.1, 64)

    def spied(turn):
        turns.append(turn)
        seen.append([])
        return poses(turn)

    def energies(batch):
        seen[-1].extend(map(tuple, batch))
        return sums(batch)

    measured([Variant("spied", energies)], spied, TURNS)
    assert turns == [0, 1, 2, 3]
    for drawn in seen[1:]:
        assert len(set(drawn)) == len(drawn) > 0
    assert not set(seen[1]) & set(seen[2])
    assert all(pose[0] == pose[1] == pose[4] == 0 for pose in seen[1])


def test_a_rate_is_candidates_per_second_of_sleep():
    def sleepy(poses):
        time.sleep(0.001 * len(poses))
        return sums(poses)

    rates = measured([Variant("sleepy", sleepy)], candidates_about(np.zeros(4), [0], 1, 64), TURNS)
    # sleeping takes longer than asked, the more so on a busy machine, never shorter
    assert 100 < rates.medians["sleepy"] <= 1000


def test_batches_grow_until_calls_are_long_enough():
    def slow(poses):
        time.sleep(0.03)
        return sums(poses)

    variants = [Variant("slow", slow), Variant("quick", sums)]
    rates = measured(variants, candidates_about(np.zeros(4), [0], 1.0, 64), TURNS)
    assert rates.batches == (1, 8)


def test_what_is_converted_and_readied_is_not_timed():
    def slow(poses):
        time.sleep(0.05)
        return poses

    variant = Variant("converted", sums, slow, lambda: time.sleep(0.05))
    rates = measured([variant], candidates_about(np.zeros(4), [0], 1.0, 64), TURNS)
    assert rates.medians["converted"] > 64 / 0.05


def test_differences_from_the_first_variant_are_told():
    other = lambda poses: sums(poses) + 3  # noqa: E731
    variants = [Variant("a", sums), Variant("b", other), Variant("c", other, comparable=False)]
    rates = measured(variants, candidates_about(np.zeros(4), [0], 1.0, 64), TURNS)
    assert rates.differences == (0, 3, None)


@pytest.mark.parametrize("dofs", [[0], range(6)])
def test_candidates_are_the_same_for_the_same_turn(dofs):
    both = [candidates_about(np.zeros(6), dofs, 0.1, 16)(3) for _ in range(2)]
    assert np.array_equal(*both)


def test_groups_take_turns_together_and_are_compared_each_with_its_own_first():
    ran = []

    def running(name, group, more):
        def energies(poses):
            ran.append(name)
            return sums(poses) + more

        return Variant(name, energies, group=group)

    variants = [running("a", "x", 0), running("b", "x", 2), running("a", "y", 50)]
    variants.append(Variant("b", lambda poses: sums(poses) + 57, group="y"))
    rates = measured(variants, candidates_about(np.zeros(4), [1], 1.0, 64), TURNS)
    one, other = rates.of("x"), rates.of("y")
    assert one.names == other.names == ("a", "b")
    assert one.differences == (0, 2) and other.differences == (0, 7)
    np.testing.assert_array_equal(np.hstack([one.per_turn, other.per_turn]), rates.per_turn)
