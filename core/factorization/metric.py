"""From an affine frame to metres: the metric constraints of range-Doppler images."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from core.arrays import Floats

LEAST_EIGENVALUE = 1e-6
"""Share of the greatest eigenvalue below which one of the fitted metric is raised: noise alone
makes it negative."""

LEAST_LOSS_SCALE = 1e-6
"""Constraints that hold to this are not told apart from outliers."""

UPPER = np.triu_indices(3)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Metric:
    """The map from affine to metric motion, and how well the constraints determine it.

    Attributes:
        upgrade: (3, 3) A, so that motion · A is metric and A⁻¹ · shape too.
        singular_ratio: least over greatest singular value of the constraints; near zero another
            shape fulfils them as well.
        rms: of the constraints left over: lengths less one and cosines, without unit.
    """

    upgrade: Floats
    singular_ratio: float
    rms: float


def solve_metric(range_rows: Floats, doppler_rows: Floats, *, scaled: bool = False) -> Metric:
    """Return what makes all range rows unit vectors, and Doppler rows perpendicular to them.

    The Doppler row's length is free: it is the frame's unknown rotation rate. The symmetric
    Q = A Aᵀ is fitted by linear least squares, made positive definite, and its factor refined
    under a robust loss.

    Args:
        range_rows: (frames, 3) affine motion in range.
        doppler_rows: (frames, 3) affine motion in Doppler, in any unit per frame.
        scaled: Doppler is cross-range in metres, so that its rows are unit vectors too.

    Source: the metric constraints of Tomasi and Kanade, 1992; unless `scaled` without the one on
    the second row's length, since a range-Doppler image's axes differ by the rotation rate.
    """
    length = np.sqrt(np.mean(np.sum(range_rows**2, axis=1)))
    k, d = range_rows / length, doppler_rows / length
    across = d / np.linalg.norm(d, axis=1, keepdims=True)
    units = np.concatenate([k, d]) if scaled else k
    system = np.concatenate([_quadratic(units, units), _quadratic(k, across)])
    wanted = np.concatenate([np.ones(len(units)), np.zeros(len(k))])
    entries, _, _, size = np.linalg.lstsq(system, wanted, rcond=None)
    factor = np.asarray(np.linalg.cholesky(_positive_definite(entries)), dtype=np.float64)

    def left_over(values: NDArray[np.float64]) -> Floats:
        return _left_over(_lower(values), units, k, across)

    start = factor.T[UPPER]
    scale = max(LEAST_LOSS_SCALE, 1.4826 * float(np.median(np.abs(left_over(start)))))
    refined = least_squares(
        left_over, start, loss="soft_l1", f_scale=scale, xtol=1e-14, ftol=1e-14, gtol=1e-14
    )
    return Metric(
        upgrade=_lower(refined.x) / length,
        singular_ratio=float(size[-1] / size[0]),
        rms=float(np.sqrt(np.mean(left_over(refined.x) ** 2))),
    )


def _quadratic(first: Floats, second: Floats) -> Floats:
    """Return rows (n, 6) whose product with the upper entries of Q is firstᵀ Q second."""
    product = first[:, :, None] * second[:, None, :]
    both = product + np.swapaxes(product, 1, 2)
    rows: Floats = both[:, UPPER[0], UPPER[1]]
    rows[:, UPPER[0] == UPPER[1]] /= 2
    return rows


def _positive_definite(entries: Floats) -> Floats:
    """Return the symmetric matrix of six upper entries with its eigenvalues made positive."""
    matrix = np.zeros((3, 3))
    matrix[UPPER] = entries
    size, axes = np.linalg.eigh(matrix + np.triu(matrix, 1).T)
    size = np.maximum(size, LEAST_EIGENVALUE * max(float(size.max()), LEAST_EIGENVALUE))
    definite: Floats = (axes * size) @ axes.T
    return definite


def _lower(values: Floats) -> Floats:
    factor = np.zeros((3, 3))
    factor[UPPER] = values
    return factor.T


def _left_over(factor: Floats, units: Floats, range_rows: Floats, doppler_rows: Floats) -> Floats:
    """Return how far the constraints are from holding: lengths less one, then cosines."""
    k, d = range_rows @ factor, doppler_rows @ factor
    size = np.linalg.norm(k, axis=1) * np.linalg.norm(d, axis=1)
    cosine = np.sum(k * d, axis=1) / np.maximum(size, 1e-300)
    left: Floats = np.concatenate([np.linalg.norm(units @ factor, axis=1) - 1, cosine])
    return left
