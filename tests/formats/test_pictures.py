import cv2
import numpy as np
import pytest

from core.formats.pictures import write_picture
from core.frame import Frame
from core.geometry.projection import range_doppler_projection


def frame(amplitude):
    return Frame(
        amplitude=amplitude,
        projection=range_doppler_projection(
            line_of_sight=np.array([1.0, 0.0, 0.0]),
            line_of_sight_rate_per_s=np.array([0.0, 1.0, 0.0]),
            row_spacing_m=0.1,
            column_spacing_m=0.1,
            shape=amplitude.shape,
        ),
        time_s=0.0,
        sensor="radar",
        line_of_sight=np.array([1.0, 0.0, 0.0]),
    )


def test_the_peak_is_white_and_60_db_below_is_black(tmp_path):
    amplitude = np.full((16, 16), 1e-5, dtype=np.float32)
    amplitude[3, 4], amplitude[5, 6] = 1.0, 10 ** (-30 / 20)
    write_picture(tmp_path / "frame.png", frame(amplitude))
    grey = cv2.imread(str(tmp_path / "frame.png"), cv2.IMREAD_UNCHANGED)
    assert grey.shape == (16, 16)
    assert (grey[3, 4], grey[0, 0]) == (255, 0)
    assert grey[5, 6] == pytest.approx(127.5, abs=1)


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"must end in \.png"):
        write_picture(tmp_path / "frame.jpg", frame(np.ones((16, 16), dtype=np.float32)))
    assert list(tmp_path.iterdir()) == []
