"""A hull's exact surface without its votes: slab after slab is voted on, meshed and forgotten.

Memory holds the mesh and, for each thread, one slab of the region in which the hull can lie.
"""

from collections.abc import Iterable
from contextlib import closing

import numpy as np

from core.geometry.grid import VoxelGrid
from core.hull.casting import UNWATCHED, Cancelled, Watch
from core.hull.closed_mesh import Surface
from core.hull.cube_cases import edge_tables, triangle_table
from core.hull.mesher import SlabMesh, cells_of, exact_vertices, joined_surface, tables_of
from core.hull.plane_votes import PlaneVoter, Window
from core.hull.region import regions_of_interest
from core.hull.slab_mesh import mesh_slab
from core.hull.threads import in_parallel, one_after_another
from core.hull.view import View
from core.hull.votes import Voter, checked_threshold

SLAB_PLANES = 16
"""A slab's last plane is voted on again by the next one: few planes cost time, many memory."""

EMPTY_SLAB = SlabMesh(vertices=np.empty((0, 3)), faces=np.empty((0, 3), dtype=np.int32))


def carved_surface(
    views: Iterable[View],
    grid: VoxelGrid,
    threshold: int | None = None,
    watch: Watch = UNWATCHED,
) -> Surface:
    """Return the exact surface of the hull with at least `threshold` votes, storing no volume.

    It is what `hull_surface` makes of a `VoteVolume` of the same views, number by number.

    Args:
        views: that vote.
        grid: where; it may hold more voxels than a volume could.
        threshold: votes that a voxel of the hull has at least; by default those of all views.
        watch: is told how many slabs are done, and may cancel before each.

    Raises:
        ValueError: no views, a threshold outside 1 … number of views, an outline without area, or
            a camera that stands in the grid.
        Cancelled: `watch` said so.
    """
    voters = in_parallel(lambda view: Voter.of(view, grid), views)
    limit = checked_threshold(threshold, len(voters))
    numbers = dict(enumerate(voters))
    cells = dict(enumerate(in_parallel(lambda voter: cells_of(voter, grid), voters)))
    tables, votes = tables_of(numbers, cells), PlaneVoter.of(voters)
    ends = [*range(0, grid.shape[0] - 1, SLAB_PLANES), grid.shape[0] - 1]
    windows = regions_of_interest(voters, grid, limit, np.array(ends))

    def work(window: Window | None) -> SlabMesh:
        if window is None or watch.cancel():
            return EMPTY_SLAB
        held, low = votes.votes(window), window.low.tolist()
        layers = _layers(window, grid)
        crossed, faces = mesh_slab(held, limit, *layers, triangle_table(), edge_tables())
        vertices = exact_vertices(crossed, held, limit, tables, (low[0], low[1], low[2]))
        return SlabMesh(vertices=vertices, faces=faces)

    slabs = []
    with closing(one_after_another(work, windows)) as made:
        for slab in made:
            slabs.append(slab)
            if watch.cancel():
                raise Cancelled(
                    f"Carving was cancelled after {len(slabs)} of {len(windows)} slabs."
                )
            watch.progress(len(slabs), len(windows))
    return joined_surface(slabs, grid)


def _layers(window: Window, grid: VoxelGrid) -> tuple[int, int]:
    """Return a window's layers, those outside the grid's first and last plane included."""
    first, planes = int(window.low[0]), window.shape[0]
    return -1 if first == 0 else 0, planes if first + planes == grid.shape[0] else planes - 1
