import numpy as np
import pytest

from app.pictures import (
    FLOOR_DB,
    STEP_DB,
    ColourName,
    colour_index,
    colour_table,
    encoded_levels,
    translucent_picture,
)
from core.frame import Frame
from core.geometry.projection import Projection


def frame_of(amplitude: np.ndarray) -> Frame:
    return Frame(
        amplitude=amplitude,
        projection=Projection(matrix=[[1, 0, 0, 0], [0, 1, 0, 0]]),
        time_s=0.0,
        sensor="radar",
        line_of_sight=[1, 0, 0],
    )


def test_encoded_levels_give_the_decibels_back() -> None:
    amplitude = np.array([[1.0, 0.5], [1e-3, 0.0]])
    encoded = encoded_levels(frame_of(amplitude))
    assert encoded.dtype == np.dtype("<u2")
    level_db = FLOOR_DB + encoded * STEP_DB
    np.testing.assert_allclose(level_db, [[0, -6.0206], [-60, -100]], atol=STEP_DB)


@pytest.mark.parametrize(
    ("name", "darkest", "lightest"),
    [("magma", 2, 240), ("viridis", 25, 215), ("cividis", 35, 220), ("grey", 1, 254)],
)
def test_colours_grow_lighter_all_the_way(
    name: ColourName, darkest: float, lightest: float
) -> None:
    table = colour_table(name).astype(float)
    assert table.shape == (256, 3)
    luminance = table @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(luminance) > -0.5)
    assert luminance[0] < darkest
    assert luminance[-1] > lightest


def test_colour_index_spans_the_floor_to_the_peak() -> None:
    level_db = np.array([-90.0, -40.0, -20.0, 0.0])
    np.testing.assert_array_equal(colour_index(level_db, -40.0), [0, 0, 128, 255])


def test_dark_parts_of_a_picture_in_space_are_clear() -> None:
    picture = translucent_picture(np.array([[-40.0, -36.0, -20.0, 0.0]]), -40.0)
    np.testing.assert_array_equal(picture[0, :, 3], [0, 0, 255, 255])
