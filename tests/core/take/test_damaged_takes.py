"""What damage to a take once led to."""

import shutil

import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.take.reading import read_take
from silhouette_mocap.core.take.views import open_views


@pytest.fixture
def damaged(small_take, tmp_path):
    """The take with a piece of its text replaced."""

    def of(old: str, new: str):
        folder = shutil.copytree(small_take.parent, tmp_path / "session" / "small")
        text = small_take.read_text("utf-8")
        assert old in text
        (folder / "take.toml").write_text(text.replace(old, new), "utf-8")
        return folder / "take.toml"

    return of


def test_long_values_are_shown_in_part(damaged):
    path = damaged("frames = [0, 3]", f"frames = [{'0, ' * 3000}1]")
    with pytest.raises(MocapError, match="expected a list of 2 whole numbers") as caught:
        read_take(path)
    assert len(str(caught.value)) < 600


def test_a_pattern_of_more_digits_than_a_name_can_have_is_no_pattern(damaged):
    take = read_take(damaged("{frame:06d}", "{frame:09999999999d}"))
    with pytest.raises(MocapError, match=r"only \{camera\} and \{frame\} are put in"):
        open_views(take)
