"""Checks and freezing of the arrays that the central types hold."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

Floats = NDArray[np.float64]


def frozen(values: Any, dtype: DTypeLike, shape: tuple[int | None, ...], name: str) -> NDArray[Any]:
    """Return a read-only C-ordered array of the wanted type, shape and finite values.

    Args:
        values: anything that NumPy can turn into an array. One that is as wanted already,
            read-only and owning its data, is not copied.
        dtype: the wanted element type.
        shape: the wanted shape; None stands for any length along that axis.
        name: what the message calls the array.

    Raises:
        ValueError: wrong shape, or values that are NaN or infinite.
    """
    array = values if _is_frozen(values, dtype) else np.array(values, dtype=dtype, order="C")
    if array.ndim != len(shape) or any(
        wanted is not None and got != wanted for wanted, got in zip(shape, array.shape, strict=True)
    ):
        wanted_text = " × ".join("any" if length is None else str(length) for length in shape)
        raise ValueError(f"{name}: wanted an array of shape {wanted_text}, got {array.shape}.")
    bad = 0 if array.dtype.kind in "biu" else array.size - np.count_nonzero(np.isfinite(array))
    if bad:
        raise ValueError(
            f"{name}: {bad} of {array.size} values are NaN or infinite; every value must be finite."
        )
    array.flags.writeable = False
    return array


def _is_frozen(values: Any, dtype: DTypeLike) -> bool:
    if not isinstance(values, np.ndarray) or values.dtype != dtype:
        return False
    flags = values.flags
    return flags.c_contiguous and flags.owndata and not flags.writeable
