"""The factorization algorithm for range-Doppler tracks: shape and motion, no line of sight."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen
from core.factorization.low_rank import (
    AffineFit,
    first_guess,
    fit_complete,
    fit_incomplete,
    with_shape,
)
from core.factorization.metric import Metric, solve_metric

LEAST_FRAMES = 3
LEAST_POINTS = 4
"""Fewer frames do not determine the metric, fewer points not an affine motion."""

LEAST_RATIO = 1e-6
"""Singular values apart by more are zero in what double precision can tell."""

UNCERTAIN = 3.0
"""Points more uncertain than the median by this factor say nothing about centroid and rank."""

NOISE_MARGIN = 3.0
"""A third singular value within this many times the noise's own greatest is noise."""

RANDOM_STARTS = 3
"""Tracks that are seen without a break for a third of the frames or less have false minima."""

ROBUST_ROUNDS = 12
"""How often points are weighed anew, two steps of the fit after each."""

CAUCHY = 2.385
"""Tuning of the Cauchy loss for 95 % efficiency under Gaussian noise."""


class UnobservableShape(ValueError):  # noqa: N818 - says what is wrong, as the field does
    """The tracks fit many shapes: their motion is planar, or keeps to one cone, or noise rules."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Factorization:
    """Shape and motion from tracks alone.

    The frame is the algorithm's own: the truth is R · shape for one unknown orthogonal R, which
    may mirror (shape and motion both turned round give the same tracks). Range is in metres and
    its row a unit vector, so that the scale is known if ranges are; the origin is the centroid of
    the points that are certain enough.

    Attributes:
        shape_m: (points found, 3).
        points: (points found,) their numbers in the tracks; a point needs two frames.
        line_of_sight: (frames used, 3) unit rows k.
        cross_range_direction: (frames used, 3) unit rows along dk/dt.
        cross_range_scale: (frames used,) what cross-range metres are multiplied by in the tracks:
            the rotation rate in rad/s where the tracks hold range rates.
        translation: (frames used, 2) image of the origin, in the tracks' units.
        frames: (frames used,) their numbers; a frame needs four points.
        uncertainty_m: (points found,) standard deviation of the distance from the true place, the
            motion taken as exact; a point seen in two like frames has a large one.
        range_rms_m: of the ranges left over.
        rank_ratio: third over first singular value of the tracks, gaps filled by the fit, points
            much less certain than most left out.
        metric_ratio: least over greatest singular value of the metric constraints.
    """

    shape_m: Floats
    points: NDArray[np.int64]
    line_of_sight: Floats
    cross_range_direction: Floats
    cross_range_scale: Floats
    translation: Floats
    frames: NDArray[np.int64]
    uncertainty_m: Floats
    range_rms_m: float
    rank_ratio: float
    metric_ratio: float

    def __post_init__(self) -> None:
        points, frames = len(self.points), len(self.frames)
        for name, dtype, shape in (
            ("shape_m", np.float64, (points, 3)),
            ("points", np.int64, (points,)),
            ("line_of_sight", np.float64, (frames, 3)),
            ("cross_range_direction", np.float64, (frames, 3)),
            ("cross_range_scale", np.float64, (frames,)),
            ("translation", np.float64, (frames, 2)),
            ("frames", np.int64, (frames,)),
            ("uncertainty_m", np.float64, (points,)),
        ):
            object.__setattr__(self, name, frozen(getattr(self, name), dtype, shape, name))


def factorize(
    tracks: Floats,
    *,
    scaled: bool = False,
    robust: bool = False,
    even_if_ambiguous: bool = False,
) -> Factorization:
    """Recover shape and motion from tracks of scatterers through range-Doppler images.

    Range k·p + t and Doppler s u·p + t' of all points are rows of a matrix of rank three, once
    each row's translation is taken out. Its factors are metric once every k is a unit vector and
    every u perpendicular to it.

    Without gaps the rank-three fit is the singular value decomposition; with gaps, and under the
    robust loss, the damped Wiberg algorithm from a few starts. The published algorithm is not
    robust: a wrong association enters like any other point. Where gaps and wrong associations
    meet, both fail: 755 scatterers in 60 frames stand nine tenths of gaps alone, but with a tenth
    of wrong points on top least squares is off by metres, and the robust loss at those scatterers
    that two or three frames show.

    Args:
        tracks: (frames, points, 2): range in metres, and cross-range or Doppler, each frame in a
            unit of its own but with its sign along dk/dt; NaN where a point is missing.
        scaled: cross-range is in metres in every frame, by rotation rates known from elsewhere.
        robust: weigh points that fit badly less (Cauchy's loss) instead of by least squares.
        even_if_ambiguous: give the best shape, as the published algorithm does, where noise leaves
            room for others; for comparisons only.

    Raises:
        UnobservableShape: more than one shape fits. One pass of one station is such a case: its
            lines of sight almost keep to one cone, and a millimetre of noise hides the rest.
        ValueError: tracks of another shape, or too few points seen together.

    Source: Tomasi and Kanade, 1992, with the constraints of `core.factorization.metric`; as a
    rival in radar: Wang, Xu and Jin, "Three-dimensional reconstruction from a multiview sequence
    of sparse ISAR imaging of a space target", 2018.
    """
    tracks = np.asarray(tracks, dtype=np.float64)
    if tracks.ndim != 3 or tracks.shape[2] != 2:
        raise ValueError(f"Tracks are an array (frames, points, 2), got {tracks.shape}.")
    seen = np.all(np.isfinite(tracks), axis=2)
    frames, points = _usable(seen)
    known = seen[np.ix_(frames, points)]
    rows, doppler_unit = _rows(tracks[np.ix_(frames, points)], known)
    weights = np.concatenate([known, known]).astype(np.float64)
    fit = _fitted(rows, weights, robust=robust)
    noise = _noise(fit, rows, weights, robust=robust)
    doubt = 0.0 if even_if_ambiguous else noise
    rank_ratio, fit = _ranked(fit, doubt, weights)
    metric = _checked_metric(fit, doubt, weights, doppler_unit if scaled else None)
    k, d = np.split(fit.motion @ metric.upgrade, 2)
    scale = np.linalg.norm(d, axis=1)
    range_translation, doppler_translation = np.split(fit.translation, 2)
    return Factorization(
        shape_m=fit.shape @ np.linalg.inv(metric.upgrade).T,
        points=points,
        line_of_sight=k / np.linalg.norm(k, axis=1, keepdims=True),
        cross_range_direction=d / scale[:, None],
        cross_range_scale=scale * doppler_unit,
        translation=np.column_stack([range_translation, doppler_translation * doppler_unit]),
        frames=frames,
        uncertainty_m=noise * _dilution(fit.motion @ metric.upgrade, weights),
        range_rms_m=float(np.sqrt(np.mean(fit.residual(rows)[: len(frames)][known] ** 2))),
        rank_ratio=rank_ratio,
        metric_ratio=metric.singular_ratio,
    )


def _usable(seen: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the frames with four points or more and the points in two of them or more."""
    frames, points = np.ones(seen.shape[0], dtype=bool), np.ones(seen.shape[1], dtype=bool)
    while True:
        enough_frames = (seen & points).sum(axis=1) >= LEAST_POINTS
        enough_points = (seen & enough_frames[:, None]).sum(axis=0) >= 2
        if np.array_equal(enough_frames, frames) and np.array_equal(enough_points, points):
            break
        frames, points = enough_frames, enough_points
    if frames.sum() < LEAST_FRAMES or points.sum() < LEAST_POINTS:
        raise ValueError(
            f"Factorization needs at least {LEAST_FRAMES} frames that share {LEAST_POINTS} points; "
            f"of {seen.shape[0]} frames and {seen.shape[1]} points, {frames.sum()} and "
            f"{points.sum()} are linked by enough of them. Track more points, or longer."
        )
    return np.flatnonzero(frames), np.flatnonzero(points)


def _rows(tracks: Floats, known: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Return ranges over Dopplers (2 frames, points), and each frame's unit of Doppler.

    The unit gives Dopplers the spread of the ranges, so that noise weighs alike in both.
    """
    count = known.sum(axis=1)
    filled = np.where(known[..., None], tracks, 0)
    mean = filled.sum(axis=1) / count[:, None]
    excess = np.where(known[..., None], tracks - mean[:, None], 0)
    spread = np.sqrt(np.sum(excess**2, axis=1) / count[:, None])
    unit = spread[:, 1] / np.sqrt(np.mean(spread[:, 0] ** 2))
    if not np.all(unit > 0):
        raise UnobservableShape(
            "In some frame all points have one Doppler: it does not turn. Leave that frame out."
        )
    return np.concatenate([filled[..., 0], filled[..., 1] / unit[:, None]]), unit


def _fitted(rows: Floats, weights: Floats, *, robust: bool) -> AffineFit:
    if np.all(weights > 0):
        fit = fit_complete(rows)
    else:
        fit = min(
            (fit_incomplete(rows, weights, start) for start in _starts(rows, weights)),
            key=lambda found: found.squared_error,
        )
    for _ in range(ROBUST_ROUNDS if robust else 0):
        fit = fit_incomplete(rows, weights * _cauchy(fit, rows, weights), fit, steps=2)
    return fit


def _starts(rows: Floats, weights: Floats) -> Iterator[AffineFit]:
    """Yield where to start from: the guess that suits gaps at random, then motions at random."""
    guess = first_guess(rows, weights)
    yield guess
    random = np.random.default_rng(0)
    for _ in range(RANDOM_STARTS):
        motion = random.normal(size=guess.motion.shape)
        yield with_shape(motion, guess.translation, rows, weights)


def _cauchy(fit: AffineFit, rows: Floats, weights: Floats) -> Floats:
    """Return Cauchy's weights of a fit's residuals; both rows of a frame share a point's weight."""
    error = fit.residual(rows)
    distance = np.hypot(*np.split(error, 2))
    known = np.split(weights, 2)[0] > 0
    # The median of a two-dimensional Gaussian's length is 1.18 standard deviations.
    scale = max(float(np.median(distance[known])) / 1.1774, 1e-12)
    half = 1 / (1 + (distance / (CAUCHY * scale)) ** 2)
    return np.concatenate([half, half])


def _noise(fit: AffineFit, rows: Floats, weights: Floats, *, robust: bool) -> float:
    """Return the standard deviation of the rows about the fit, in their unit."""
    known = weights > 0
    error = np.abs(fit.residual(rows)[known])
    freedom = 1 - (4 * weights.shape[0] + 3 * weights.shape[1] - 12) / np.count_nonzero(known)
    spread = 1.4826 * np.median(error) if robust else np.sqrt(np.mean(error**2))
    return float(spread / np.sqrt(max(freedom, 0.05)))


def _dilution(motion: Floats, weights: Floats) -> Floats:
    """Return by how much each point's place (points,) is less certain than one of its rows."""
    normal = np.einsum("rj,ra,rb->jab", weights, motion, motion, optimize=True)
    spread = np.trace(np.linalg.pinv(normal, hermitian=True), axis1=1, axis2=2)
    return np.asarray(np.sqrt(spread), dtype=np.float64)


def _ranked(fit: AffineFit, noise: float, weights: Floats) -> tuple[float, AffineFit]:
    """Return the singular values' ratio, and the fit in the frame of its singular vectors.

    Raises:
        UnobservableShape: the third does not stand out of the noise.
    """
    outer, upper = np.linalg.qr(fit.motion)
    dilution = _dilution(outer, weights)
    certain = dilution <= UNCERTAIN * np.median(dilution)
    centroid = fit.shape[certain].mean(axis=0)
    points = upper @ (fit.shape - centroid).T
    left, size, _ = np.linalg.svd(points[:, certain], full_matrices=False)
    count, share = len(fit.motion), float(np.mean(weights > 0))
    noise_size = noise * (np.sqrt(count) + np.sqrt(certain.sum())) / np.sqrt(share)
    if size[2] < max(NOISE_MARGIN * noise_size, LEAST_RATIO * size[0]):
        raise UnobservableShape(
            "The tracks hold two dimensions only (singular values "
            f"{size[0]:.3g}, {size[1]:.3g}, {size[2]:.3g}; noise up to {noise_size:.3g}): the line "
            "of sight stayed in a plane, or the points lie in one. Add frames from outside it."
        )
    ranked = AffineFit(
        motion=outer @ left * np.sqrt(count),
        translation=fit.translation + fit.motion @ centroid,
        shape=points.T @ left / np.sqrt(count),
        squared_error=fit.squared_error,
    )
    return float(size[2] / size[0]), ranked


def _checked_metric(
    fit: AffineFit, noise: float, weights: Floats, doppler_unit: Floats | None
) -> Metric:
    """Return the metric, or raise UnobservableShape if the constraints leave it open.

    The noise of a motion row disturbs the constraints' singular values by about a third of itself.
    """
    k, d = np.split(fit.motion, 2)
    if doppler_unit is None:
        metric = solve_metric(k, d)
    else:
        metric = solve_metric(k, d * doppler_unit[:, None], scaled=True)
    weakest = float(np.linalg.norm(fit.shape, axis=0).min())
    row_noise = noise / (weakest * np.sqrt(np.mean(weights > 0)))
    if metric.singular_ratio < max(row_noise, LEAST_RATIO):
        raise UnobservableShape(
            "More than one shape fits the tracks: the metric constraints' singular values are "
            f"apart by {metric.singular_ratio:.1e}, the noise is {row_noise:.1e}. Lines of "
            "sight on one quadric cone do that, as in a turn at a constant angle about one axis; "
            "add frames from elsewhere, or tracks with fewer wrong points."
        )
    return metric
