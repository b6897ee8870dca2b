"""`radarhull reconstruct`."""

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from app.commands.console import progress_bars, show_table
from app.commands.options import DEFAULT_CARVING, CarvingOptions, JsonTo, OptionalFile
from app.commands.outputs import STANDARD_OUTPUT, checked_json, write_json
from app.source import Source
from app.sources import MIN_VIEWS, pass_sources
from core.arrays import Floats
from core.experiments.results import Table
from core.formats.files import checked_output
from core.formats.surfaces import SUFFIXES, write_surface
from core.hull.warm_up import compile_kernels
from core.reconstruction import ReconstructionSettings, Step
from core.reconstruction import reconstruct as reconstruct_frames
from core.registration.wander import Wander


def reconstruct(
    pass_files: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="PASS...")],
    /,
    *,
    out: OptionalFile = None,
    json: JsonTo = None,
    carving: CarvingOptions = DEFAULT_CARVING,
) -> None:
    """Carve the hull of one or more passes and print its extents.

    Args:
        pass_files: pass files with frames or echoes; all vote together.
        out: write the hull's surface here (.glb, .ply or .stl), metres, target frame.
        json: write extents and settings as JSON to this file, or to standard output for "-".
        carving: how the hull is carved.
    """
    settings = carving.settings()
    checked_json(json)
    if out is not None:
        checked_output(out, SUFFIXES)
    last, notes, wander = _carved(pass_sources(pass_files), settings)
    for note in notes:
        print(f"radarhull: note: {note}.", file=sys.stderr)
    _check_hull(last)
    if out is not None:
        write_surface(out, last.surface)
    if json is not None:
        write_json(json, _facts(last, settings, pass_files, notes, wander))
    if json != STANDARD_OUTPUT:
        show_table(_extents_table(last))
        if settings.registration != "none":
            print(wander.sentence())


def _carved(
    sources: Sequence[Source], settings: ReconstructionSettings
) -> tuple[Step, tuple[str, ...], Wander]:
    """Return the last step, what every frame left to note, and the offsets of those that vote."""
    total = sum(source.expected_frames or 0 for source in sources)
    every_frame = (frame for source in sources for frame in source.frames())
    notes: list[str] = []
    offsets: dict[int, Floats] = {}
    with progress_bars() as report:
        compile_kernels(report)
        for step in reconstruct_frames(every_frame, settings):
            report("frames", step.number, max(total, step.number))
            notes += [step.note] if step.note else []
            if step.offset_px is not None and not step.note:
                offsets[step.number] = step.offset_px
    wander = Wander(
        frame_numbers=np.array(list(offsets), dtype=np.int64),
        offsets_px=np.array(list(offsets.values())).reshape(-1, 2),
    )
    return step, tuple(notes), wander


def _check_hull(step: Step) -> None:
    if step.voting < MIN_VIEWS:
        raise ValueError(
            f"A hull needs at least {MIN_VIEWS} views; {step.voting} of {step.number} frames show "
            "a target."
        )
    if step.surface.is_empty:
        raise ValueError(
            f"The hull of {step.voting} views is empty: no voxel has {step.threshold} votes. "
            "Allow --tolerated-misses, or check the frames' registration."
        )


def _facts(
    step: Step,
    settings: ReconstructionSettings,
    files: Sequence[Path],
    notes: Sequence[str],
    wander: Wander,
) -> dict[str, Any]:
    return {
        "passes": [path.name for path in files],
        "frames": step.number,
        "views": step.voting,
        "threshold": step.threshold,
        "rule": settings.rule,
        "spacing_m": settings.spacing_m,
        "volume_m3": step.surface.volume_m3() if _all_bounded(step) else None,
        "unobserved_direction": None if step.unobserved is None else step.unobserved.tolist(),
        "extents": [
            {
                "name": extent.name,
                "value_m": extent.value_m if extent.is_bounded else None,
                "direction": extent.direction.tolist(),
            }
            for extent in step.extents
        ],
        "lines": [
            {"name": line.name, "length_m": line.length_m, "direction": line.direction.tolist()}
            for line in step.lines
        ],
        "registration": _registration_facts(settings, wander),
        "notes": list(notes),
    }


def _registration_facts(settings: ReconstructionSettings, wander: Wander) -> dict[str, Any] | None:
    if settings.registration == "none":
        return None
    columns = zip(wander.frame_numbers, wander.offsets_px, wander.jumps_px, strict=True)
    return {
        "rule": settings.registration,
        "drift_px_per_frame": wander.drift_px_per_frame.tolist(),
        "frames": [
            {"frame": int(frame), "offset_px": offset.tolist(), "jump_px": float(jump)}
            for frame, offset, jump in columns
        ],
    }


def _extents_table(step: Step) -> Table:
    return Table(
        title=f"Hull of {step.voting} views, {step.threshold} votes",
        columns=("extent", "value", "attitude"),
        rows=tuple(_rows(step)),
    )


def _rows(step: Step) -> Iterator[tuple[str, str, str]]:
    for extent in step.extents:
        value = f"{extent.value_m:.2f} m" if extent.is_bounded else "not bounded"
        yield extent.name, value, ""
    for line in step.lines:
        yield line.name, f"{line.length_m:.2f} m", _vector(line.direction)
    if _all_bounded(step):
        yield "volume", f"{step.surface.volume_m3():.1f} m³", ""
    if step.unobserved is not None:
        yield "unobserved direction", "", _vector(step.unobserved)


def _vector(direction: Floats) -> str:
    x, y, z = direction
    return f"({x:+.2f}, {y:+.2f}, {z:+.2f})"


def _all_bounded(step: Step) -> bool:
    return all(extent.is_bounded for extent in step.extents)
