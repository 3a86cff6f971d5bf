"""What the tests of several packages share."""

from pathlib import Path

import pytest
from small_take import known_start, write_small_take


@pytest.fixture(scope="session")
def small_take(tmp_path_factory) -> Path:
    """The take.toml; the folder is shared, so tests write elsewhere."""
    folder = tmp_path_factory.mktemp("session") / "small"
    folder.mkdir()
    return write_small_take(folder)


@pytest.fixture
def quick_start(monkeypatch):
    """Fits of the small take start at once."""
    monkeypatch.setattr("silhouette_mocap.core.beginning.initialised", known_start)
