"""The best that OpenCV and VTK's flying edges can do for a live edit.

Votes change where the old and the new outline, pulled back into a slice, differ: both are filled
inside the rectangle of what changed, and their difference is added. Only slabs of eight planes
that changed are meshed again. Votes are a raster's, and the mesh is the binary one.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

from core.arrays import Floats
from core.benchmarks.peers.opencv_fill import SHIFT, pulled_back, slice_axis, votes
from core.benchmarks.workload import Task
from core.hull.threads import in_parallel
from core.hull.view import View

SLAB = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mesh:
    """Vertices (n, 3) in voxel indices along z, y, x, and faces (n, 3)."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.int64]


class Rival:
    """Votes by OpenCV, kept up to date, and a mesh in slabs by flying edges."""

    def __init__(self, task: Task) -> None:
        """Count all votes; nothing is meshed yet."""
        self._views = list(task.views)
        self._to_image = task.to_image
        self._votes = votes(task, task.all_planes())
        count = task.grid.shape[0]
        self._layers = [(x, min(x + SLAB, count - 1)) for x in range(0, count - 1, SLAB)]
        self._slabs: list[Mesh | None] = [None] * len(self._layers)

    def replace(self, number: int, view: View) -> None:
        """Let a view vote with another outline."""
        to_image = self._to_image[number]
        axis = slice_axis(to_image)
        old, step = pulled_back(self._views[number].silhouette.rings, to_image, axis)
        new, _ = pulled_back(view.silhouette.rings, to_image, axis)
        changed = _changed_points(old, new)
        self._views[number] = view
        if len(changed) == 0:
            return
        low, high = changed.min(axis=0) - 2, changed.max(axis=0) + 2
        volume = np.moveaxis(self._votes, axis, 0)
        dirty = np.zeros(volume.shape[: 2 if axis else 1], dtype=bool)

        def work(at: int) -> None:
            shift = step * at
            first = np.maximum(np.floor(low + shift), 0).astype(int)
            last = np.minimum(np.ceil(high + shift) + 1, volume.shape[:0:-1]).astype(int)
            if (first >= last).any():
                return
            size = (int(last[1] - first[1]), int(last[0] - first[0]))
            target = volume[at, first[1] : last[1], first[0] : last[0]]
            before = target == len(self._views)
            target += _filled(new, shift - first, size)
            target -= _filled(old, shift - first, size)
            flipped = before != (target == len(self._views))
            if axis:
                dirty[at, first[1] : last[1]] = flipped.any(axis=1)
            else:
                dirty[at] = flipped.any()

        in_parallel(work, range(len(volume)))
        self._forget(np.flatnonzero(dirty.any(axis=0) if axis else dirty))

    def surface(self) -> Mesh:
        """Return the mesh of the voxels with all votes."""

        def work(number: int) -> None:
            if self._slabs[number] is None:
                self._slabs[number] = self._meshed(*self._layers[number])

        in_parallel(work, range(len(self._slabs)))
        slabs = [slab for slab in self._slabs if slab is not None]
        starts = np.cumsum([0] + [len(slab.vertices) for slab in slabs])
        return Mesh(
            vertices=np.concatenate([slab.vertices for slab in slabs]),
            faces=np.concatenate(
                [slab.faces + start for slab, start in zip(slabs, starts[:-1], strict=True)]
            ),
        )

    def _forget(self, planes: NDArray[np.int64]) -> None:
        for number, (first, last) in enumerate(self._layers):
            if ((planes >= first) & (planes <= last)).any():
                self._slabs[number] = None

    def _meshed(self, first: int, last: int) -> Mesh:
        box = np.ascontiguousarray(self._votes[first : last + 1])
        image = vtkImageData()
        image.SetDimensions(box.shape[2], box.shape[1], box.shape[0])
        image.SetOrigin(0.0, 0.0, float(first))
        image.GetPointData().SetScalars(numpy_to_vtk(box.ravel(), deep=False))
        edges = vtkFlyingEdges3D()
        edges.SetInputData(image)
        edges.ComputeNormalsOff()
        edges.ComputeScalarsOff()
        edges.SetValue(0, len(self._views) - 0.5)
        edges.Update()
        found = edges.GetOutput()
        if found.GetNumberOfPoints() == 0:
            return Mesh(vertices=np.empty((0, 3), np.float32), faces=np.empty((0, 3), np.int64))
        # Arrays of VTK's die with the filter.
        return Mesh(
            vertices=vtk_to_numpy(found.GetPoints().GetData()).copy(),
            faces=vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3).copy(),
        )


def _filled(rings: list[Floats], shift: Floats, size: tuple[int, int]) -> NDArray[np.uint8]:
    filled = np.zeros(size, dtype=np.uint8)
    moved = [np.rint((ring + shift) * 2**SHIFT).astype(np.int32) for ring in rings]
    cv2.fillPoly(filled, moved, 1, shift=SHIFT)
    return filled


def _changed_points(old: list[Floats], new: list[Floats]) -> Floats:
    """Return the points of all edges that are in one outline only."""
    before, after = (
        {tuple(edge) for ring in rings for edge in np.hstack([ring, np.roll(ring, -1, axis=0)])}
        for rings in (old, new)
    )
    changed: Floats = np.array(list(before ^ after)).reshape(-1, 2)
    return changed
