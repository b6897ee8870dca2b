"""What a user could pick instead: each peer in its own idiomatic way.

Every module has one function `votes(task, planes)` that returns the votes (planes, ny, nz) of
some planes along x.
"""

import importlib
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.benchmarks.workload import Task

Votes = Callable[[Task, NDArray[np.int64]], NDArray[Any]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Peer:
    """Something that can be used in the engine's place.

    Attributes:
        name: as shown.
        module: its module in this package.
        needs: the distribution it needs, or the program if `is_program`.
        is_program: whether it needs a program instead of a distribution.
        whole_only: whether it cannot do some planes alone.
        hull_only: whether it carves without counting; it then returns all votes or none.
        most_voxels: beyond which it would not fit into ordinary memory.
    """

    name: str
    module: str
    needs: str
    is_program: bool = False
    whole_only: bool = False
    hull_only: bool = False
    most_voxels: int = 2**31

    @property
    def version(self) -> str | None:
        """The installed version, or the program's path; None if it cannot be used."""
        if self.is_program:
            return shutil.which(self.needs)
        try:
            # What is installed may lack something of its own, as Open3D without dash does.
            self.function()
            return version(self.needs)
        except (ImportError, PackageNotFoundError):
            return None

    def function(self) -> Votes:
        """Return the function that computes its votes."""
        votes: Votes = importlib.import_module(f"{__name__}.{self.module}").votes
        return votes


PEERS = (
    Peer(name="Octave inpolygon", module="octave", needs="octave", is_program=True),
    Peer(name="matplotlib Path", module="matplotlib_path", needs="matplotlib"),
    Peer(name="shapely", module="shapely_points", needs="shapely"),
    Peer(name="NumPy mask", module="numpy_mask", needs="numpy"),
    Peer(name="torch grid_sample", module="torch_sample", needs="torch"),
    Peer(
        name="Open3D carve_silhouette",
        module="open3d_carve",
        needs="open3d",
        whole_only=True,
        hull_only=True,
        most_voxels=2**25,
    ),
    Peer(name="numba mask", module="numba_mask", needs="numba"),
    Peer(name="OpenCV warpAffine", module="opencv_warp", needs="opencv-python-headless"),
    Peer(name="JAX mask", module="jax_mask", needs="jax"),
    Peer(
        name="OpenCV fillPoly",
        module="opencv_fill",
        needs="opencv-python-headless",
        whole_only=True,
    ),
    Peer(name="blocks with summed-area tables", module="blocks", needs="numba", whole_only=True),
)
