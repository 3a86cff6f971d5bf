import numpy as np
import pytest
from silhouette_mocap.core.bench.hulls import HullEvaluator
from silhouette_mocap.core.energy.weight_maps import xor_weight_maps
from silhouette_mocap.core.fitting.part_search import part_windows
from silhouette_mocap.core.rendering.native import NativeEvaluator
from synthetic import dof_values, filmed, small_body, small_studio


@pytest.mark.parametrize("part", [None, "left_arm"])
def test_hulls_count_what_the_kernel_counts_up_to_their_bulges(part):
    body, cameras = small_body("sixteen_segment"), small_studio(3)
    truth = dof_values(body, left_shoulder_abduction=0.4, right_hip_flexion=0.6)
    maps = xor_weight_maps(filmed(body, cameras, truth))
    chosen = next((p for p in body.parts if p.name == part), None)
    sums, native = [], NativeEvaluator(body, cameras)
    for evaluator in (native, HullEvaluator(body, cameras, 0)):
        weights, segments = evaluator.prepared(maps), None
        if chosen is not None:
            windows = part_windows(native, body.rest_pose, chosen, 128)
            segments = chosen.segments
            weights = evaluator.masked(weights, body.rest_pose, segments, windows)
        sums.append(evaluator.energies(weights, np.stack([body.rest_pose, truth]), segments))
    # hulls fill what is concave, and reach half a px further along their edges: at this size
    # a third of the area of what is drawn
    drawn = native.silhouettes(body.rest_pose, segments)
    bulges = 0.4 * sum(map(np.count_nonzero, drawn))
    assert np.abs(sums[0] - sums[1]).sum(axis=1).max() < bulges
    assert sums[1].sum(axis=1)[1] < sums[1].sum(axis=1)[0]
