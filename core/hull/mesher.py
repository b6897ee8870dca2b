"""The exact surface of a vote volume, meshed in slabs that are kept while nothing in them changes.

Marching cubes finds which grid edges the hull's boundary crosses; each vertex is then moved along
its grid edge to where the boundary really is.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.changes import changed_edges
from core.hull.closed_mesh import Surface
from core.hull.crossings import CrossingTables, any_within, cross_grid_edges
from core.hull.cube_cases import edge_tables, triangle_table
from core.hull.edge_cells import EdgeCells, longest_grid_edge_px
from core.hull.slab_mesh import mesh_slab
from core.hull.threads import in_parallel
from core.hull.votes import Voter, Votes, VoteVolume

SLAB_PLANES = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Slab:
    """The mesh of some planes.

    Attributes:
        vertices: (vertices, 3) in voxel indices.
        faces: (faces, 3) numbers of this slab's vertices, continued into the next slab's.
    """

    vertices: Floats
    faces: NDArray[np.int32]


class SurfaceMesher:
    """Keeps the exact surface of a volume up to date, at its own threshold.

    Only slabs in which the hull or an outline that bounds it changed are meshed again; the result
    equals meshing from scratch, number by number.
    """

    def __init__(self, volume: VoteVolume) -> None:
        """Watch a volume; nothing is meshed yet."""
        self._volume = volume
        self._slabs: list[Slab | None] = [None] * len(slab_layers(volume.grid))
        self._voters: dict[int, Voter] = {}
        self._cells: dict[int, EdgeCells] = {}
        self._threshold = 0
        self._revision = -1

    def surface(self) -> Surface:
        """Return the hull's surface as the volume stands now.

        Raises:
            ValueError: no views vote.
        """
        with self._volume.reading():
            threshold = self._volume.checked_threshold(self._volume.threshold)
            voters = voting(self._volume)
            self._forget_changed(voters, threshold)
            self._mesh_missing(voters, threshold)
            self._voters, self._threshold = voters, threshold
            self._revision = self._volume.revision
        return joined_surface([slab for slab in self._slabs if slab], self._volume.grid)

    def _forget_changed(self, voters: dict[int, Voter], threshold: int) -> None:
        """Drop the slabs that the changes since the last surface could have touched."""
        if voters.keys() != self._voters.keys() or threshold != self._threshold:
            self._slabs = [None] * len(self._slabs)
            return
        flipped = self._volume.planes_changed_since(self._revision)
        replaced = [n for n, voter in voters.items() if voter is not self._voters[n]]
        for number, (first, last) in enumerate(slab_layers(self._volume.grid)):
            if flipped[max(first, 0) : last + 1].any():
                self._slabs[number] = None
        for number in replaced:
            self._forget_near(self._voters[number], voters[number])

    def _forget_near(self, old: Voter, new: Voter) -> None:
        """Drop the slabs that have a vertex near what changed of an outline."""
        if not np.array_equal(old.to_image, new.to_image):
            self._slabs = [None] * len(self._slabs)
            return
        points = changed_edges(old.outline, new.outline)[0]
        if len(points) == 0:
            return
        reach = longest_grid_edge_px(new.to_image, self._volume.grid)
        low, high = points.min(axis=0) - reach, points.max(axis=0) + reach
        for number, slab in enumerate(self._slabs):
            if slab and any_within(slab.vertices, new.to_image, low, high):
                self._slabs[number] = None

    def _mesh_missing(self, voters: dict[int, Voter], threshold: int) -> None:
        missing = [number for number, slab in enumerate(self._slabs) if slab is None]
        if not missing:
            return
        kept = {
            n: cells for n, cells in self._cells.items() if voters.get(n) is self._voters.get(n)
        }
        new = [n for n in voters if n not in kept]
        made = in_parallel(lambda n: cells_of(voters[n], self._volume.grid), new)
        self._cells = {**kept, **dict(zip(new, made, strict=True))}
        tables = tables_of(voters, self._cells)
        layers = slab_layers(self._volume.grid)
        votes = self._volume.votes

        def work(number: int) -> Slab:
            return exact_slab(votes, threshold, layers[number], tables)

        for number, slab in zip(missing, in_parallel(work, missing), strict=True):
            self._slabs[number] = slab


def meshed(volume: VoteVolume, threshold: int | None = None) -> Surface:
    """Return the exact surface from scratch, by default at the volume's own threshold.

    Raises:
        ValueError: no views, or a threshold outside 1 … number of views.
    """
    with volume.reading():
        limit = volume.checked_threshold(volume.threshold if threshold is None else threshold)
        voters = voting(volume)
        cells = in_parallel(lambda voter: cells_of(voter, volume.grid), voters.values())
        tables = tables_of(voters, dict(zip(voters, cells, strict=True)))

        def work(layers: tuple[int, int]) -> Slab:
            return exact_slab(volume.votes, limit, layers, tables)

        return joined_surface(in_parallel(work, slab_layers(volume.grid)), volume.grid)


def slab_layers(grid: VoxelGrid) -> list[tuple[int, int]]:
    """Return the layers (first, past the last) of each slab; layer x lies past plane x."""
    starts = range(-1, grid.shape[0], SLAB_PLANES)
    return [(start, min(start + SLAB_PLANES, grid.shape[0])) for start in starts]


def voting(volume: VoteVolume) -> dict[int, Voter]:
    """Return the views of a volume that vote, by number."""
    return {number: voter for number, voter in volume.voters.items() if voter.votes}


def cells_of(voter: Voter, grid: VoxelGrid) -> EdgeCells:
    """Return a voter's outline sorted into cells."""
    return EdgeCells.of(voter.outline, voter.to_image, grid)


def tables_of(voters: Mapping[int, Voter], cells: Mapping[int, EdgeCells]) -> CrossingTables:
    """Return the crossing tables of voters, in the order of their numbers."""
    return CrossingTables.of(
        [voter.to_image for voter in voters.values()],
        [voter.outline for voter in voters.values()],
        [cells[number] for number in voters],
    )


def exact_slab(
    votes: Votes,
    threshold: int,
    layers: tuple[int, int],
    tables: CrossingTables,
    low: tuple[int, int, int] = (0, 0, 0),
) -> Slab:
    """Return one slab's mesh with every vertex where the hull's boundary is.

    The votes may be those of a window that begins at voxel `low` and in which layers are counted.
    """
    crossed, faces = mesh_slab(votes, threshold, *layers, triangle_table(), edge_tables())
    vertices, _ = cross_grid_edges(
        crossed,
        votes,
        np.array(low),
        threshold,
        tables.to_image,
        tables.points,
        tables.cell_maps,
        tables.starts,
        tables.edges,
        tables.lines,
    )
    return Slab(vertices=vertices, faces=faces)


def joined_surface(slabs: list[Slab], grid: VoxelGrid) -> Surface:
    """Return consecutive slabs as one surface in metres."""
    vertex_ends = np.cumsum([0] + [len(slab.vertices) for slab in slabs])
    face_ends = np.cumsum([0] + [len(slab.faces) for slab in slabs])
    vertices_m = np.empty((vertex_ends[-1], 3))
    faces = np.empty((face_ends[-1], 3), dtype=np.int32)

    def write(number: int) -> None:
        base = vertex_ends[number]
        own = vertices_m[base : vertex_ends[number + 1]]
        np.multiply(slabs[number].vertices, grid.spacing_m, out=own)
        own += grid.origin_m
        joined = faces[face_ends[number] : face_ends[number + 1]]
        np.add(slabs[number].faces, np.int32(base), out=joined)

    in_parallel(write, range(len(slabs)))
    # Given away read-only, the arrays need not be copied.
    vertices_m.flags.writeable = faces.flags.writeable = False
    return Surface(vertices_m=vertices_m, faces=faces)
