from pathlib import Path

import pytest
import silhouette_mocap.core.body.templates as templates
from silhouette_mocap.core.body.bones import bone_names, point_table
from silhouette_mocap.core.body.table import dof_table
from silhouette_mocap.core.body.templates.nine_joint import measures

DOCUMENTED = (Path(templates.__file__).parent / "DOFS.md").read_text("utf-8")


@pytest.mark.parametrize("name", sorted(templates.TEMPLATES))
def test_the_documented_table_is_that_of_the_template(name):
    assert f"## {name}\n\n{dof_table(templates.template(name)).strip()}\n" in DOCUMENTED


def test_the_documented_points_and_measures_are_those_of_the_templates():
    assert point_table([templates.template(name) for name in templates.TEMPLATES]) in DOCUMENTED
    for name, length in measures(templates.template("nine_joint")).items():
        assert f"{name} {100 * length:.1f} cm" in DOCUMENTED


def test_the_table_of_points_tells_bones_by_their_names_in_blender():
    bodies = [templates.template(name) for name in ("performer", "eleven_segment", "nine_joint")]
    lines = point_table(bodies).splitlines()
    assert lines[0] == "| point | performer | eleven_segment | nine_joint |"
    assert "| left_wrist | wrist.L, head | elbow.L, tail | wrist.L, head |" in lines
    assert lines[13].endswith(
        "| knee.R, head | knee.R, head | virtual_foot, head + (-12.0, 0.0, 50.7) cm |"
    )
    assert {name for body in bodies for name in bone_names(body)} >= {"toes.R", "virtual_foot"}
