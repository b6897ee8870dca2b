"""JAX: one jitted lookup of all voxels per view, scanned over the views."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from core.benchmarks.workload import Task


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    _, ny, nz = task.grid.shape
    found = _looked_up(
        jnp.asarray(task.masks.astype(task.dtype)),
        jnp.asarray(task.to_image, dtype=jnp.float32),
        jnp.asarray(planes, dtype=jnp.float32),
        shape=(ny, nz),
    )
    return np.asarray(found)


@partial(jax.jit, static_argnames="shape")
def _looked_up(masks: Any, to_image: Any, planes: Any, *, shape: tuple[int, int]) -> Any:
    rows, columns = masks.shape[1:]
    x = planes[:, None, None]
    y = jnp.arange(shape[0], dtype=jnp.float32)[None, :, None]
    z = jnp.arange(shape[1], dtype=jnp.float32)[None, None, :]

    def add(counted: Any, view: Any) -> tuple[Any, None]:
        mask, m = view
        row, column = (
            jnp.rint(m[i, 0] * x + m[i, 1] * y + m[i, 2] * z + m[i, 3]).astype(jnp.int32)
            for i in range(2)
        )
        seen = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        at = jnp.where(seen, row * columns + column, 0)
        return counted + jnp.where(seen, mask.ravel()[at], 0).astype(mask.dtype), None

    start = jnp.zeros((len(planes), *shape), dtype=masks.dtype)
    return jax.lax.scan(add, start, (masks, to_image))[0]
