"""`radarhull image`."""

from typing import Annotated, Literal

import tyro

from app.commands.console import progress_bars
from app.commands.options import JsonTo, OptionalFile, OutputFile, PassFile
from app.commands.outputs import checked_json, checked_pass, echo_facts, show_summary
from core.formats.files import checked_output
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.formats.pictures import SUFFIXES, write_picture
from core.frame import Frame
from core.radar.backprojection import backprojected_frame
from core.radar.imaging import ImagingSettings, frame_count, frames
from core.radar.intervals import divide
from core.radar.phase_history import PhaseHistory
from core.radar.refocusing import Autofocus, RefocusSettings, refocused

Method = Literal["polar", "backprojection"]


def image(
    pass_file: PassFile,
    out: OutputFile,
    /,
    *,
    resolution_m: float = 0.15,
    overlap: float = 0.0,
    pixels: int = 512,
    pixel_spacing_m: float = 0.06,
    method: Annotated[Method, tyro.conf.arg(metavar="{polar,backprojection}")] = "polar",
    autofocus: Annotated[
        Autofocus, tyro.conf.arg(metavar="{none,phase-gradient,minimum-entropy}")
    ] = "none",
    align: bool = False,
    picture: OptionalFile = None,
    json: JsonTo = None,
) -> None:
    """Divide the echoes of a pass file into coherent intervals and form their frames.

    Args:
        pass_file: pass file with echoes.
        out: pass file to write (.h5), with the echoes and their frames.
        resolution_m: wanted cross-range resolution, metres.
        overlap: share of an interval that the next one uses again, 0 to below 1.
        pixels: rows and columns of a frame.
        pixel_spacing_m: size of a pixel, metres.
        method: "polar" divides into coherent intervals and takes wavefronts for planes;
            "backprojection" makes one image of all pulses on their slant plane with spherical
            wavefronts, for a near radar such as the measured Gotcha data.
        autofocus: what finds the pulses' phases in every coherent interval (all pulses with
            backprojection); "minimum-entropy" goes on from what "phase-gradient" finds. A shift
            of the image across cannot be found.
        align: first align the pulses' ranges, for an unknown translation of the target; each
            frame then shows the body's middle where the origin belongs.
        picture: also write the brightest frame as a PNG in dB, 60 dB deep.
        json: write a summary as JSON to this file, or to standard output for "-".
    """
    checked_pass(out)
    checked_json(json)
    if picture is not None:
        checked_output(picture, SUFFIXES)
    recorded = read_pass(pass_file)
    if recorded.history is None:
        raise ValueError(f"{pass_file} holds frames, but no echoes to image.")
    settings = ImagingSettings(
        cross_range_resolution_m=resolution_m,
        overlap=overlap,
        shape=(pixels, pixels),
        pixel_spacing_m=pixel_spacing_m,
    )
    refocus = RefocusSettings(autofocus=autofocus, aligns=align)
    made = _frames(_refocused(recorded.history, settings, method, refocus), settings, method)
    write_pass(out, RecordedPass(history=recorded.history, frames=tuple(made)))
    if picture is not None:
        write_picture(picture, max(made, key=lambda frame: float(frame.amplitude.max())))
    show_summary(
        f"{out}: {len(made)} frames of {pixels} × {pixels} pixels of {pixel_spacing_m} m.",
        {
            "file": str(out),
            "method": method,
            "autofocus": autofocus,
            "aligned": align,
            "frames": len(made),
            "shape": [pixels, pixels],
            "spacing_m": pixel_spacing_m,
            **echo_facts(recorded.history),
        },
        json,
    )


def _refocused(
    history: PhaseHistory, settings: ImagingSettings, method: Method, refocus: RefocusSettings
) -> PhaseHistory:
    if not refocus.is_active:
        return history
    spans = [(0, len(history.track))]
    if method == "polar":
        intervals = divide(
            history.track,
            wavelength_m=history.wavelength_m,
            cross_range_resolution_m=settings.cross_range_resolution_m,
            overlap=settings.overlap,
        )
        spans = [(interval.start, interval.stop) for interval in intervals]
    with progress_bars() as report:
        return refocused(
            history, spans, refocus, lambda done, total: report("autofocus", done, total)
        )


def _frames(history: PhaseHistory, settings: ImagingSettings, method: Method) -> list[Frame]:
    if method == "polar":
        return _polar_frames(history, settings)
    frame = backprojected_frame(
        history,
        shape=settings.shape,
        row_spacing_m=settings.pixel_spacing_m,
        column_spacing_m=settings.pixel_spacing_m,
    )
    return [frame]


def _polar_frames(history: PhaseHistory, settings: ImagingSettings) -> list[Frame]:
    total = frame_count(history, settings)
    made: list[Frame] = []
    with progress_bars() as report:
        for frame in frames(history, settings):
            made.append(frame)
            report("frames", len(made), total)
    return made
