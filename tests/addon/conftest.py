"""Runs the addon as Blender does: as an extension, in user resources of its own.

The checkout is linked into the extensions of a temporary user and enabled, so the package is
``bl_ext.user_default.silhouette_mocap``. Tests here import addon *and core* by that name only: by
another name every class would exist twice.
"""

import os
import sys
import tempfile
from pathlib import Path

if "bpy" not in sys.modules:
    _resources = tempfile.TemporaryDirectory(prefix="silhouette_mocap_")
    os.environ["BLENDER_USER_RESOURCES"] = _resources.name  # read when bpy is first imported

import bpy
import numpy as np
import pytest

# isort: split
import addon_utils

EXTENSION = "bl_ext.user_default.silhouette_mocap"
_CHECKOUT = Path(__file__).resolve().parents[2]


def _link_checkout():
    repository = Path(bpy.utils.user_resource("EXTENSIONS", path="user_default", create=True))
    link = repository / "silhouette_mocap"
    if not link.exists():
        link.symlink_to(_CHECKOUT, target_is_directory=True)
    addon_utils.extensions_refresh(ensure_wheels=True)


_link_checkout()
if addon_utils.enable(EXTENSION, default_set=True) is None:
    raise RuntimeError(f"{EXTENSION} cannot be enabled")


@pytest.fixture(autouse=True)
def _empty_file():
    """Every test begins with an empty file; the extension stays enabled."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def small_body():
    """Eight joints that resemble no template: every DOF kind, bones in all directions."""
    from bl_ext.user_default.silhouette_mocap.core.body.body import Body, DofKind, Dofs

    joints = ("root", "chest", "left_shoulder", "left_elbow", "right_shoulder", "head")
    joints += ("right_knee", "right_ankle")
    translation, hinge, swing = DofKind.TRANSLATION, DofKind.HINGE, DofKind.SWING
    x, y, z = np.eye(3)
    out = np.array([1.0, 0.0, -1.0]) / np.sqrt(2)
    rows = [(0, translation, axis) for axis in (x, y, z)]
    rows += [(0, hinge, z), (0, hinge, x), (0, hinge, y)]
    rows += [(1, swing, x), (1, swing, y), (1, hinge, z)]
    rows += [(2, swing, y), (2, swing, np.cross(out, y)), (2, hinge, out), (3, hinge, x)]
    rows += [(4, swing, y), (4, swing, z), (5, hinge, x), (6, hinge, x), (7, hinge, x)]
    count = len(rows)
    dofs = Dofs(
        names=tuple(f"dof{row}" for row in range(count)),
        joints=[row[0] for row in rows],
        kinds=[row[1] for row in rows],
        axes=[row[2] for row in rows],
        limits=np.tile([-np.inf, np.inf], (count, 1)),
        rest_spread=np.full(count, np.inf),
        directions=("turns",) * count,
    )
    offsets = [[0.1, 0.2, 0.95], [0, 0, 0.2], [0.2, 0, 0.25], [0.2, 0, -0.2], [-0.2, 0, 0.25]]
    offsets += [[0, 0.02, 0.3], [-0.1, 0, -0.45], [0, 0, -0.4]]
    tails = [[0, 0, 0.2], [0, 0.02, 0.3], [0.2, 0, -0.2], [0.18, 0, -0.18], [-0.2, 0, -0.2]]
    tails += [[0, 0, 0.2], [0, 0, -0.4], [0, -0.15, -0.03]]
    return Body(
        name="small",
        joint_names=joints,
        parents=[-1, 0, 1, 2, 1, 1, 0, 6],
        offsets=offsets,
        tails=tails,
        dofs=dofs,
        cones={},
        segment_names=joints,
        segment_joints=range(len(joints)),
        surfaces=(_tetrahedra(np.array(tails, float)),),
        point_joints=[5, 1, 2, 4, 3, 4, 3, 4, 0, 0, 0, 6, 0, 7],
        point_offsets=np.zeros((14, 3)),
        parts=(),
    )


def _tetrahedra(tails):
    """A slender tetrahedron along every bone."""
    from bl_ext.user_default.silhouette_mocap.core.body.body import Surface

    corners = 0.04 * np.array([[1, 0, 0], [-1, 0.5, 0], [0, -1, 0.5]])
    faces = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
    bones = len(tails)
    return Surface(
        vertices=np.concatenate([np.vstack([corners, tail]) for tail in tails]),
        triangles=np.concatenate([faces + 4 * bone for bone in range(bones)]),
        vertex_starts=4 * np.arange(bones + 1),
        triangle_starts=4 * np.arange(bones + 1),
    )


def _turn(axis, angle):
    """(3, 3) rotation by Rodrigues' formula."""
    k = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def _joints_in(body, pose):
    """(J, 3) joints in world metres, straight from the convention in the head of body.py."""
    from bl_ext.user_default.silhouette_mocap.core.body.body import DofKind

    placed = []
    for joint, parent in enumerate(body.parents):
        motion = np.eye(4)
        halves = []
        for row in np.flatnonzero(body.dofs.joints == joint):
            kind, vector = body.dofs.kinds[row], pose[row] * body.dofs.axes[row]
            elementary = np.eye(4)
            if kind == DofKind.TRANSLATION:
                elementary[:3, 3] = vector
            elif kind == DofKind.HINGE:
                elementary[:3, :3] = _turn(body.dofs.axes[row], pose[row])
            elif not halves:
                halves.append(vector)
                continue
            else:
                swing = halves.pop() + vector
                angle = np.linalg.norm(swing)
                elementary[:3, :3] = _turn(swing / max(angle, 1e-12), angle)
            motion = motion @ elementary
        offset = np.eye(4)
        offset[:3, 3] = body.offsets[joint]
        world = offset @ motion
        placed.append(placed[parent] @ world if parent >= 0 else world)
    return np.array(placed)[:, :3, 3]


@pytest.fixture
def make_take(tmp_path):
    """A function (body, frames=…, fps=…, …) -> a take of a body that turns, travels and bends."""
    from bl_ext.user_default.silhouette_mocap.core.body.body import POINT_NAMES
    from bl_ext.user_default.silhouette_mocap.core.motion.export_request import ExportRequest
    from bl_ext.user_default.silhouette_mocap.core.motion.motion import Motion

    def make(body, frames=range(3, 23), fps=(15, 1), formats=(), cameras=(), footage=None):
        count, dofs = len(frames), len(body.dofs)
        waves = np.random.default_rng(7).uniform(0.3, 0.9, (3, dofs))
        time = np.arange(count)[:, None] / 5
        poses = waves[0] * np.sin(waves[1] * time * 4 + 7 * waves[2])
        heading = np.flatnonzero((body.dofs.joints == 0) & (body.dofs.kinds != 0))[0]
        poses[:, heading] = 2.5 * time[:, 0]  # more than a whole turn
        motion = Motion(
            fps=fps,
            frames=np.array(frames),
            pose=poses,
            pose_raw=poses,
            dof_names=body.dofs.names,
            joints=np.array([_joints_in(body, pose) for pose in poses]),
            joint_names=body.joint_names,
            points=np.zeros((count, 14, 3)),
            point_names=POINT_NAMES,
            xor_px=np.zeros((count, 0)),
            iou=np.zeros((count, 0)),
            view_weights=np.zeros((count, 0)),
            limb_residual=np.zeros((count, 5)),
            camera_names=(),
            confidence=np.ones((count, 14)),
            lost=np.zeros(count, bool),
            locked=np.arange(count) == 2,
            confidence_raw=np.ones((count, 14)),
            keyed=np.ones((count, len(body.joint_names)), bool),
        )
        return ExportRequest(body, motion, tuple(cameras), "walk", formats, tmp_path, footage or {})

    return make
