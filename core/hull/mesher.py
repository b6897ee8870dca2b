"""The exact surface of a vote volume, meshed in slabs that are kept while nothing in them changes.

Marching cubes finds which grid edges the hull's boundary crosses; each vertex is then moved along
its grid edge to where the boundary really is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.changes import changed_edges
from core.hull.closed_mesh import Surface
from core.hull.crossing_tables import CrossingTables
from core.hull.crossings import cross_grid_edges
from core.hull.cube_cases import edge_tables, triangle_table
from core.hull.edge_cells import EdgeCells
from core.hull.kept_crossings import ChangedEdges, any_near, end_misses, kept_crossings
from core.hull.outline import Outline
from core.hull.slab_mesh import mesh_slab
from core.hull.threads import in_parallel
from core.hull.votes import VoteCounts, Voter, Votes

SLAB_PLANES = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SlabMesh:
    """The mesh of some planes.

    Attributes:
        vertices: (vertices, 3) in voxel indices, one on each crossed grid edge.
        faces: (faces, 3) numbers of this slab's vertices, continued into the next slab's.
    """

    vertices: Floats
    faces: NDArray[np.int32]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Slab(SlabMesh):
    """The mesh of some planes, and what tells later which of it an edit moves.

    Attributes:
        crossed: (vertices, 4) the grid edges, as `mesh_slab` returns them.
        ends: (vertices, 2) views that miss their ends, as `end_misses` returns them.
    """

    crossed: NDArray[np.int32]
    ends: NDArray[np.uint16]


class SurfaceMesher:
    """Keeps the exact surface of a volume up to date, at its own threshold.

    Only slabs in which the hull or an outline that bounds it changed are meshed again; the result
    equals meshing from scratch, number by number.
    """

    def __init__(self, volume: VoteCounts) -> None:
        """Watch a volume; nothing is meshed yet."""
        self._volume = volume
        self._grid = volume.grid
        self._slabs: list[Slab | None] = [None] * len(slab_layers(volume.grid))
        self._voters: dict[int, Voter] = {}
        self._cells: dict[int, EdgeCells] = {}
        self._tolerance = -1
        self._revision = -1

    def surface(self) -> Surface:
        """Return the hull's surface as the volume stands now.

        Raises:
            ValueError: no views vote.
        """
        with self._volume.reading():
            threshold = self._volume.checked_threshold(self._volume.threshold)
            voters = voting(self._volume)
            before = list(self._slabs)
            changes = self._changes(voters, len(voters) - threshold)
            self._forget_changed(changes)
            # Also where no slab is meshed again now: a later edit will ask for them.
            for number in [n for n in self._cells if voters.get(n) is not self._voters.get(n)]:
                del self._cells[number]
            self._mesh_missing(voters, threshold, before, changes)
            self._voters, self._tolerance = voters, len(voters) - threshold
            self._revision = self._volume.revision
            slabs = [slab for slab in self._slabs if slab]
        return joined_surface(slabs, self._grid)

    def _changes(self, voters: dict[int, Voter], tolerance: int) -> list[ChangedEdges] | None:
        """Return the outline edges that came or went, None if more or fewer misses count now."""
        if tolerance != self._tolerance:
            return None
        changes = []
        for number in voters.keys() | self._voters.keys():
            old, new = self._voters.get(number), voters.get(number)
            if old is not new:
                changes += self._view_changes(number, old, new)
        return changes

    def _view_changes(
        self, number: int, old: Voter | None, new: Voter | None
    ) -> list[ChangedEdges]:
        """Return a view's edges that came or went: all of them if it moved, came or went itself."""
        if old and new and np.array_equal(old.to_image, new.to_image):
            points, offsets, _ = changed_edges(old.outline, new.outline)
            cells = EdgeCells.of(Outline(points=points, offsets=offsets), new.to_image, self._grid)
            return [ChangedEdges.of(cells, new.to_image)]
        changes = []
        if old:
            # Not at hand where the view's last change touched no slab.
            cells = self._cells[number] if number in self._cells else cells_of(old, self._grid)
            changes.append(ChangedEdges.of(cells, old.to_image))
        if new:
            changes.append(ChangedEdges.of(cells_of(new, self._grid), new.to_image))
        return changes

    def _forget_changed(self, changes: list[ChangedEdges] | None) -> None:
        """Drop the slabs that the changes since the last surface could have touched."""
        if changes is None:
            self._slabs = [None] * len(self._slabs)
            return
        flipped = self._volume.planes_changed_since(self._revision)
        for number, (first, last) in enumerate(slab_layers(self._grid)):
            slab = self._slabs[number]
            if flipped[max(first, 0) : last + 1].any() or (
                slab is not None and any_near(slab.crossed, changes)
            ):
                self._slabs[number] = None

    def _mesh_missing(
        self,
        voters: dict[int, Voter],
        threshold: int,
        before: list[Slab | None],
        changes: list[ChangedEdges] | None,
    ) -> None:
        missing = [number for number, slab in enumerate(self._slabs) if slab is None]
        if not missing:
            return
        new = [n for n in voters if n not in self._cells]
        made = in_parallel(lambda n: cells_of(voters[n], self._grid), new)
        self._cells.update(zip(new, made, strict=True))
        tables = tables_of(voters, self._cells)
        layers = slab_layers(self._grid)
        votes = self._volume.votes

        def work(number: int) -> Slab:
            old = before[number]
            if old is None or changes is None:
                return exact_slab(votes, threshold, layers[number], tables)
            return renewed_slab(votes, threshold, layers[number], tables, old, changes)

        for number, slab in zip(missing, in_parallel(work, missing), strict=True):
            self._slabs[number] = slab


def meshed(volume: VoteCounts, threshold: int | None = None) -> Surface:
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


def voting(volume: VoteCounts) -> dict[int, Voter]:
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
) -> Slab:
    """Return one slab's mesh with every vertex where the hull's boundary is."""
    crossed, faces = mesh_slab(votes, threshold, *layers, triangle_table(), edge_tables())
    vertices = exact_vertices(crossed, votes, threshold, tables)
    return Slab(
        vertices=vertices, faces=faces, crossed=crossed, ends=_misses(crossed, votes, tables)
    )


def renewed_slab(
    votes: Votes,
    threshold: int,
    layers: tuple[int, int],
    tables: CrossingTables,
    old: Slab,
    changes: Sequence[ChangedEdges],
) -> Slab:
    """Return what `exact_slab` does, but search only the crossings that are not as in `old`."""
    crossed, faces = mesh_slab(votes, threshold, *layers, triangle_table(), edge_tables())
    ends = _misses(crossed, votes, tables)
    kept = kept_crossings(crossed, ends, old.crossed, old.ends, changes)
    vertices = old.vertices[kept] if len(old.vertices) else np.empty((len(crossed), 3))
    sought = np.flatnonzero(kept < 0)
    vertices[sought] = exact_vertices(crossed[sought], votes, threshold, tables)
    return Slab(vertices=vertices, faces=faces, crossed=crossed, ends=ends)


def exact_vertices(
    crossed: NDArray[np.int32],
    votes: Votes,
    threshold: int,
    tables: CrossingTables,
    low: tuple[int, int, int] = (0, 0, 0),
) -> Floats:
    """Return where the hull's boundary crosses grid edges, (edges, 3) in the grid's voxel indices.

    The votes may be those of a window that begins at voxel `low` and in which edges are counted.
    """
    vertices: Floats = cross_grid_edges(
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
    )[0]
    return vertices


def _misses(crossed: NDArray[np.int32], votes: Votes, tables: CrossingTables) -> NDArray[np.uint16]:
    return end_misses(crossed, votes, len(tables.to_image))


def joined_surface(slabs: Sequence[SlabMesh], grid: VoxelGrid) -> Surface:
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
