from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.export_request import ExportRequest


@pytest.fixture
def request_of_walk():
    body = template("performer")
    motion = SimpleNamespace(dof_names=body.dofs.names)
    return ExportRequest(body, motion, (), "walk", ("fbx",), Path("out"))


def test_files_are_named_after_the_take(request_of_walk):
    assert request_of_walk.path("fbx") == Path("out/walk.fbx")


def test_an_unknown_format_is_refused_with_those_there_are(request_of_walk):
    with pytest.raises(MocapError, match="cannot export 'dae'; choose among blend, fbx, bvh, trc"):
        replace(request_of_walk, formats=("fbx", "dae"))


def test_a_motion_of_another_body_is_refused(request_of_walk):
    with pytest.raises(ValueError, match="DOFs of the body"):
        replace(request_of_walk, body=template("sixteen_segment"))
