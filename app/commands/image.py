"""`radarhull image`."""

from pathlib import Path
from typing import Annotated

import tyro

from app.commands.console import progress_bars
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.radar.imaging import ImagingSettings, frame_count, frames


def image(
    pass_file: Annotated[Path, tyro.conf.Positional],
    out: Annotated[Path, tyro.conf.Positional],
    /,
    *,
    resolution_m: float = 0.15,
    overlap: float = 0.0,
    pixels: int = 512,
    pixel_spacing_m: float = 0.06,
) -> None:
    """Image the echoes of a pass file: divide them into coherent intervals, form the frames.

    Args:
        pass_file: pass file with echoes.
        out: pass file to write, with the echoes and their frames.
        resolution_m: wanted cross-range resolution, metres.
        overlap: share of an interval that the next one uses again, 0 to below 1.
        pixels: rows and columns of a frame.
        pixel_spacing_m: size of a pixel, metres.
    """
    recorded = read_pass(pass_file)
    if recorded.history is None:
        raise ValueError(f"{pass_file} holds frames, but no echoes to image.")
    settings = ImagingSettings(
        cross_range_resolution_m=resolution_m,
        overlap=overlap,
        shape=(pixels, pixels),
        pixel_spacing_m=pixel_spacing_m,
    )
    total = frame_count(recorded.history, settings)
    made = []
    with progress_bars() as report:
        for frame in frames(recorded.history, settings):
            made.append(frame)
            report("frames", len(made), total)
    write_pass(out, RecordedPass(history=recorded.history, frames=tuple(made)))
    print(f"{out}: {len(made)} frames of {pixels} × {pixels} pixels of {pixel_spacing_m} m.")
