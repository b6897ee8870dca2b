"""OpenCV's fillPoly: every outline pulled back into every plane and filled there, on all threads.

Each view is sliced along the axis across which its outline is pulled back best. fillPoly also
paints the pixels that its outline touches, so its hulls come out too large.
"""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.benchmarks.workload import Task
from core.hull.threads import in_parallel

SHIFT = 8
"""Binary digits after the point in fillPoly's coordinates."""


def votes(task: Task, _planes: NDArray[np.int64]) -> NDArray[Any]:
    """Return the votes of all planes."""
    counted = np.zeros(task.grid.shape, dtype=task.dtype)
    axes = [slice_axis(to_image) for to_image in task.to_image]
    for axis in sorted(set(axes)):
        chosen = [number for number, of in enumerate(axes) if of == axis]
        outlines = [
            pulled_back(task.views[number].silhouette.rings, task.to_image[number], axis)
            for number in chosen
        ]
        _fill(np.moveaxis(counted, axis, 0), outlines)
    return counted


def slice_axis(to_image: Floats) -> int:
    """Return the axis across which a view's image plane stands least edge-on."""
    across = np.cross(to_image[0, :3], to_image[1, :3])
    return int(np.argmax(np.abs(across)))


def pulled_back(
    rings: tuple[Floats, ...], to_image: Floats, axis: int
) -> tuple[list[Floats], Floats]:
    """Return rings at slice 0 as OpenCV's (x, y), and how far they move from slice to slice."""
    first, second = (other for other in range(3) if other != axis)
    inverse = np.linalg.inv(to_image[:, [second, first]])
    return [(ring - to_image[:, 3]) @ inverse.T for ring in rings], -inverse @ to_image[:, axis]


def _fill(volume: NDArray[Any], outlines: list[tuple[list[Floats], Floats]]) -> None:
    def work(number: int) -> None:
        filled = np.zeros(volume.shape[1:], dtype=np.uint8)
        for rings, step in outlines:
            moved = [np.rint((ring + step * number) * 2**SHIFT).astype(np.int32) for ring in rings]
            filled[:] = 0
            cv2.fillPoly(filled, moved, 1, shift=SHIFT)
            volume[number] += filled

    in_parallel(work, range(len(volume)))
