"""`radarhull image`."""

from pathlib import Path
from typing import Annotated, Literal

import tyro

from app.commands.console import progress_bars
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.formats.pictures import write_picture
from core.frame import Frame
from core.radar.backprojection import backprojected_frame
from core.radar.imaging import ImagingSettings, frame_count, frames
from core.radar.phase_history import PhaseHistory


def image(
    pass_file: Annotated[Path, tyro.conf.Positional],
    out: Annotated[Path, tyro.conf.Positional],
    /,
    *,
    resolution_m: float = 0.15,
    overlap: float = 0.0,
    pixels: int = 512,
    pixel_spacing_m: float = 0.06,
    method: Literal["polar", "backprojection"] = "polar",
    picture: Path | None = None,
) -> None:
    """Image the echoes of a pass file: divide them into coherent intervals, form the frames.

    Args:
        pass_file: pass file with echoes.
        out: pass file to write, with the echoes and their frames.
        resolution_m: wanted cross-range resolution, metres.
        overlap: share of an interval that the next one uses again, 0 to below 1.
        pixels: rows and columns of a frame.
        pixel_spacing_m: size of a pixel, metres.
        method: "polar" divides into coherent intervals and takes wavefronts for planes;
            "backprojection" makes one image of all pulses on their slant plane with spherical
            wavefronts, for a near radar such as the measured Gotcha data.
        picture: also write the brightest frame as a PNG in dB, 60 dB deep.
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
    if method == "polar":
        made = _polar_frames(recorded.history, settings)
    else:
        made = [
            backprojected_frame(
                recorded.history,
                shape=settings.shape,
                row_spacing_m=pixel_spacing_m,
                column_spacing_m=pixel_spacing_m,
            )
        ]
    write_pass(out, RecordedPass(history=recorded.history, frames=tuple(made)))
    if picture is not None:
        write_picture(picture, max(made, key=lambda frame: float(frame.amplitude.max())))
    print(f"{out}: {len(made)} frames of {pixels} × {pixels} pixels of {pixel_spacing_m} m.")


def _polar_frames(history: PhaseHistory, settings: ImagingSettings) -> list[Frame]:
    total = frame_count(history, settings)
    made: list[Frame] = []
    with progress_bars() as report:
        for frame in frames(history, settings):
            made.append(frame)
            report("frames", len(made), total)
    return made
