import pytest

from core.formats.element_sets import read_element_sets


def test_names_are_optional(tmp_path):
    path = tmp_path / "sets.tle"
    path.write_text("NAME\n1 a\n2 b\n\n1 c\n2 d\n")
    assert read_element_sets(path) == (("1 a", "2 b", "NAME"), ("1 c", "2 d", ""))


def test_a_text_without_sets_is_refused(tmp_path):
    path = tmp_path / "sets.tle"
    path.write_text("hello\n")
    with pytest.raises(ValueError, match="holds no two-line element set"):
        read_element_sets(path)
    with pytest.raises(ValueError, match="could not be read"):
        read_element_sets(tmp_path / "absent.tle")
