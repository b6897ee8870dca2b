"""The hull as an analysis tells of it: numbers that belong to one revision of it."""

from dataclasses import dataclass

from core.arrays import Floats
from core.hull.emptying import emptied_by
from core.hull.surface import Surface
from core.hull.volume import VoteVolume
from core.measurement.extents import Extent
from core.measurement.lines import LineMeasurement
from core.measurement.observability import Grade, observability
from core.reconstruction import measures_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Hull:
    """All that is known of a hull but its surface.

    Attributes:
        revision: grows with every change of the hull.
        frames: how many frames had come.
        voting: how many of them vote.
        threshold: votes that a voxel of it has at least, 0 while nothing votes.
        is_preview: whether it is a coarser one, of an outline that has not been committed.
        extents: along x, y, z; empty when the hull is.
        lines: principal lines; empty while an extent is open.
        line_grades: how well the views constrain each of the lines.
        unobserved: (3,) direction that no voting frame constrains, or None.
        vertex_count, face_count: of its surface.
        volume_m3: that it encloses.
        emptied_by: numbers of the frames that emptied it; empty unless the hull is.
    """

    revision: int
    frames: int
    voting: int
    threshold: int
    is_preview: bool
    extents: tuple[Extent, ...]
    lines: tuple[LineMeasurement, ...]
    unobserved: Floats | None
    vertex_count: int
    face_count: int
    volume_m3: float
    emptied_by: tuple[int, ...] = ()
    line_grades: tuple[Grade, ...] = ()


def hull_of(volume: VoteVolume, surface: Surface, *, revision: int, is_preview: bool) -> Hull:
    """Measure the hull of a volume whose views are numbered as the frames are, less one."""
    voters = volume.voters
    views = [voter.view for voter in voters.values() if voter.votes]
    measures = measures_of(surface, volume.grid, views)
    seen = observability(views) if measures.lines else None
    return Hull(
        revision=revision,
        frames=len(voters),
        voting=len(views),
        threshold=volume.threshold or 0,
        is_preview=is_preview,
        extents=measures.extents,
        lines=measures.lines,
        unobserved=measures.unobserved,
        vertex_count=len(surface.vertices_m),
        face_count=len(surface.faces),
        volume_m3=surface.volume_m3(),
        emptied_by=tuple(n + 1 for n in emptied_by(volume)) if surface.is_empty else (),
        line_grades=()
        if seen is None
        else tuple(seen.grade(line.direction) for line in measures.lines),
    )
