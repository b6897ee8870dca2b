"""`radarhull reconstruct`."""

import json as json_text
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from app.commands.console import progress_bars, show_table, write_text
from app.commands.serve import pass_source
from core.experiments.results import Table
from core.formats.surfaces import write_surface
from core.reconstruction import ReconstructionSettings, Step
from core.reconstruction import reconstruct as reconstruct_frames


def reconstruct(
    pass_files: Annotated[tuple[Path, ...], tyro.conf.Positional],
    /,
    *,
    out: Path | None = None,
    json: str | None = None,
    rule: Literal["shadow", "strict"] = "shadow",
    tolerated_misses: int = 0,
    register_centroids: bool = False,
    spacing_m: float = 0.15,
    side_m: float = 21.0,
) -> None:
    """Carve the hull of one or more passes and print its extents.

    Args:
        pass_files: pass files with frames or echoes; all vote together.
        out: write the hull's surface here (.glb, .ply or .stl), metres, target frame.
        json: write extents and settings as JSON to this file, or to standard output for "-".
        rule: "shadow" carves nothing behind a frame's first return; "strict" is the paper's rule.
        tolerated_misses: views that may miss a voxel of the hull; 0 lets every view carve.
        register_centroids: shift every frame's silhouette to a common centroid (the paper's
            III.D), for frames with unknown offsets.
        spacing_m: voxel spacing, metres.
        side_m: side of the cubic grid, metres.
    """
    sources = [pass_source(path) for path in pass_files]
    settings = ReconstructionSettings(
        spacing_m=spacing_m,
        side_m=side_m,
        rule=rule,
        tolerated_misses=tolerated_misses,
        registers_centroids=register_centroids,
    )
    total = sum(source.expected_frames or 0 for source in sources)
    every_frame = (frame for source in sources for frame in source.frames())
    last: Step | None = None
    with progress_bars() as report:
        for last in reconstruct_frames(every_frame, settings):
            report("frames", last.number, max(total, last.number))
    if last is None or last.number < 2:
        raise ValueError("A hull needs at least 2 views; the passes hold fewer frames.")
    if last.surface.is_empty:
        raise ValueError(
            f"The hull of {last.number} views is empty: no voxel has {last.threshold} votes. "
            "Allow --tolerated-misses, or check the frames' registration."
        )
    if out is not None:
        write_surface(out, last.surface)
    if json is not None:
        write_text(json, json_text.dumps(_facts(last, settings, pass_files), indent=2))
    if json != "-":
        show_table(_extents_table(last))


def _facts(step: Step, settings: ReconstructionSettings, files: Sequence[Path]) -> dict[str, Any]:
    return {
        "passes": [path.name for path in files],
        "views": step.number,
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
    }


def _extents_table(step: Step) -> Table:
    rows = [
        (extent.name, f"{extent.value_m:.2f} m" if extent.is_bounded else "not bounded")
        for extent in step.extents
    ]
    if _all_bounded(step):
        rows.append(("volume", f"{step.surface.volume_m3():.1f} m³"))
    if step.unobserved is not None:
        x, y, z = step.unobserved
        rows.append(("unobserved direction", f"({x:+.2f}, {y:+.2f}, {z:+.2f})"))
    return Table(
        title=f"Hull of {step.number} views, {step.threshold} votes",
        columns=("extent", "value"),
        rows=tuple(rows),
    )


def _all_bounded(step: Step) -> bool:
    return all(extent.is_bounded for extent in step.extents)
