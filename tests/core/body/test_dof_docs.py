from pathlib import Path

import pytest
import silhouette_mocap.core.body.templates as templates
from silhouette_mocap.core.body.table import dof_table


@pytest.mark.parametrize("name", sorted(templates.TEMPLATES))
def test_the_documented_table_is_that_of_the_template(name):
    documented = (Path(templates.__file__).parent / "DOFS.md").read_text("utf-8")
    assert f"## {name}\n\n{dof_table(templates.template(name)).strip()}\n" in documented
