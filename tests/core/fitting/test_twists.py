import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import joint_transforms
from silhouette_mocap.core.fitting.twists import Twists
from synthetic import small_body

BODIES = ("performer", "sixteen_segment")


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("spread", [0.0, 1e-6, 1e-3, 0.5, 2.0])
def test_twists_are_the_difference_quotients_of_the_transforms(name, spread):
    body, rng = small_body(name), np.random.default_rng(3)
    pose = rng.normal(0, spread, len(body.dofs))
    transforms, twists = Twists(body).at(pose)
    np.testing.assert_allclose(transforms, joint_transforms(body, pose[None])[0], atol=1e-12)
    fixed = rng.normal(0, 1, (len(body.joint_names), 3))

    def placed(transforms):
        return (transforms[..., :3] @ fixed[..., None])[..., 0] + transforms[..., 3]

    at, step = placed(transforms), 1e-6
    for dof in range(len(pose)):
        ahead, behind = pose.copy(), pose.copy()
        ahead[dof] += step
        behind[dof] -= step
        one, other = joint_transforms(body, np.stack([ahead, behind]))
        moved = twists[:, dof, :3] + np.cross(twists[:, dof, 3:], at)
        np.testing.assert_allclose(moved, (placed(one) - placed(other)) / (2 * step), atol=1e-8)


def test_a_pose_of_another_body_is_refused():
    with pytest.raises(ValueError, match="pose of shape"):
        Twists(small_body("performer")).at(np.zeros(35))
