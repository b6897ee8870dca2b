import numpy as np
import pytest
from scipy.special import j1

from core.optical.telescope import Detector, Telescope, blurred, exposed

TELESCOPE = Telescope(aperture_m=2.0, wavelength_m=1e-6)


def point_spread(telescope, sample_rad, size=257):
    point = np.zeros((size, size))
    point[size // 2, size // 2] = 1.0
    return blurred(point, telescope, sample_rad)


def width_rad(profile, sample_rad):
    """Return the full width at half maximum, between samples."""
    half = profile.max() / 2
    inside = np.flatnonzero(profile > half)
    a, b = inside[0], inside[-1]
    left = a - (profile[a] - half) / (profile[a] - profile[a - 1])
    right = b + (profile[b] - half) / (profile[b] - profile[b + 1])
    return (right - left) * sample_rad


def test_the_point_spread_is_airys():
    """Airy, 1835: (2 J₁(x) / x)² with x = π θ D / λ."""
    sample = 0.1 * TELESCOPE.diffraction_rad
    spread = point_spread(TELESCOPE, sample)
    offset = (np.arange(257) - 128) * 0.1 * np.pi
    x = np.where(offset == 0, 1e-9, offset)
    airy = (2 * j1(x) / x) ** 2
    profile = spread[128] / spread.max()
    assert np.abs(profile - airy)[90:167].max() < 2e-3
    assert width_rad(spread[128], sample) == pytest.approx(TELESCOPE.resolution_rad(), rel=0.01)
    assert width_rad(spread[:, 128], sample) == pytest.approx(TELESCOPE.resolution_rad(), rel=0.01)


@pytest.mark.parametrize("jitter", [1.0, 3.0])
def test_jitter_widens_the_point_spread(jitter):
    telescope = Telescope(
        aperture_m=2.0, wavelength_m=1e-6, jitter_rad=jitter * TELESCOPE.diffraction_rad
    )
    sample = 0.1 * TELESCOPE.diffraction_rad
    width = width_rad(point_spread(telescope, sample)[128], sample)
    assert width == pytest.approx(telescope.resolution_rad(), rel=0.06)


def test_light_is_neither_made_nor_moved():
    """But for the wings that leave the picture; an even field stays even far from its edge."""
    random = np.random.default_rng(1)
    image = np.zeros((200, 160))
    image[80:120, 60:100] = random.uniform(size=(40, 40))
    formed = blurred(image, TELESCOPE, 0.5 * TELESCOPE.diffraction_rad)
    assert formed.sum() == pytest.approx(image.sum(), rel=0.01)
    rows, columns = np.indices(image.shape)
    for index in (rows, columns):
        before, after = (np.sum(index * each) / each.sum() for each in (image, formed))
        assert after == pytest.approx(before, abs=0.2)


def test_photons_come_by_poissons_law_and_reading_adds_its_noise():
    detector = Detector(read_noise_electrons=8.0, background_electrons=50.0)
    for radiance in (0.0, 0.002, 0.5):
        electrons = (
            exposed(np.full((300, 300), radiance), detector, np.random.default_rng(2))
            * detector.full_well_electrons
        )
        mean = detector.white_electrons * radiance + 50
        assert electrons.mean() == pytest.approx(mean + detector.bias_electrons, rel=3e-3)
        assert electrons.var() == pytest.approx(mean + 8**2, rel=0.02)


def test_a_full_pixel_takes_no_more():
    frame = exposed(np.full((4, 4), 100.0), Detector(), np.random.default_rng(1))
    assert frame.dtype == np.float32
    assert np.all(frame == 1)


def test_impossible_instruments_are_refused():
    with pytest.raises(ValueError, match="positive aperture and wavelength"):
        Telescope(aperture_m=0.0)
    with pytest.raises(ValueError, match="positive full well"):
        Detector(full_well_electrons=-1.0)
