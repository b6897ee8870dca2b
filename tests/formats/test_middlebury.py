import cv2
import numpy as np
import pytest

from core.formats.middlebury import read_photographs
from core.optical.camera import camera_projection

INTRINSICS = np.array([[1500.0, 0, 30], [0, 1400, 20], [0, 0, 1]])
LOOKING_ALONG_Z = np.eye(3)


def _write(folder, *, count=2, names=("a.png", "b.png"), numbers=None, pictures=("a.png", "b.png")):
    if numbers is None:
        numbers = [*INTRINSICS.ravel(), *LOOKING_ALONG_Z.ravel(), 0, 0, 0.6]
    words = " ".join(map(str, numbers))
    text = "\n".join([str(count), *(f"{name} {words}" for name in names), ""])
    (folder / "trial_par.txt").write_text(text)
    picture = np.zeros((40, 60, 3), dtype=np.uint8)
    picture[10, 20] = 0, 51, 102  # OpenCV writes blue, green, red
    for name in pictures:
        cv2.imwrite(str(folder / name), picture)
    return folder


def test_a_camera_that_gives_x_and_y_becomes_row_and_column():
    projection = camera_projection(INTRINSICS, LOOKING_ALONG_Z, np.array([0, 0, 0.6]))
    row, column = projection.image_points(np.array([0.006, -0.012, 0.0]))
    assert column == pytest.approx(30 + 1500 * 0.006 / 0.6)
    assert row == pytest.approx(20 - 1400 * 0.012 / 0.6)
    assert projection.viewing_direction() == pytest.approx([0, 0, 1])


def test_photographs_come_in_listed_order(tmp_path):
    photographs = read_photographs(_write(tmp_path, names=("b.png", "a.png")))
    first, second = (photograph.frame for photograph in photographs)
    assert (first.label, second.label) == ("b", "a")
    assert first.shape == (40, 60)
    assert first.amplitude[10, 20] == pytest.approx(0.299 * 0.4 + 0.587 * 0.2)
    assert photographs[0].colours[10, 20].tolist() == [102, 51, 0]
    assert first.sensor == "optical"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"count": 3}, 'announces "3" pictures .* lists 2'),
        ({"names": ("a.png", "../b.png")}, "same folder"),
        ({"pictures": ("a.png",)}, "names b.png, which is not in"),
        ({"numbers": [1.0] * 20}, "wanted a picture's name and 21 finite numbers .* got 20"),
        ({"numbers": ["nan"] * 21}, "finite"),
        ({"numbers": ["K"] * 21}, "line 2: could not convert"),
        ({"numbers": [1.0] * 21}, "Camera of a.png: R must be a rotation"),
    ],
)
def test_a_broken_list_says_what_is_wrong(tmp_path, change, says):
    with pytest.raises(ValueError, match=says):
        read_photographs(_write(tmp_path, **change))


def test_a_folder_without_a_list_says_what_was_wanted(tmp_path):
    with pytest.raises(ValueError, match=r"Wanted one list of cameras \(\*_par.txt\).*found none"):
        read_photographs(tmp_path)
    with pytest.raises(ValueError, match="is no folder"):
        read_photographs(tmp_path / "absent")


def test_a_picture_cut_off_is_refused(tmp_path):
    _write(tmp_path)
    (tmp_path / "b.png").write_bytes((tmp_path / "b.png").read_bytes()[:20])
    with pytest.raises(ValueError, match=r"b\.png is no picture"):
        read_photographs(tmp_path)


def test_the_temple_stands_in_the_middle_of_its_photographs(shared_data):
    photographs = read_photographs(shared_data("temple"))
    assert len(photographs) == 16
    middle_m = np.array([-0.022, 0.102, 0.025])  # of the true bounding box
    for photograph in photographs:
        row, column = photograph.frame.projection.image_points(middle_m)
        assert 150 < row < 330
        assert 150 < column < 490
