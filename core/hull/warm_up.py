"""Compiling the engine's kernels, so that nobody waits for them in the middle of their work.

The compiled kernels are kept on disk. The first run on a machine takes some fifteen seconds, every
later one half a second. `python -m core.hull.warm_up` does it in a process of its own, beside one
that has better things to do.
"""

from collections.abc import Callable

import numpy as np

from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.view import View
from core.hull.volume import VoteVolume
from core.silhouettes.silhouette import Silhouette


def compile_kernels(
    progress: Callable[[str, int, int], None] = lambda _stage, _done, _total: None,
) -> None:
    """Carve, edit and mesh a small box by every kernel, so that all of them are compiled.

    Args:
        progress: told of stage, steps done and steps in all.
    """
    volume = VoteVolume(VoxelGrid.cube(side_m=4.0, spacing_m=0.5))
    steps: tuple[Callable[[], object], ...] = (
        lambda: volume.add_many([_box_view(axis, 1.3) for axis in range(3)]),
        volume.surface,
        lambda: volume.replace(1, _box_view(1, 0.9)),
        volume.surface,
        lambda: volume.reprojection(0),
        volume.blame,
    )
    for done, step in enumerate(steps, start=1):
        step()
        progress("preparing the engine", done, len(steps))


def _box_view(axis: int, half_m: float) -> View:
    """Return a cube's outline seen along an axis, 10 pixels per metre."""
    matrix = np.zeros((2, 4))
    matrix[[0, 1], [other for other in range(3) if other != axis]] = 10
    matrix[:, 3] = 32
    ring = 32 + 10 * half_m * np.array([[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]])
    silhouette = Silhouette(rings=(ring,), image_shape=(64, 64), claim="complete")
    return View(silhouette=silhouette, projection=Projection(matrix=matrix))


if __name__ == "__main__":
    compile_kernels()
