"""The vote volume: how many views see each voxel inside or on their silhouette.

A vote is the paper's test (eqs. 20 to 24) on the outline itself, never on a rasterised mask.
For a plane of voxels the silhouette is pulled back into the plane's own index coordinates, where
it is a polygon again; every directed edge then adds +1 or −1 at the first voxel past its crossing
with each grid line, and one running sum along the line gives the votes.
"""

import numba
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.geometry.grid import VoxelGrid
from core.hull.view import View

Votes = NDArray[np.uint16]

ON_TOLERANCE_VOXELS = 1e-7
"""A voxel centre this near to a crossing counts as on the outline, which is a vote (eq. 20)."""


class VoteVolume:
    """Votes of any number of views on one grid.

    One writer at a time; `votes` may be read while no view is being added.
    """

    def __init__(self, grid: VoxelGrid) -> None:
        """Start with no views and no votes on `grid`."""
        self.grid = grid
        self.view_count = 0
        self._votes: Votes = np.zeros(grid.shape, dtype=np.uint16)

    @property
    def votes(self) -> Votes:
        """(nx, ny, nz) uint16 votes per voxel, read-only."""
        view = self._votes.view()
        view.flags.writeable = False
        return view

    def add(self, view: View) -> None:
        """Let one more view vote.

        Raises:
            ValueError: a perspective camera stands inside the grid's slab of planes.
        """
        self._cast(view, 1)
        self.view_count += 1

    def remove(self, view: View) -> None:
        """Take back the votes of a view that was added before.

        Raises:
            ValueError: no view is left to remove.
        """
        if self.view_count == 0:
            raise ValueError("No view has been added, so none can be removed.")
        self._cast(view, -1)
        self.view_count -= 1

    def hull(self, threshold: int | None = None) -> NDArray[np.bool_]:
        """Return the voxels with at least `threshold` votes (eq. 25), by default all views'.

        Raises:
            ValueError: no views yet, or a threshold outside 1 … number of views.
        """
        inside: NDArray[np.bool_] = self._votes >= self.checked_threshold(threshold)
        return inside

    def checked_threshold(self, threshold: int | None) -> int:
        """Return the threshold, or the number of views for None, after checking it."""
        if self.view_count == 0:
            raise ValueError("No views have voted yet; add at least two views of the target.")
        if threshold is None:
            return self.view_count
        if not 1 <= threshold <= self.view_count:
            raise ValueError(
                f"The vote threshold must lie between 1 and the number of views, "
                f"{self.view_count}; got {threshold}."
            )
        return threshold

    def _cast(self, view: View, weight: int) -> None:
        if view.silhouette.is_empty:
            return
        axis = _sweep_axis(view)
        others = [other for other in range(3) if other != axis]
        swept = np.moveaxis(self._votes, axis, 0)
        starts, ends = _directed_edges(view.silhouette.rings)
        to_image = _homogeneous(view.projection.matrix) @ self.grid.index_to_target()
        pullbacks = np.empty((swept.shape[0], 3, 3))
        for plane in range(swept.shape[0]):
            columns = [to_image[:, others[0]], to_image[:, others[1]]]
            offset = to_image[:, axis] * plane + to_image[:, 3]
            pullbacks[plane] = np.linalg.inv(np.column_stack([*columns, offset]))
        if not view.projection.is_affine:
            _check_camera_outside(to_image, axis, swept.shape)
        _sweep(swept, pullbacks, starts, ends, weight)


def _homogeneous(matrix: Floats) -> Floats:
    return matrix if matrix.shape[0] == 3 else np.vstack([matrix, [0.0, 0.0, 0.0, 1.0]])


def _sweep_axis(view: View) -> int:
    """Return the grid axis nearest the viewing direction, whose planes the view maps best."""
    return int(np.argmax(np.abs(view.projection.viewing_direction())))


def _check_camera_outside(to_image: Floats, axis: int, shape: tuple[int, ...]) -> None:
    corners = np.array(np.meshgrid(*[(0, count - 1) for count in shape])).reshape(3, -1)
    index = np.empty_like(corners)
    index[[axis, *[other for other in range(3) if other != axis]]] = corners
    depth = to_image[2, :3] @ index + to_image[2, 3]
    if float(depth.min()) <= 0 < float(depth.max()) or float(depth.max()) <= 0:
        raise ValueError(
            "The camera of a perspective view must have the whole grid in front of it; "
            "make the grid smaller or check the camera matrix's sign."
        )


def _directed_edges(rings: tuple[Floats, ...]) -> tuple[Floats, Floats]:
    starts = np.concatenate(rings)
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    return starts, ends


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _sweep(
    swept: Votes, pullbacks: Floats, starts: Floats, ends: Floats, weight: int
) -> None:  # pragma: no cover - compiled
    """Add one view's votes, plane by plane, into `swept` (planes, lines, places)."""
    planes, lines, places = swept.shape
    crossings = np.zeros((lines, places + 1), dtype=np.int16)
    tail = np.empty_like(starts)
    head = np.empty_like(ends)
    for plane in range(planes):
        _pull_back(pullbacks[plane], starts, tail)
        _pull_back(pullbacks[plane], ends, head)
        first = max(0, int(np.ceil(max(tail[:, 0].min(), -1.0))))
        last = min(lines - 1, int(np.floor(min(tail[:, 0].max(), lines + 0.0))))
        if first > last:
            continue
        _mark_crossings(tail, head, first, last, crossings)
        for y in range(first, last + 1):
            inside = 0
            for z in range(places):
                inside += crossings[y, z]
                crossings[y, z] = 0
                if inside > 0:
                    swept[plane, y, z] += weight
            crossings[y, places] = 0


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _pull_back(matrix: Floats, image: Floats, plane: Floats) -> None:  # pragma: no cover - compiled
    """Map image points (n, 2) by a 3 × 3 homography into a plane's index coordinates (n, 2)."""
    for i in range(image.shape[0]):
        row, column = image[i]
        depth = matrix[2, 0] * row + matrix[2, 1] * column + matrix[2, 2]
        plane[i, 0] = (matrix[0, 0] * row + matrix[0, 1] * column + matrix[0, 2]) / depth
        plane[i, 1] = (matrix[1, 0] * row + matrix[1, 1] * column + matrix[1, 2]) / depth


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _mark_crossings(
    tail: Floats, head: Floats, first: int, last: int, crossings: NDArray[np.int16]
) -> None:  # pragma: no cover - compiled
    """Mark +1 where a line enters the polygon and −1 past where it leaves it.

    A mirrored pull-back swaps entering and leaving edges, so the sign of the polygon's area
    decides which is which. Edges are half-open along the lines' axis: a shared vertex counts once.
    """
    places = crossings.shape[1] - 1
    area = 0.0
    for e in range(tail.shape[0]):
        area += tail[e, 0] * head[e, 1] - head[e, 0] * tail[e, 1]
    for e in range(tail.shape[0]):
        a, b = tail[e, 0], head[e, 0]
        if a == b:
            continue
        start = max(first, int(np.ceil(max(min(a, b), first - 1.0))))
        stop = min(last, int(np.ceil(min(max(a, b), last + 1.0))) - 1)
        slope = (head[e, 1] - tail[e, 1]) / (b - a)
        enters = (b > a) == (area > 0)
        for y in range(start, stop + 1):
            place = min(max(tail[e, 1] + (y - a) * slope, -1.0), places + 0.0)
            if enters:
                crossings[y, max(int(np.ceil(place - ON_TOLERANCE_VOXELS)), 0)] += 1
            else:
                crossings[y, min(int(np.floor(place + ON_TOLERANCE_VOXELS)) + 1, places)] -= 1
