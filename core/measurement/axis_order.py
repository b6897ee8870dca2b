"""The same axes in the same order, on hulls that differ a little."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from core.arrays import Floats
from core.measurement.results import Lost, Measurement


def order_along(axes: Floats, reference: Floats) -> NDArray[np.int64]:
    """Return for each reference axis (n, 3) the number of the axis (n, 3) that is most nearly it.

    Each axis is taken once, and its sign means nothing: the sum of |cos| is greatest.

    Source: Kuhn, "The Hungarian method for the assignment problem", 1955.
    """
    _, order = linear_sum_assignment(-np.abs(reference @ axes.T))
    return np.asarray(order, dtype=np.int64)


def like(result: Measurement | Lost, reference: Measurement | Lost) -> Measurement | Lost:
    """Return a body's extents in the order of another hull's, with the same one as its value.

    The value is the longest of them. Where two are nearly equal, a slightly other hull has them in
    another order, and the difference of two axes would pass for the error of one. What has no three
    perpendicular axes, the longest of which is its value, is returned as it is.
    """
    if isinstance(result, Lost) or isinstance(reference, Lost):
        return result
    if not (_is_of_longest_axis(result) and _is_of_longest_axis(reference)):
        return result
    order = order_along(result.axes, reference.axes)
    axes, sizes = result.axes[order], result.sizes_m[order]
    longest = int(np.argmax(reference.sizes_m))
    return replace(
        result, value=float(sizes[longest]), direction=axes[longest], sizes_m=sizes, axes=axes
    )


def all_like(
    results: Sequence[Measurement | Lost], references: Sequence[Measurement | Lost]
) -> list[Measurement | Lost]:
    """Return each of several results `like` its reference."""
    return [like(each, reference) for each, reference in zip(results, references, strict=True)]


def _is_of_longest_axis(result: Measurement) -> bool:
    axes = result.axes
    return (
        axes.shape == (3, 3)
        and bool(np.allclose(axes @ axes.T, np.eye(3), atol=1e-6))
        and bool(np.isclose(result.value, result.sizes_m.max(), rtol=1e-9))
    )
