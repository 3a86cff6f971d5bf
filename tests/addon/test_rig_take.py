"""From a user's rig and silhouettes of it to keys on its own bones, through the command."""

import bpy
import numpy as np
import pytest
import rig_takes
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig_file import read_rig_file
from bl_ext.user_default.silhouette_mocap.addon.export import export_take
from bl_ext.user_default.silhouette_mocap.core.body.body import POINT_NAMES
from bl_ext.user_default.silhouette_mocap.core.body.file import read_body
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import joint_positions, rest_height
from bl_ext.user_default.silhouette_mocap.core.body.scaling import scaled
from bl_ext.user_default.silhouette_mocap.core.cli import main
from bl_ext.user_default.silhouette_mocap.core.motion.motion import read_motion

MOST_MM = 15.0


def fitted(folder, name, made, told="", size=""):
    """The result's folder, the body, and how far bones are off in mm, (T, J - 1)."""
    body, poses = made
    cameras = rig_takes.studio((160, 120), 140.0)  # 29 mm per px
    take = rig_takes.write_take(folder, name, made, cameras, told)
    text = take.read_text("utf-8")
    take.write_text(text.replace("[performer]", f"[performer]\n{size}"), "utf-8")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    out = folder / "out"
    words = ["fit", str(take), "--out", str(out), "--progress", "none"]
    assert main(words, export_take, read_rig_file) == 0
    heads = rig_takes.bone_heads(out / f"{name}.blend", body, len(poses))
    return out, body, 1000 * np.linalg.norm(heads - joint_positions(body, poses)[:, 1:], axis=2)


@pytest.fixture
def take_folder(tmp_path):
    folder = tmp_path / "take"
    folder.mkdir()
    return folder


def test_a_dog_that_trots_is_tracked_and_its_own_bones_are_keyed(take_folder):
    out, body, off = fitted(take_folder, "trot", rig_takes.dog(5))
    assert off.mean() < MOST_MM
    motion = read_motion(out / "motion.npz")
    assert motion.point_names == body.point_names != POINT_NAMES
    assert motion.limb_residual.shape == (5, 7) and "tail" in motion.limb_names
    assert not motion.lost.any()
    assert {path.name for path in out.iterdir()} >= {
        "trot.blend", "trot.fbx", "trot.bvh", "report.html", "overlay.mp4"
    }  # fmt: skip
    assert "tail" in (out / "report.html").read_text("utf-8")


def test_a_person_with_rigifys_bones_is_tracked_and_its_own_bones_are_keyed(take_folder):
    told = "initial_pose = { frames = [0, 0] }"
    out, _, off = fitted(take_folder, "walk", rig_takes.person(8), told)
    assert off.mean() < MOST_MM
    assert read_motion(out / "motion.npz").point_names == POINT_NAMES


def test_a_rig_of_another_size_is_scaled_to_the_performer_on_request(take_folder):
    body, poses = rig_takes.person(4)
    made = scaled(body, 1.2), poses
    told = "initial_pose = { frames = [0, 0] }"
    size = 'height_m = "measured"'
    out, _, off = fitted(take_folder, "giant", made, told, size)
    # a body that is a fifth too small would be off by hundreds
    assert off.mean() < 2 * MOST_MM
    ratio = rest_height(read_body(out / "body.npz")) / rest_height(body)
    # one px of 29 mm at each end
    assert ratio == pytest.approx(1.2, abs=0.03)


def test_info_knows_a_take_with_a_rig_and_names_the_armatures_where_one_is_missing(
    take_folder, capsys
):
    cameras = rig_takes.studio((160, 120), 140.0)
    take = rig_takes.write_take(take_folder, "trot", rig_takes.dog(2), cameras)
    words = ["info", str(take), "--progress", "none"]
    assert main(words, export_take, read_rig_file) == 0
    assert "actor.blend#Actor" in capsys.readouterr().out
    take.write_text(take.read_text("utf-8").replace("#Actor", "#Cat"), "utf-8")
    assert main(words, export_take, read_rig_file) == 2
    assert "holds no armature 'Cat'; it has: Actor" in capsys.readouterr().err
