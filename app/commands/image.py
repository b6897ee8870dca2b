"""`radarhull image`."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from app.commands.console import progress_bars
from app.commands.imaging_options import (
    DEFAULT_FOCUS,
    DEFAULT_REFOCUS,
    DEFAULT_WEIGHING,
    Divide,
    FocusOptions,
    MethodOption,
    Refocus,
    RefocusOptions,
    WeighingOptions,
)
from app.commands.options import JsonTo, OptionalFile, OptionalFloat, OutputFile, PassFile
from app.commands.outputs import checked_json, checked_pass, echo_facts, show_summary
from core.formats.files import checked_output
from core.formats.pass_file import RecordedPass, read_pass, write_pass
from core.formats.pictures import SUFFIXES, write_picture
from core.frame import Frame
from core.radar.imaging import (
    ImagingSettings,
    assessed_intervals,
    frames,
    interval_frame,
    whole_interval,
)
from core.radar.intervals import AssessedInterval
from core.radar.phase_history import PhaseHistory
from core.radar.refocusing import RefocusSettings, refocused
from core.radar.unsuitable import UnsuitablePart, unsuitable_parts
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S


def image(
    pass_file: PassFile,
    out: OutputFile,
    /,
    *,
    resolution_m: float = 0.15,
    overlap: float = 0.0,
    pixels: int = 512,
    pixel_spacing_m: float = 0.06,
    column_spacing_m: OptionalFloat = None,
    oversampling: OptionalFloat = None,
    method: MethodOption = "polar",
    divide: Divide = "auto",
    weighing: WeighingOptions = DEFAULT_WEIGHING,
    focus: FocusOptions = DEFAULT_FOCUS,
    refocus: RefocusOptions = DEFAULT_REFOCUS,
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
        column_spacing_m: size of a pixel in cross-range, metres, where it differs from range.
        oversampling: pixels per resolution cell on both axes, instead of spacings in metres.
        method: "polar" format takes wavefronts for planes; "keystone" nearly so; "range-doppler"
            is the paper's plain imaging, which smears away from the middle; "backprojection" is
            slow and takes spherical wavefronts, for a near radar such as the measured Gotcha data.
        divide: into coherent intervals (yes), or make one image of all pulses (no); auto divides
            unless the method is backprojection.
        weighing: how both axes are weighed.
        focus: which intervals can be sharp.
        refocus: what is found from the echoes alone before they are imaged.
        picture: also write the brightest frame as a PNG in dB, 60 dB deep.
        json: write a summary as JSON to this file, or to standard output for "-".
    """
    checked_pass(out)
    checked_json(json)
    if picture is not None:
        checked_output(picture, SUFFIXES)
    recorded = read_pass(pass_file)
    history = recorded.history
    if history is None:
        raise ValueError(f"{pass_file} holds frames, but no echoes to image.")
    row_m, column_m = _spacing_m(
        history, resolution_m, pixel_spacing_m, column_spacing_m, oversampling
    )
    settings = ImagingSettings(
        cross_range_resolution_m=resolution_m,
        overlap=overlap,
        shape=(pixels, pixels),
        pixel_spacing_m=row_m,
        column_spacing_m=column_m,
        method=method,
        window=weighing.chosen(),
        target_radius_m=focus.target_radius_m,
        criterion=focus.criterion,
        coarsest_resolution_m=focus.coarsest_resolution_m,
    )
    divides = divide == "yes" or (divide == "auto" and method != "backprojection")
    if focus.target_radius_m is not None and not divides:
        raise ValueError("--target-radius-m judges intervals; divide into them with --divide yes.")
    assessed = assessed_intervals(history, settings) if divides else ()
    made = _made(_refocused(history, assessed, refocus), settings, assessed)
    parts = unsuitable_parts(history.track, assessed)
    others = [frame for frame in recorded.frames if frame.sensor != "radar"]
    write_pass(out, RecordedPass(history=history, frames=(*made, *others)))
    if picture is not None:
        write_picture(picture, max(made, key=lambda frame: float(frame.amplitude.max())))
    show_summary(
        _sentence(str(out), made, assessed, parts),
        {
            "file": str(out),
            "method": method,
            "window": settings.window.name,
            "autofocus": refocus.autofocus,
            "aligned": refocus.align,
            "frames": len(made),
            "shape": [pixels, pixels],
            "spacing_m": row_m,
            "column_spacing_m": settings.spacing_m[1],
            **_verdict_facts(history, assessed, parts),
            **echo_facts(history),
        },
        json,
    )


def _spacing_m(
    history: PhaseHistory,
    resolution_m: float,
    row_m: float,
    column_m: float | None,
    oversampling: float | None,
) -> tuple[float, float]:
    if oversampling is None:
        return row_m, row_m if column_m is None else column_m
    if column_m is not None:
        raise ValueError("Give --oversampling or --column-spacing-m, not both.")
    if not 1 <= oversampling <= 64:
        raise ValueError(
            f"--oversampling wants pixels per resolution cell, 1 to 64; got {oversampling}."
        )
    range_cell_m = SPEED_OF_LIGHT_M_PER_S / (2 * history.bandwidth_hz)
    return range_cell_m / oversampling, resolution_m / oversampling


def _refocused(
    history: PhaseHistory, assessed: Sequence[AssessedInterval], refocus: Refocus
) -> PhaseHistory:
    settings = RefocusSettings(autofocus=refocus.autofocus, aligns=refocus.align)
    if not settings.is_active:
        return history
    used = [each.used for each in assessed if each.used is not None]
    spans = [(each.start, each.stop) for each in used] or [(0, len(history.track))]
    with progress_bars() as report:
        return refocused(
            history, spans, settings, lambda done, total: report("autofocus", done, total)
        )


def _made(
    history: PhaseHistory, settings: ImagingSettings, assessed: Sequence[AssessedInterval]
) -> list[Frame]:
    if not assessed:
        return [interval_frame(history, whole_interval(history), settings)]
    total = sum(each.used is not None for each in assessed)
    made: list[Frame] = []
    with progress_bars() as report:
        for frame in frames(history, settings):
            made.append(frame)
            report("frames", len(made), total)
    return made


def _sentence(
    out: str,
    made: Sequence[Frame],
    assessed: Sequence[AssessedInterval],
    parts: Sequence[UnsuitablePart],
) -> str:
    rows, columns = made[0].shape
    lines = [
        f"{out}: {len(made)} frames of {rows} × {columns} pixels of {made[0].row_spacing_m:.4g} × "
        f"{made[0].column_spacing_m:.4g} m."
    ]
    if any(each.verdict.quadratic_phase_rad is not None for each in assessed):
        counts = _counts(assessed)
        told = ", ".join(f"{count} {status}" for status, count in counts.items())
        lines.append(f"Of {len(assessed)} intervals: {told}.")
        lines += [
            f"Unsuitable from {part.start_s:.1f} to {part.stop_s:.1f} s, {part.reason}."
            for part in parts
        ]
    return "\n".join(lines)


def _counts(assessed: Sequence[AssessedInterval]) -> dict[str, int]:
    found = Counter(each.verdict.status for each in assessed)
    return {status: found[status] for status in ("accepted", "shortened", "rejected")}


def _verdict_facts(
    history: PhaseHistory, assessed: Sequence[AssessedInterval], parts: Sequence[UnsuitablePart]
) -> dict[str, Any]:
    time_s = history.track.time_s
    return {
        "verdicts": _counts(assessed),
        "intervals": [
            {
                "start_s": float(time_s[each.wanted.start]),
                "stop_s": float(time_s[each.wanted.stop - 1]),
                "status": each.verdict.status,
                "part": each.verdict.part,
                "reason": each.verdict.reason,
                "quadratic_phase_rad": each.verdict.quadratic_phase_rad,
                "resolution_m": each.verdict.resolution_m,
            }
            for each in assessed
        ],
        "unsuitable": [
            {
                "part": part.name,
                "start_s": part.start_s,
                "stop_s": part.stop_s,
                "intervals": part.intervals,
                "reason": part.reason,
            }
            for part in parts
        ],
    }
