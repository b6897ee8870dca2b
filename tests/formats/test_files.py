import errno

import h5py
import pytest

from core.formats.files import checked_output, written_aside


def test_an_output_is_checked_before_the_work(tmp_path):
    path = tmp_path / "hull.GLB"
    assert checked_output(path, (".glb",)) == path
    with pytest.raises(ValueError, match=r'must end in \.h5, \.hdf5; got "\.GLB"'):
        checked_output(path, (".h5", ".hdf5"))
    with pytest.raises(ValueError, match="is a folder"):
        checked_output(tmp_path)
    with pytest.raises(ValueError, match="there is no folder"):
        checked_output(tmp_path / "missing" / "hull.glb")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_without_write_permission_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("os.access", lambda *_: False)  # root may write anywhere
    with pytest.raises(ValueError, match="is read-only"):
        checked_output(tmp_path / "hull.glb")


def write_half(path):
    with written_aside(path) as aside:
        aside.write_text("half")
        raise OSError(errno.ENOSPC, "a library's own long text")


def test_an_old_file_stays_when_the_new_one_fails(tmp_path):
    path = tmp_path / "facts.json"
    path.write_text("old")
    with pytest.raises(ValueError, match="No space left on device"):
        write_half(path)
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


def test_the_reason_is_short(tmp_path):
    path = tmp_path / "missing" / "pass.h5"
    with pytest.raises(ValueError, match="written") as raised, written_aside(path) as aside:
        h5py.File(aside, "w")
    assert str(raised.value) == f"{path} could not be written: No such file or directory."
