"""The best affine motion and shape behind tracks with missing points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats

STEPS = 60
"""Most steps of one fit; a good start needs about ten."""

CONVERGED = 1e-8
"""A step that lowers the squared error by less than this share of it ends the fit."""

EXACT = 1e-28
"""Squared errors below this share of the rows' own are rounding."""

FIRST_DAMPING = 1e-3
GIVE_UP_DAMPING = 1e6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AffineFit:
    """Rows that are affine functions of points: rows ≈ motion · shapeᵀ + translation.

    Attributes:
        motion: (rows, 3).
        translation: (rows,).
        shape: (points, 3), up to any affine map.
        squared_error: weighted sum over the entries.
    """

    motion: Floats
    translation: Floats
    shape: Floats
    squared_error: float

    def residual(self, rows: Floats) -> Floats:
        """Return rows (rows, points) minus the fit."""
        residual: Floats = rows - self.motion @ self.shape.T - self.translation[:, None]
        return residual


def fit_complete(rows: Floats) -> AffineFit:
    """Return the best fit to rows (rows, points) without gaps, by singular values.

    Source: Tomasi and Kanade, "Shape and motion from image streams under orthography: a
    factorization method", 1992.
    """
    translation = rows.mean(axis=1)
    left, size, right = np.linalg.svd(rows - translation[:, None], full_matrices=False)
    return AffineFit(
        motion=left[:, :3] * size[:3],
        translation=translation,
        shape=right[:3].T,
        squared_error=float(np.sum(size[3:] ** 2)),
    )


def first_guess(rows: Floats, weights: Floats) -> AffineFit:
    """Return a fit to start from: gaps filled with their row's mean, and the known part's share.

    Where points are missing at random, the leading singular vectors of the filled matrix point the
    right way (Keshavan, Montanari and Oh, "Matrix completion from a few entries", 2010).
    """
    known = weights > 0
    count = np.maximum(known.sum(axis=1), 1)
    translation = np.where(known, rows, 0).sum(axis=1) / count
    filled = np.where(known, rows - translation[:, None], 0) * (known.size / known.sum())
    return with_shape(fit_complete(filled).motion, translation, rows, weights)


def fit_incomplete(
    rows: Floats, weights: Floats, start: AffineFit, *, steps: int = STEPS
) -> AffineFit:
    """Return the fit of least weighted squares near a start, gaps having weight zero.

    The shape is eliminated: for each motion it is what fits best, and damped Gauss-Newton steps
    (Levenberg and Marquardt) move the motion alone. Alternating between the two would need
    thousands of rounds where most points are missing.

    Args:
        rows: (rows, points), anything where the weight is zero.
        weights: (rows, points), not negative.
        start: whose motion is improved.
        steps: to try at most.

    Source: the damped Wiberg algorithm of Okatani, Yoshida and Deguchi, "Efficient algorithm for
    low-rank matrix factorization with missing components", 2011, with translations as in Hong and
    Fitzgibbon, "Secrets of matrix factorization", 2015.
    """
    best, damping = with_shape(start.motion, start.translation, rows, weights), FIRST_DAMPING
    system = _reduced_system(best, rows, weights)
    exact = EXACT * float(np.sum(weights * np.where(weights > 0, rows, 0) ** 2))
    for _ in range(steps):
        motion, translation = _step(best, *system, damping)
        trial = with_shape(motion, translation, rows, weights)
        gain = best.squared_error - trial.squared_error
        if gain > 0:
            small = gain <= CONVERGED * best.squared_error
            best, damping = trial, damping / 10
            if small or best.squared_error < exact:
                break
            system = _reduced_system(best, rows, weights)
        else:
            damping *= 10
            if damping > GIVE_UP_DAMPING:
                break
    return best


def with_shape(motion: Floats, translation: Floats, rows: Floats, weights: Floats) -> AffineFit:
    """Return the fit of a given motion (rows, 3) and translation (rows,) with its best shape.

    The motion's columns are made orthonormal on the way, which only changes the affine frame.
    """
    motion, _ = np.linalg.qr(motion)
    excess = np.where(weights > 0, rows - translation[:, None], 0)
    normal = np.einsum("rj,ra,rb->jab", weights, motion, motion, optimize=True)
    side = (weights * excess).T @ motion
    shape: Floats = np.einsum("jab,jb->ja", np.linalg.pinv(normal, hermitian=True), side)
    error = excess - motion @ shape.T
    return AffineFit(
        motion=motion,
        translation=translation,
        shape=shape,
        squared_error=float(np.sum(weights * error**2)),
    )


def _reduced_system(fit: AffineFit, rows: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Return the normal matrix and right side of the motion, (4 rows)² and (4 rows,).

    The shape is eliminated by the Schur complement; each row has three motion entries and its
    translation.
    """
    count, points = weights.shape
    extended = np.column_stack([fit.shape, np.ones(points)])
    error = np.where(weights > 0, fit.residual(rows), 0)
    own = np.einsum("rj,ja,jb->rab", weights, extended, extended, optimize=True)
    shape_normal = np.einsum("rj,ra,rb->jab", weights, fit.motion, fit.motion, optimize=True)
    size, axes = np.linalg.eigh(shape_normal)
    usable = size > 1e-10 * size[:, -1:]
    root = axes * np.sqrt(np.where(usable, 1 / np.where(usable, size, 1), 0))[:, None, :]
    along = np.einsum("ra,jab->rjb", fit.motion, root) * weights[:, :, None]
    coupling = np.einsum("rjb,ja->rajb", along, extended).reshape(4 * count, 3 * points)
    matrix = -(coupling @ coupling.T)
    blocks = matrix.reshape(count, 4, count, 4)
    blocks[np.arange(count), :, np.arange(count), :] += own
    side = (weights * error) @ extended
    return matrix, side.ravel()


def _step(
    fit: AffineFit, matrix: Floats, side: Floats, damping: float
) -> tuple[Floats, NDArray[np.float64]]:
    """Return the motion (rows, 3) and translation (rows,) after one damped step."""
    size = float(np.mean(np.diag(matrix)))
    damped = matrix + damping * size * np.eye(len(matrix))
    change = np.linalg.solve(damped, side).reshape(-1, 4)
    return fit.motion + change[:, :3], fit.translation + change[:, 3]
