import numpy as np
import pytest
from silhouette_mocap.core.initialisation.measures import lengths_of
from silhouette_mocap.core.initialisation.shape_fit import ShapeFit
from silhouette_mocap.core.initialisation.shape_model import ShapeModel
from synthetic import small_body


def test_lengths_are_told_beside_the_template_at_the_performers_height():
    body = small_body("performer")
    model = ShapeModel(body)
    logs = np.full(len(model), np.log(1.1))
    names = [factor.name for factor in model.factors]
    logs[names.index("forearm length")] += np.log(1.2)
    fit = ShapeFit(
        template=body,
        body=model.changed(body, logs),
        poses=body.rest_pose[None],
        model=model,
        logs=logs,
        deviations=np.full(len(model), 0.05),
    )
    found = {length.name: length for length in lengths_of(fit)}
    elbow = body.joint_names.index("left_elbow")
    forearm = 1.32 * np.linalg.norm(body.tails[elbow])
    assert found["forearm"].metres == pytest.approx(forearm)
    assert found["forearm"].deviation == pytest.approx(1.5 * 0.05 * forearm)
    # the forearm of an A-pose is no part of the height
    assert found["forearm"].against == pytest.approx(0.2, abs=1e-3)
    assert found["thigh"].against == pytest.approx(0.0, abs=1e-3)
    assert {"upper arm", "shank", "hand", "foot", "head"} <= set(found)
