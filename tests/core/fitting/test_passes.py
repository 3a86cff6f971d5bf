from types import SimpleNamespace

import numpy as np
from silhouette_mocap.core.fitting.passes import Passes, directions_from
from silhouette_mocap.core.fitting.tracker import PoseFit, Tally
from synthetic import dof_values, evaluator, filmed, small_body, small_studio


def test_a_lock_where_the_passes_begin_shapes_both_directions():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    still = SimpleNamespace(
        evaluator=evaluator(body, cameras), fit=lambda _, past: PoseFit(past.predicted, 0, Tally())
    )
    lock, fits = dof_values(body, root_x=0.1), {}
    passes = Passes(still, body.rest_pose, directions_from(2, range(5)), fits, 15.0)
    seen = filmed(body, cameras, lock)
    for found in passes.first(lambda frames: ((frame, seen) for frame in frames), {2: lock}):
        fits |= {fit.frame: fit for fit in found}
    for frame in range(5):
        np.testing.assert_array_equal(fits[frame].pose, lock)
