"""A closed triangle mesh in true metres."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats, frozen


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Surface:
    """A closed triangle mesh.

    Attributes:
        vertices_m: (vertices, 3), target frame.
        faces: (faces, 3) vertex indices, counter-clockwise as seen from outside.
    """

    vertices_m: Floats
    faces: NDArray[np.int32]

    def __post_init__(self) -> None:
        vertices = frozen(self.vertices_m, np.float64, (None, 3), "Surface vertices")
        object.__setattr__(self, "vertices_m", vertices)
        object.__setattr__(self, "faces", frozen(self.faces, np.int32, (None, 3), "Surface faces"))

    @property
    def is_empty(self) -> bool:
        """Whether there is no surface at all."""
        return len(self.faces) == 0

    def volume_m3(self) -> float:
        """Return the enclosed volume in cubic metres."""
        a, b, c = (self.vertices_m[self.faces[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)
