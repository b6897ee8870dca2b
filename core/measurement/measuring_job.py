"""What one measurement works on: a surface, and all that is known beside it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.arrays import Floats
from core.hull.closed_mesh import Surface
from core.measurement.anchors import Anchor, AnchorLost, resolve
from core.measurement.parts import Faces
from core.measurement.regions import Region, faces_of
from core.measurement.results import Lost, Measurement


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuringContext:
    """What measuring needs beside the surface.

    Attributes:
        revision: of the hull that the surface shows.
        threshold: votes that a voxel of the hull has at least.
        key_points: (3,) places by name, target frame.
        measured: results by name, for what is computed from other measurements.
    """

    revision: int = 0
    threshold: int = 0
    key_points: Mapping[str, Floats] = field(default_factory=dict)
    measured: Mapping[str, Measurement | Lost] = field(default_factory=dict)


PLAIN = MeasuringContext()


class NothingThereError(Exception):
    """The hull has no such place; the message is the reason."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """A surface and the context that it is measured in."""

    surface: Surface
    context: MeasuringContext

    def place(self, anchor: Anchor) -> Floats:
        """Return where an anchor lies on the surface, (3,).

        Raises:
            NothingThereError: nowhere.
        """
        found = resolve(anchor, self.surface, self.context.key_points)
        if isinstance(found, AnchorLost):
            raise NothingThereError(found.reason)
        return found

    def faces(self, region: Region) -> Faces:
        """Return the numbers of the faces that a region takes in.

        Raises:
            NothingThereError: none.
        """
        found = faces_of(region, self.surface)
        if isinstance(found, AnchorLost):
            raise NothingThereError(found.reason)
        return found

    def other(self, name: str) -> Measurement:
        """Return what another measurement found.

        Raises:
            NothingThereError: there is none of that name, or it is lost.
        """
        result = self.context.measured.get(name)
        if result is None:
            raise NothingThereError(f'There is no measurement "{name}".')
        if isinstance(result, Lost):
            raise NothingThereError(f'"{name}" is lost: {result.reason}')
        return result
