import pytest
from silhouette_mocap.core.body.templates import TEMPLATES, template


@pytest.fixture(scope="session")
def bodies():
    return {name: template(name) for name in TEMPLATES}


@pytest.fixture(params=sorted(TEMPLATES))
def body(request, bodies):
    return bodies[request.param]


@pytest.fixture
def performer_body(bodies):
    return bodies["performer"]
