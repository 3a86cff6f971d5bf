"""A rig as the performer's body, read by whoever knows Blender."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dog import dog
from silhouette_mocap.core.body.kinematics import rest_height
from silhouette_mocap.core.body.rig_file import RigFile
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.results.writing import check_spared
from silhouette_mocap.core.take import read_take
from silhouette_mocap.core.take.performer import performer_body, pose_request
from silhouette_mocap.core.take.take import Performer

RIG = RigFile(Path("/sets/dog.blend"), "Dog")


def a_dogs(take_path):
    return replace(read_take(take_path), performer=Performer(RIG, None))


def test_a_rig_is_read_by_the_reader_and_without_blender_told():
    asked = []
    body = performer_body(Performer(RIG, None), lambda file: asked.append(file) or dog())
    assert body is dog() and asked == [RIG]
    with pytest.raises(MocapError, match=r"dog\.blend: can be read only with Blender; pip install"):
        performer_body(Performer(RIG, None))


def test_a_fit_asks_the_reader_for_the_rig(small_take, tmp_path):
    take, asked = a_dogs(small_take), []

    def read(file):
        asked.append(file)
        raise MocapError("enough")

    rig = tmp_path / "dog.blend"
    rig.write_bytes(b"a dog")
    take = replace(take, performer=Performer(RigFile(rig, "Dog"), None))
    with pytest.raises(MocapError, match="enough"):
        fit(take, FitRequest(tmp_path / "out", read_rig=read), Silence())
    assert asked == [RigFile(rig, "Dog")]


def test_a_rig_keeps_its_size_and_its_shape_unless_a_height_is_given(small_take):
    take = a_dogs(small_take)
    giant = scaled(dog(), 9.0)
    wanted = pose_request(take, giant)
    assert wanted.height_m == rest_height(giant) and not wanted.own_shape
    assert pose_request(replace(take, performer=Performer(RIG, 0.7)), giant).height_m == 0.7


def test_the_rest_pose_is_the_first_pose_of_what_is_no_person():
    assert np.array_equal(pose_of_kind(dog(), "rest"), dog().rest_pose)
    with pytest.raises(MocapError, match='kind "A" is a person\'s, and dog is none; use "rest"'):
        pose_of_kind(dog(), "A")


def test_a_result_does_not_replace_the_rig(small_take, tmp_path):
    take = read_take(small_take)
    own = replace(take, performer=Performer(RigFile(tmp_path / f"{take.name}.blend", "Rig"), None))
    with pytest.raises(MocapError, match="is the rig that the take names, and its export would"):
        check_spared(own, tmp_path)
    check_spared(own, tmp_path / "elsewhere")
