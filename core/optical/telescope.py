"""The telescope and its detector: diffraction, photons and electrons."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from core.arrays import Floats

AIRY_FWHM = 1.0289940
"""Full width at half maximum of a circular aperture's point spread, in units of λ/D."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Telescope:
    """A telescope whose point spread is that of its round, unobstructed aperture.

    The built-in one has the aperture of the 3.67 m Advanced Electro-Optical System on Maui.

    Attributes:
        aperture_m: diameter D.
        wavelength_m: λ at the middle of the band.
        jitter_rad: full width at half maximum of what the air and the mount add, a Gaussian; 0
            for perfect adaptive optics.
    """

    aperture_m: float = 3.67
    wavelength_m: float = 0.7e-6
    jitter_rad: float = 0.0

    def __post_init__(self) -> None:
        if not (self.aperture_m > 0 and self.wavelength_m > 0 and self.jitter_rad >= 0):
            raise ValueError(
                "A telescope needs a positive aperture and wavelength in metres and a jitter of "
                f"0 or more radians; got {self.aperture_m}, {self.wavelength_m} and "
                f"{self.jitter_rad}."
            )

    @property
    def diffraction_rad(self) -> float:
        """λ/D, and the reciprocal of the highest frequency that passes."""
        return self.wavelength_m / self.aperture_m

    def resolution_rad(self) -> float:
        """Return the point spread's full width at half maximum.

        With jitter it is the root of the squares' sum, some per cent from the truth.
        """
        return float(np.hypot(AIRY_FWHM * self.diffraction_rad, self.jitter_rad))

    def transfer(self, frequency_per_rad: Floats) -> Floats:
        """Return the modulation transfer (…,) at spatial frequencies (…,) on the sky.

        Source: Goodman, "Introduction to Fourier optics", 1996, eq. 6-31.
        """
        share = np.minimum(np.abs(frequency_per_rad) * self.diffraction_rad, 1.0)
        aperture = 2 / np.pi * (np.arccos(share) - share * np.sqrt(1 - share**2))
        spread = np.pi * self.jitter_rad * frequency_per_rad
        blurred: Floats = aperture * np.exp(-(spread**2) / (4 * np.log(2)))
        return blurred


@dataclass(frozen=True, slots=True, kw_only=True)
class Detector:
    """What turns light into numbers.

    Attributes:
        full_well_electrons: at which a pixel saturates; amplitude 1 in the frame.
        white_electrons: what an exposure collects of a white Lambertian surface that faces the sun.
        background_electrons: what it collects of the sky in every pixel.
        read_noise_electrons: standard deviation of reading a pixel.
        bias_electrons: added before reading, so that noise stays above zero.
    """

    full_well_electrons: float = 60_000.0
    white_electrons: float = 40_000.0
    background_electrons: float = 20.0
    read_noise_electrons: float = 5.0
    bias_electrons: float = 100.0

    def __post_init__(self) -> None:
        noises = (self.background_electrons, self.read_noise_electrons, self.bias_electrons)
        if not (self.full_well_electrons > 0 and self.white_electrons > 0 and min(noises) >= 0):
            raise ValueError(
                "A detector needs a positive full well and exposure and a background, read noise "
                f"and bias of 0 or more electrons; got {self}."
            )


def blurred(image: Floats, telescope: Telescope, sample_rad: float) -> Floats:
    """Return an image (rows, columns) as the telescope forms it, with dark all around it.

    Args:
        image: radiance at points `sample_rad` apart.
        telescope: whose transfer is applied exactly, in the Fourier domain.
        sample_rad: distance between samples on the sky.
    """
    # Half the image again of darkness, so that what wraps around is the faint end of the wings.
    shape = [fft.next_fast_len(size + size // 2, real=True) for size in image.shape]
    row = fft.fftfreq(shape[0], sample_rad)[:, None]
    column = fft.rfftfreq(shape[1], sample_rad)[None]
    # Single precision resolves 10⁻⁷ of the brightest, far below the photons' noise.
    spectrum = fft.rfft2(image.astype(np.float32), shape) * telescope.transfer(
        np.hypot(row, column)
    ).astype(np.float32)
    formed: Floats = fft.irfft2(spectrum, shape)[: image.shape[0], : image.shape[1]]
    return np.maximum(formed, 0.0)


def exposed(
    radiance: Floats, detector: Detector, random: np.random.Generator
) -> NDArray[np.float32]:
    """Return what the detector reads, (rows, columns), as a share of its full well.

    Photons come by Poisson's law, reading adds Gaussian noise, and a full pixel takes no more.

    Args:
        radiance: (rows, columns), 1 for a white Lambertian surface that faces the sun.
        detector: its electrons.
        random: for photons and reading.
    """
    mean = detector.white_electrons * radiance + detector.background_electrons
    electrons = np.minimum(random.poisson(mean), detector.full_well_electrons)
    read = electrons + random.normal(
        detector.bias_electrons, detector.read_noise_electrons, radiance.shape
    )
    share = np.clip(read / detector.full_well_electrons, 0.0, 1.0)
    return share.astype(np.float32)
