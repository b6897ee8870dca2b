import numpy as np
import pytest

from core.frame import Frame
from core.geometry.projection import range_doppler_projection
from core.radar.window import HAMMING, taylor
from core.silhouettes.edge import edge_spread
from core.silhouettes.extraction import ExtractionSettings, extract_silhouette

PIXEL_M, CELL_M = 0.06, 0.15


def speckled_square(noise_db, seed, side_m=9.0, window=HAMMING):
    """A square of independent diffuse scatterers through the imaging window, in receiver noise."""
    random = np.random.default_rng(seed)
    size = 512
    scene = np.zeros((size, size), complex)
    half = round(side_m / PIXEL_M / 2)
    inside = slice(size // 2 - half, size // 2 + half)
    shape = (2 * half, 2 * half)
    scene[inside, inside] = random.normal(size=shape) + 1j * random.normal(size=shape)
    place = (np.arange(size) - size // 2) * PIXEL_M / CELL_M
    response = np.fft.fft(np.fft.ifftshift(window.point_response(place)))
    image = np.fft.ifft2(np.fft.fft2(scene) * np.outer(response, response))
    level = np.sqrt(np.mean(np.abs(image[inside, inside]) ** 2))
    # The noise passes the same window as the echoes.
    noise = random.normal(size=image.shape) + 1j * random.normal(size=image.shape)
    noise = np.fft.ifft2(np.fft.fft2(noise) * np.outer(response, response))
    noise /= np.sqrt(np.mean(np.abs(noise) ** 2))
    return Frame(
        amplitude=np.abs(image + noise * level * 10 ** (noise_db / 20)),
        projection=range_doppler_projection(
            line_of_sight=np.array([1.0, 0, 0]),
            line_of_sight_rate_per_s=np.array([0, 0.01, 0]),
            row_spacing_m=PIXEL_M,
            column_spacing_m=PIXEL_M,
            shape=image.shape,
        ),
        time_s=0.0,
        sensor="radar",
        line_of_sight=[1.0, 0, 0],
        row_spacing_m=PIXEL_M,
        column_spacing_m=PIXEL_M,
        row_resolution_m=window.half_power_width_cells * CELL_M,
        column_resolution_m=window.half_power_width_cells * CELL_M,
        window=window.name,
    )


def mean_side_m(frame, *, corrects_edge):
    silhouette = extract_silhouette(frame, ExtractionSettings(corrects_edge=corrects_edge))
    return np.sqrt(silhouette.area_px()) * PIXEL_M


@pytest.mark.parametrize("window", [HAMMING, taylor(sidelobe_db=-38.0, nbar=6)])
@pytest.mark.parametrize("noise_db", [-20.0, -25.0, -30.0, -35.0])
def test_the_corrected_edge_is_the_true_one_whatever_the_noise_and_window(noise_db, window):
    frame = speckled_square(noise_db, seed=5, window=window)
    raw, corrected = (mean_side_m(frame, corrects_edge=choice) for choice in (False, True))
    assert raw > 9.15
    assert corrected == pytest.approx(9.0, abs=0.1)


@pytest.mark.parametrize("window", [HAMMING, taylor()])
def test_half_the_power_is_left_at_a_straight_edge(window):
    distance, spread = edge_spread(window)
    assert distance[-1] == pytest.approx(window.first_null_cells, abs=1e-3)
    assert distance[0] == pytest.approx(0, abs=1e-3)
    assert spread[0] == pytest.approx(0.5, abs=1e-3)
    assert np.all(np.diff(spread) <= 0)
