import numpy as np
import pytest

from core.silhouettes.cfar import detect


def rayleigh(seed, shape=(256, 256)):
    return np.random.default_rng(seed).rayleigh(1.0, shape).astype(np.float32)


def test_noise_alone_raises_few_false_alarms():
    """Five deviations above a Rayleigh mean: exp(−(1.2533 + 5·0.6551)²/2) = 3.5·10⁻⁵ a pixel."""
    alarms = sum(int(detect(rayleigh(seed)).mask.sum()) for seed in range(10))
    assert alarms == pytest.approx(10 * 256 * 256 * 3.5e-5, abs=30)


def test_the_background_is_found_under_a_bright_target():
    image = rayleigh(1)
    image[60:140, 60:140] *= 50
    detection = detect(image)
    assert detection.background_mean == pytest.approx(np.sqrt(np.pi / 2), rel=0.02)
    assert detection.background_deviation == pytest.approx(np.sqrt(2 - np.pi / 2), rel=0.05)
    assert detection.mask[60:140, 60:140].mean() > 0.98
    assert 1 < detection.rounds < 100


def test_the_detection_does_not_depend_on_scale():
    image = rayleigh(2)
    image[10:30, 10:30] += 20
    assert np.array_equal(detect(image).mask, detect(image * np.float32(2**20)).mask)


@pytest.mark.parametrize(("a1", "a2"), [(0, 5), (5, 3), (-1, 2)])
def test_factors_out_of_order_are_refused(a1, a2):
    with pytest.raises(ValueError, match="CFAR needs 0 < a₁ ≤ a₂"):
        detect(rayleigh(3), censoring_factor=a1, detection_factor=a2)


def test_a_frame_without_contrast_is_refused():
    with pytest.raises(ValueError, match="same amplitude, 3; there is no image"):
        detect(np.full((8, 8), 3, dtype=np.float32))
