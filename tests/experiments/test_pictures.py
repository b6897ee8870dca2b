from pathlib import Path

import cv2
import pytest

from core.experiments.pictures import Picture, write_pictures


def _line() -> Picture:
    return Picture(
        name="line",
        caption="A line.",
        draw=lambda canvas: canvas.subplots().plot([0, 1], [0, 1]) and None,
        size_in=(4.0, 3.0),
    )


def test_pictures_are_written_dark_and_at_their_size(tmp_path: Path) -> None:
    (path,) = write_pictures([_line()], tmp_path / "made")
    image = cv2.imread(str(path))
    assert image.shape[:2] == (360, 480)
    assert image[0, 0].mean() < 40


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(ValueError, match="could not be made"):
        write_pictures([_line()], tmp_path / "file" / "sub")
