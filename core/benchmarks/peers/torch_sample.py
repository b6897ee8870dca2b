"""torch's grid_sample of all masks at once, plane by plane, with its own threads."""

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from core.benchmarks.workload import Task


def votes(task: Task, planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of some planes."""
    _, ny, nz = task.grid.shape
    masks = torch.from_numpy(task.masks).float()[:, None]
    # grid_sample wants (x, y) = (column, row), −1 and 1 at the centres of the outermost pixels.
    sides = torch.tensor([task.masks.shape[2] - 1, task.masks.shape[1] - 1])
    maps = torch.from_numpy(task.to_image[:, ::-1].copy()) * (2 / sides)[:, None]
    maps[:, :, 3] -= 1
    maps = maps.float()
    y, z = torch.arange(ny).float()[:, None], torch.arange(nz).float()[None, :]
    counted = np.empty((len(planes), ny, nz), dtype=task.dtype)
    for target, plane in zip(counted, planes, strict=True):
        m = maps[:, :, :, None, None]
        at = m[:, :, 0] * float(plane) + m[:, :, 1] * y + m[:, :, 2] * z + m[:, :, 3]
        seen = torch.nn.functional.grid_sample(
            masks, at.permute(0, 2, 3, 1), mode="nearest", align_corners=True
        )
        target[:] = seen.sum(dim=(0, 1)).numpy()
    return counted
