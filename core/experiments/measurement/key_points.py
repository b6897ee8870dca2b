"""Key points: how far off they are, by the marks' errors and the number of frames."""

from collections.abc import Sequence

import numpy as np
from scipy import stats
from scipy.spatial.transform import Rotation

from core.arrays import Floats
from core.experiments.measurement.pictures import key_points_picture
from core.experiments.measurement.settings import MeasurementSettings
from core.experiments.physics.part import Part, Progress
from core.experiments.results import Figure
from core.geometry.projection import Projection
from core.measurement.key_points import KeyPoint, length_between, located

PIXEL_M = 0.06
SIGMAS_PX = (0.5, 1.0, 2.0)
FRAMES = (2, 3, 5, 10, 20)
ENDS_M = np.array([[-3.1, 8.5, 0.6], [-3.1, -8.5, -0.6]])
"""Two corners of a Tiangong-like target's panels."""

LENGTH_FRAMES, LENGTH_SIGMA_PX = 5, 1.0


def key_points_part(settings: MeasurementSettings, progress: Progress) -> Part:
    """Mark a corner in frames from random directions with errors, and place it.

    Args:
        settings: number of draws.
        progress: told of stage, steps done and steps in all.
    """
    random = np.random.default_rng(settings.seed)
    figures: list[Figure] = []
    found = np.empty((len(FRAMES), len(SIGMAS_PX), 2))
    for row, frames in enumerate(FRAMES):
        for column, sigma_px in enumerate(SIGMAS_PX):
            points = [_drawn(frames, sigma_px, random)[0] for _ in range(settings.key_point_draws)]
            figures += _figures(frames, sigma_px, points)
            found[row, column] = _median_error_m(points), _median_predicted_m(points)
        progress("key points", row + 1, len(FRAMES))
    figures += _length_figures(settings, random)
    picture = key_points_picture(FRAMES, SIGMAS_PX, found, PIXEL_M)
    return Part(figures=tuple(figures), pictures=(picture,))


def _drawn(
    frames: int, sigma_px: float, random: np.random.Generator, *, is_known: bool = True
) -> tuple[KeyPoint, KeyPoint]:
    """Return both corners as marked once; frames that do not determine them are drawn again."""
    while True:
        turns = Rotation.random(frames, rng=random).as_matrix()
        views = [
            Projection(matrix=np.column_stack([turn[:2] / PIXEL_M, np.full(2, 256.0)]))
            for turn in turns
        ]
        try:
            first, second = (_marked(views, end, sigma_px, random, is_known) for end in ENDS_M)
        except ValueError:
            continue
        return first, second


def _marked(
    views: Sequence[Projection],
    place_m: Floats,
    sigma_px: float,
    random: np.random.Generator,
    is_known: bool,
) -> KeyPoint:
    marks = np.array([view.image_points(place_m) for view in views])
    noisy = marks + sigma_px * random.normal(size=marks.shape)
    return located("corner", views, noisy, sigma_px=sigma_px if is_known else None)


def _errors_m(points: Sequence[KeyPoint]) -> Floats:
    return np.array([point.position_m - ENDS_M[0] for point in points])


def _median_error_m(points: Sequence[KeyPoint]) -> float:
    return float(np.median(np.linalg.norm(_errors_m(points), axis=1)))


def _median_predicted_m(points: Sequence[KeyPoint]) -> float:
    """Return the median of the errors' size that each point's own covariance says."""
    return float(np.median([np.sqrt(np.trace(point.covariance_m2)) for point in points]))


def _figures(frames: int, sigma_px: float, points: Sequence[KeyPoint]) -> list[Figure]:
    squares = np.array(
        [
            error @ np.linalg.solve(point.covariance_m2, error)
            for point, error in zip(points, _errors_m(points), strict=True)
        ]
    )
    within = 100 * float(np.mean(squares <= stats.chi2.ppf(0.95, 3)))
    ratio = float(np.sqrt(squares.mean() / 3))
    title = f"key point, {frames} frames, marks ± {sigma_px:g} px"
    return [
        Figure(name=f"{title}: median error", value=1e3 * _median_error_m(points), unit="mm"),
        Figure(name=f"{title}: rms error over its own covariance's", value=ratio, wanted=">= 0.9"),
        Figure(name=f"{title}: no more than", value=ratio, wanted="<= 1.1"),
        Figure(name=f"{title}: in the 95 % ellipsoid", value=within, unit="%", wanted=">= 92 %"),
        Figure(name=f"{title}: no more than", value=within, unit="%", wanted="<= 98 %"),
    ]


def _length_figures(settings: MeasurementSettings, random: np.random.Generator) -> list[Figure]:
    """Return how often a length's interval holds the truth, the marks' error known or not."""
    truth_m = float(np.linalg.norm(ENDS_M[1] - ENDS_M[0]))
    figures = []
    for is_known, how in ((True, "given"), (False, "from the residuals")):
        lengths = [
            length_between(*_drawn(LENGTH_FRAMES, LENGTH_SIGMA_PX, random, is_known=is_known))
            for _ in range(settings.key_point_draws)
        ]
        held = 100 * float(np.mean([each.low_m <= truth_m <= each.high_m for each in lengths]))
        error_mm = 1e3 * float(np.median([abs(each.value_m - truth_m) for each in lengths]))
        title = f"length of {truth_m:.2f} m between key points, {LENGTH_FRAMES} frames, sigma {how}"
        figures += [
            Figure(name=f"{title}: median error", value=error_mm, unit="mm"),
            Figure(name=f"{title}: intervals that hold it", value=held, unit="%", wanted=">= 90 %"),
            Figure(name=f"{title}: no more than", value=held, unit="%", wanted="<= 99 %"),
        ]
    return figures
