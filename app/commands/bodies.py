"""What `radarhull measure` can be given: passes, whose hull is carved first, or a mesh."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from app.commands.console import progress_bars
from app.source import Source
from app.sources import MIN_VIEWS, pass_sources
from core.analysis.measured_body import Body, body_of_mesh, body_of_views
from core.formats.meshes import MESH_SUFFIXES, read_mesh
from core.hull.sunlight import carving_frame_view
from core.hull.surface import EMPTY_SURFACE
from core.hull.view import View
from core.hull.warm_up import compile_kernels
from core.reconstruction import ReconstructionSettings, reconstruct

MESH_NOTE = "a mesh is measured as it is: without views there are no intervals and no grades"
OPEN_MESH_NOTE = "the mesh is not closed, so that volume, sections and principal axes mean little"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FoundBody:
    """A body as files give it.

    Attributes:
        body: to be measured.
        notes: what a person should know of it, each a clause.
        epoch_utc: ISO 8601 time of the first pulse, empty where none is known.
    """

    body: Body
    notes: tuple[str, ...] = ()
    epoch_utc: str = ""


def body_of_files(files: Sequence[Path], settings: ReconstructionSettings) -> FoundBody:
    """Return the body of one mesh, or the hull that one or more passes carve together.

    Raises:
        ValueError: files that cannot be read, a mesh beside others, frames that cannot vote, fewer
            than two that do, or an empty hull.
    """
    if any(path.suffix.lower() in MESH_SUFFIXES for path in files):
        return _mesh(files)
    return _carved(pass_sources(files), settings)


def _mesh(files: Sequence[Path]) -> FoundBody:
    if len(files) > 1:
        names = ", ".join(path.name for path in files)
        raise ValueError(f"A mesh is measured alone, passes together; got {names}.")
    mesh = read_mesh(files[0])
    notes = (MESH_NOTE,) if mesh.is_watertight else (MESH_NOTE, OPEN_MESH_NOTE)
    return FoundBody(body=body_of_mesh(mesh), notes=notes)


def _carved(sources: Sequence[Source], settings: ReconstructionSettings) -> FoundBody:
    views, notes, count = _views(sources, settings)
    if len(views) < MIN_VIEWS:
        raise ValueError(
            f"A hull needs at least {MIN_VIEWS} views; {len(views)} of {count} frames show a "
            "target."
        )
    body = body_of_views(views, settings)
    if body.surface.is_empty:
        raise ValueError(
            f"The hull of {len(views)} views is empty: no voxel has {body.threshold} votes. "
            "Allow --tolerated-misses, or check the frames' registration."
        )
    epochs = (course.epoch_utc for source in sources for course in source.course())
    return FoundBody(
        body=body, notes=notes, epoch_utc=next((epoch for epoch in epochs if epoch), "")
    )


def _views(
    sources: Sequence[Source], settings: ReconstructionSettings
) -> tuple[list[View], tuple[str, ...], int]:
    total = sum(source.expected_frames or 0 for source in sources)
    every_frame = (frame for source in sources for frame in source.frames())
    views: list[View] = []
    notes: list[str] = []
    count = 0
    with progress_bars() as report:
        compile_kernels(report)
        # The hull is meshed once, at the end.
        for step in reconstruct(every_frame, settings, surface_of=lambda _volume: EMPTY_SURFACE):
            count = step.number
            report("frames", count, max(total, count))
            if step.note:
                notes.append(step.note)
                continue
            views.append(
                carving_frame_view(
                    step.frame, step.silhouette, settings.rule, depth_m=settings.side_m
                )
            )
    return views, tuple(notes), count
