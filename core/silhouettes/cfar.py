"""Constant false alarm rate detection of the target against receiver noise."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MAX_ROUNDS = 100


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Detection:
    """Pixels above the background, and how the threshold came about.

    Attributes:
        mask: (rows, columns) pixels above the threshold.
        threshold: amplitude above which a pixel is target.
        background_mean, background_deviation: of the pixels left as background.
        rounds: censoring rounds until the background no longer changed.
    """

    mask: NDArray[np.bool_]
    threshold: float
    background_mean: float
    background_deviation: float
    rounds: int


def detect(
    amplitude: NDArray[np.float32], *, censoring_factor: float = 3.0, detection_factor: float = 5.0
) -> Detection:
    """Separate target from background in an amplitude image (rows, columns).

    The background's mean μ and deviation σ are taken over all pixels, those above
    μ + a₁σ are censored, and both are taken again, until a round censors the same pixels as the
    one before (or after 100 rounds: censoring only ever lowers the bound in practice, but ties
    might cycle). What then exceeds μ + a₂σ is target.

    Args:
        amplitude: linear, not negative.
        censoring_factor: a₁.
        detection_factor: a₂, not below a₁.

    Raises:
        ValueError: factors that are not 0 < a₁ ≤ a₂, or an image of one value throughout.

    Source: eqs. 17 to 19. The amplitude of receiver noise is Rayleigh distributed, its density
    (x/s²) exp(−x²/2s²); the print drops the exponent's minus sign (eq. 17). At a₂ = 5 that
    density leaves a false alarm in 3·10⁴ pixels.
    """
    if not 0 < censoring_factor <= detection_factor:
        raise ValueError(
            "CFAR needs 0 < a₁ ≤ a₂ (censoring, detection); got "
            f"a₁ = {censoring_factor}, a₂ = {detection_factor}."
        )
    values = amplitude.ravel().astype(np.float64)
    if float(np.ptp(values)) == 0:
        raise ValueError(
            f"Every pixel of the frame has the same amplitude, {values[0]:g}; there is no image."
        )
    background = values
    rounds = 0
    while rounds < MAX_ROUNDS:
        rounds += 1
        mean, deviation = float(background.mean()), float(background.std())
        kept = values[values <= mean + censoring_factor * deviation]
        if len(kept) == len(background) or len(kept) == 0:
            break
        background = kept
    threshold = mean + detection_factor * deviation
    return Detection(
        mask=amplitude > threshold,
        threshold=threshold,
        background_mean=mean,
        background_deviation=deviation,
        rounds=rounds,
    )
