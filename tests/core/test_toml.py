"""Files that are no TOML, told in our own words."""

import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.toml import MOST_BYTES, read_toml


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"a = ", "is not valid TOML"),
        (b"a = 1\na = 2", "is not valid TOML"),
        ("a = 'ö'".encode("latin-1"), "is not UTF-8 text; save it as UTF-8"),
        ("a = 'ö'".encode("utf-16"), "is not UTF-8 text"),
        (b"a = " + b"9" * 5000, "more digits"),
        (b"a = 0x" + b"f" * 5000, "more digits"),
        (b"a." * 6000 + b"b = 1", "line of more than 10,000 letters"),
        (b"a = " + b"[" * 4000 + b"]" * 4000, "brackets in brackets"),
        (b"#" * (MOST_BYTES + 1), "is larger than 1 MB; check the path"),
    ],
)
def test_what_is_no_toml_is_a_fault_of_the_file(tmp_path, content, told):
    path = tmp_path / "take.toml"
    path.write_bytes(content)
    with pytest.raises(MocapError, match=told) as caught:
        read_toml(path)
    assert caught.value.file == path


def test_a_folder_and_nothing_at_all_are_no_toml(tmp_path):
    with pytest.raises(MocapError, match="is a folder; name"):
        read_toml(tmp_path)
    with pytest.raises(MocapError, match="no such file"):
        read_toml(tmp_path / "none.toml")


def test_a_byte_order_mark_is_passed_over(tmp_path):
    (tmp_path / "take.toml").write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert read_toml(tmp_path / "take.toml") == {"a": 1}
