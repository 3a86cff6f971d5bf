"""An evaluator that fails at any moment, and one that goes on."""

import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.rendering.fallback import Failures, FallbackEvaluator
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

CALLS = 8


class Failing(ReferenceEvaluator):
    """Works for some calls."""

    left = 0

    def _count(self):
        if not Failing.left:
            raise MocapError("no memory", "buy some")
        Failing.left -= 1


def counted(name):
    def call(self, *arguments):
        self._count()
        return getattr(ReferenceEvaluator, name)(self, *arguments)

    return call


for method in ("prepared", "masked", "energies", "outline", "bounds", "transforms"):
    setattr(Failing, method, counted(method))


def results(evaluator, maps, poses):
    """Everything that a fit asks for, in eight calls."""
    weights = evaluator.prepared(maps)
    energies = evaluator.energies(weights, poses)
    once = evaluator.masked(weights, poses[0], [1, 2])
    windows = np.tile([2, 2, 40, 30], (len(evaluator.cameras), 1))
    twice = evaluator.masked(once, poses[1], [2], windows)
    found = [energies, evaluator.energies(twice, poses, [2]), once.constants, twice.constants]
    found += [evaluator.bounds(poses, [0, 1]), *evaluator.silhouettes(poses[0])]
    found += [np.round(evaluator.transforms(poses), 9)]
    # either has an order of its own
    found += [np.sort(np.round(o.px, 6), axis=0) for o in evaluator.outline(poses[0])]
    return found


@pytest.mark.parametrize("calls", range(CALLS + 1))
def test_whenever_it_fails_the_other_goes_on_and_one_line_says_so(scenes, calls):
    rng = np.random.default_rng(3)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = tuple(scenes.camera_at(1.5, 40, size, rng) for size in [(64, 48), (50, 33)])
    maps, poses = scenes.maps_for(cameras, 300, rng), rng.normal(0, 0.3, (3, len(body.dofs)))
    told = []
    failures = Failures(told.append)

    def second():
        return NativeEvaluator(body, cameras)

    Failing.left = calls
    pair = [FallbackEvaluator(Failing(body, cameras), second, failures) for _ in range(2)]
    wanted = results(second(), maps, poses)
    for evaluator in pair:
        for found, expected in zip(results(evaluator, maps, poses), wanted, strict=True):
            np.testing.assert_array_equal(found, expected)
    assert [fault.problem for fault in told] == ["no memory"] and failures.any
    assert Failing.left == 0
