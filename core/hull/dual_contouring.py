"""The exact surface with its creases: dual contouring of the crossings and their normals.

Every crossed grid edge knows where the hull's boundary passes it, and which outline edge of which
view it is there; that edge sweeps a plane. In each cube of voxels the vertex is put where the
planes of a sheet's crossings meet, so that edges and corners of the hull between the voxels are
kept, which snapped marching cubes cuts off.

Source: Ju et al., "Dual contouring of Hermite data", 2002; regularised instead of truncated; a
vertex for each sheet as in Schaefer et al., "Manifold dual contouring", 2007, and Wenger, 2013.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.closed_mesh import Surface
from core.hull.crossing_tables import CrossingTables
from core.hull.crossings import cross_grid_edges
from core.hull.cube_cases import edge_tables, triangle_table
from core.hull.dual_cases import sheet_table, twice_passed_table
from core.hull.dual_mesh import joined_faces, sheet_vertices, swept_normals
from core.hull.mesher import cells_of, slab_layers, tables_of, voting
from core.hull.slab_mesh import mesh_slab
from core.hull.threads import chunks, in_parallel
from core.hull.votes import VoteCounts, Votes

REGULARISATION = 0.1
"""How much a vertex is drawn to the mean of its crossings; 0.01 and less overshoots corners."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Crossings:
    """Where and how the hull's boundary passes the grid's edges.

    Attributes:
        crossed: (edges, 4) lower end's x, y, z and the axis, plus 4 if the lower end is inside.
        places: (edges, 3) in voxel indices.
        normals: (edges, 3) unit normals, of either sign.
    """

    crossed: NDArray[np.int32]
    places: Floats
    normals: Floats


def dual_surface(volume: VoteCounts, threshold: int | None = None) -> Surface:
    """Return the exact surface of the hull with at least `threshold` votes, creases included.

    A hull that reaches the grid's end is closed half a voxel outside. Every edge has two faces.

    Args:
        volume: the views and their votes.
        threshold: votes that a voxel has at least; by default the volume's own.

    Raises:
        ValueError: no views, or a threshold outside 1 … number of views.
    """
    with volume.reading():
        limit = volume.checked_threshold(volume.threshold if threshold is None else threshold)
        crossings = hull_crossings(volume, limit)
        return contoured(crossings, volume.votes, limit, volume.grid)


def hull_crossings(volume: VoteCounts, threshold: int) -> Crossings:
    """Return all crossings of the hull's boundary with grid edges, and its normals there."""
    voters = voting(volume)
    cells = in_parallel(lambda voter: cells_of(voter, volume.grid), voters.values())
    tables = tables_of(voters, dict(zip(voters, cells, strict=True)))

    def work(layers: tuple[int, int]) -> Crossings:
        return _slab_crossings(volume.votes, threshold, layers, tables)

    slabs = in_parallel(work, slab_layers(volume.grid))
    return Crossings(
        crossed=np.concatenate([slab.crossed for slab in slabs]),
        places=np.concatenate([slab.places for slab in slabs]),
        normals=np.concatenate([slab.normals for slab in slabs]),
    )


def _slab_crossings(
    votes: Votes, threshold: int, layers: tuple[int, int], tables: CrossingTables
) -> Crossings:
    # A table without triangles: only the crossed edges are wanted.
    none = np.zeros_like(triangle_table())
    crossed, _ = mesh_slab(votes, threshold, *layers, none, edge_tables())
    places, causes = cross_grid_edges(
        crossed,
        votes,
        np.zeros(3, dtype=np.int64),
        threshold,
        tables.to_image,
        tables.points,
        tables.cell_maps,
        tables.starts,
        tables.edges,
        tables.lines,
    )
    normals = np.empty_like(places)
    swept_normals(crossed, causes, tables.to_image, tables.points, normals)
    return Crossings(crossed=crossed, places=places, normals=normals)


def contoured(
    crossings: Crossings,
    votes: Votes,
    threshold: int,
    grid: VoxelGrid,
    *,
    regularisation: float = REGULARISATION,
) -> Surface:
    """Return the dual surface of crossings, as `hull_crossings` found them."""
    crossed, places = crossings.crossed, crossings.places
    groups = _groups(crossed, grid.shape[0])
    around = np.empty((len(crossed), 4), dtype=np.int32)

    def vertices_of(layers: tuple[int, int]) -> Floats:
        found: Floats = sheet_vertices(
            crossed,
            places,
            crossings.normals,
            groups,
            votes,
            threshold,
            *layers,
            sheet_table(),
            twice_passed_table(),
            regularisation,
            around,
        )
        return found

    layers = slab_layers(grid)
    slabs = in_parallel(vertices_of, layers)
    starts = np.cumsum([0] + [len(slab) for slab in slabs])
    bases = np.repeat(starts[:-1], [last - first for first, last in layers])
    vertices = np.concatenate(slabs)
    faces = np.empty((2 * len(crossed), 3), dtype=np.int32)

    def join(edges: tuple[int, int]) -> None:
        joined_faces(crossed, places, around, bases, vertices, *edges, faces)

    in_parallel(join, chunks(len(crossed)) if len(crossed) else [])
    return Surface(vertices_m=vertices * grid.spacing_m + grid.origin_m, faces=faces)


def _groups(crossed: NDArray[np.int32], planes: int) -> NDArray[np.int64]:
    """Return where each group of edges starts, as `sheet_vertices` asks."""
    key = 2 * (crossed[:, 0] + 1) + (crossed[:, 3] & 3 == 0)
    return np.searchsorted(key, np.arange(2 * planes + 4))
