"""Takes of rigs made by code: a .blend, silhouettes of a known motion, a calibration."""

import bpy
import cv2
import numpy as np
import rigs
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig import read_rig
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import clamped
from bl_ext.user_default.silhouette_mocap.core.cameras.presets import Ring, ring
from bl_ext.user_default.silhouette_mocap.core.rendering.native import NativeEvaluator

_STEP = 12  # frames
_TAKE = """
version = 1
name = "{name}"
fps = 25.0
{pose}
[cameras]
calibration = "calibration.toml"
units = "m"
[footage]
silhouettes = "masks/{{camera}}/{{frame:06d}}.png"
[performer]
body = "actor.blend#Actor"
[export]
formats = ["blend", "fbx", "bvh"]
"""


def person(frames):
    """The body of Rigify's bones, and (T, D) poses of it: it walks, knees and elbows bend."""
    armature = rigs.make_rig(rigs.RIGIFY)
    for side in "LR":
        for name in ("shin", "forearm"):
            bone = armature.pose.bones[f"{name}.{side}"]
            bone.lock_ik_y = bone.lock_ik_z = bone.use_ik_limit_x = True
            bone.ik_min_x, bone.ik_max_x = -0.1, 2.6
    time, swing, ramp = _times(frames)
    moves = {"spine_y": -0.05 * time, "spine_yaw": 1.0 + 0.03 * time,
             "spine.002_swing_x": 0.1 * ramp, "spine.006_swing_x": swing(0.15)}  # fmt: skip
    for side, phase in (("L", 0), ("R", np.pi)):
        moves[f"thigh.{side}_swing_x"] = swing(0.5, phase)
        moves[f"shin.{side}_turn_x"] = 0.4 * ramp + swing(0.4, phase + 1.2)
        moves[f"upper_arm.{side}_swing_x"] = swing(0.6, phase + np.pi)
        moves[f"forearm.{side}_turn_x"] = 0.6 * ramp
    return _posed(armature, frames, moves)


def dog(frames):
    """The body of a dog, and (T, D) poses of it: it trots, nods and wags its tail."""
    armature = rigs.make_rig(rigs.DOG)
    time, swing, ramp = _times(frames)
    moves = {"hips_y": -0.04 * time, "hips_yaw": 0.8 + 0.02 * time, "tail_swing_z": swing(0.4),
             "neck_swing_x": swing(0.3), "head_swing_x": swing(0.2, 1)}  # fmt: skip
    legs = {"front_thigh.L": 0, "front_thigh.R": np.pi, "thigh.L": np.pi, "thigh.R": 0}
    for leg, phase in legs.items():
        moves[f"{leg}_swing_x"] = swing(0.45, phase)
        shin = leg.replace("thigh", "shin")
        moves[f"{shin}_swing_x"] = 0.2 * ramp + swing(0.2, phase + 1)
    return _posed(armature, frames, moves)


def _times(frames):
    """Frames since the first pose, a function for swings that set in slowly, and how slowly."""
    time = np.maximum(np.arange(frames) - 1, 0)
    ramp = np.clip(time / 4, 0, 1)

    def swing(most, phase=0.0):
        return most * ramp * np.sin(2 * np.pi * time / _STEP + phase)

    return time, swing, ramp


def _posed(armature, frames, moves):
    body = read_rig(armature, bpy.data.objects, 1.0).body
    poses = np.zeros((frames, len(body.dofs)))
    for name, values in moves.items():
        poses[:, body.dofs.names.index(name)] = values
    return body, clamped(body, poses)


def studio(size, focal_px):
    """Six cameras round the actor, 4 m away."""
    return ring(Ring(6, heights=(0.7, 1.9), size=size, focal_px=focal_px))


def write_take(folder, name, made, cameras, told=""):
    """Saves the open file as the actor's, and writes the rest of the take; returns take.toml.

    ``made`` are the body and its poses; ``told`` is what the take tells of the initial one.
    """
    body, poses = made
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "actor.blend"))
    evaluator = NativeEvaluator(body, cameras)
    for frame, pose in enumerate(poses):
        for camera, picture in zip(cameras, evaluator.silhouettes(pose), strict=True):
            path = folder / "masks" / camera.name / f"{frame:06d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), picture.astype(np.uint8) * 255)
    (folder / "calibration.toml").write_text("\n".join(map(_calibration, cameras)), "utf-8")
    (folder / "take.toml").write_text(_TAKE.format(name=name, pose=told), "utf-8")
    return folder / "take.toml"


def _calibration(camera):
    return f"""[{camera.name}]
name = "{camera.name}"
size = {list(camera.size)}
matrix = {camera.matrix.tolist()}
distortions = [0.0, 0.0, 0.0, 0.0]
rotation = {cv2.Rodrigues(camera.rotation)[0].ravel().tolist()}
translation = {camera.camera_from_world[:, 3].tolist()}
"""


def bone_heads(blend, body, frames):
    """(T, J - 1, 3) world heads of the actor's bones in an exported file, joint by joint.

    Without the first joint, which a body that is nobody's has in its middle.
    """
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    armature, heads = bpy.data.objects["Actor"], []
    for frame in range(frames):
        bpy.context.scene.frame_set(frame)
        bones = [armature.pose.bones[name] for name in body.joint_names[1:]]
        heads.append([armature.matrix_world @ bone.head for bone in bones])
    return np.array(heads)
