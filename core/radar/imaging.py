"""Range-Doppler images of coherent intervals, free of range migration."""

from collections.abc import Iterator
from dataclasses import dataclass

import finufft
import numpy as np

from core.arrays import Floats
from core.frame import Frame
from core.geometry.projection import range_doppler_projection
from core.geometry.track import accumulated_turn_rad
from core.radar.intervals import CoherentInterval, divide
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import HAMMING


@dataclass(frozen=True, slots=True, kw_only=True)
class ImagingSettings:
    """How echoes become frames.

    Attributes:
        cross_range_resolution_m: Rayleigh resolution that sets the intervals' turn (eq. 10).
        overlap: share of an interval that the next one uses again.
        shape: (rows, columns) of the images.
        pixel_spacing_m: size of a pixel in range and cross-range.
    """

    cross_range_resolution_m: float = 0.15
    overlap: float = 0.0
    shape: tuple[int, int] = (512, 512)
    pixel_spacing_m: float = 0.06

    def __post_init__(self) -> None:
        if not (np.isfinite(self.pixel_spacing_m) and self.pixel_spacing_m > 0):
            raise ValueError(f"Pixel spacing must be positive metres, got {self.pixel_spacing_m}.")
        if min(self.shape) < 16 or max(self.shape) > 8192:
            raise ValueError(f"Images of 16 to 8192 pixels a side are made, not {self.shape}.")


def frames(history: PhaseHistory, settings: ImagingSettings | None = None) -> Iterator[Frame]:
    """Divide a phase history into coherent intervals and yield their images in order.

    Raises:
        ValueError: the line of sight turns too little, or the echoes are ambiguous in the image.
    """
    settings = settings or ImagingSettings()
    for interval in _intervals(history, settings):
        yield polar_format_frame(history, interval, settings)


def frame_count(history: PhaseHistory, settings: ImagingSettings | None = None) -> int:
    """Return how many frames `frames` will yield."""
    return len(_intervals(history, settings or ImagingSettings()))


def _intervals(history: PhaseHistory, settings: ImagingSettings) -> tuple[CoherentInterval, ...]:
    return divide(
        history.track,
        wavelength_m=history.wavelength_m,
        cross_range_resolution_m=settings.cross_range_resolution_m,
        overlap=settings.overlap,
    )


def polar_format_frame(
    history: PhaseHistory,
    interval: CoherentInterval,
    settings: ImagingSettings,
    *,
    label: str = "",
) -> Frame:
    """Return the polar-format image of one coherent interval.

    The samples lie on a polar raster of the wave-vector plane, (f cos α, f sin α) for the angle
    α of each pulse from the middle one; a type-1 nonuniform Fourier transform takes them straight
    to the pixels, so that a scatterer's walk through range cells and its Doppler's change during
    the interval cost nothing. Hamming windows weigh both axes.

    Returns:
        A frame whose row grows with range k·p and whose column with cross-range along dk/dt, the
        target frame's origin at pixel (rows // 2, columns // 2).

    Raises:
        ValueError: the image is larger than the unambiguous range or cross-range.

    Source: Walker, "Range-Doppler imaging of rotating objects", 1980, for the polar raster;
    eqs. 4 to 6 for the axes.
    """
    track = history.track
    range_axis = track.line_of_sight[interval.middle]
    projection = range_doppler_projection(
        line_of_sight=range_axis,
        line_of_sight_rate_per_s=track.line_of_sight_rate_per_s[interval.middle],
        row_spacing_m=settings.pixel_spacing_m,
        column_spacing_m=settings.pixel_spacing_m,
        shape=settings.shape,
    )
    axes = projection.matrix[:, :3] * settings.pixel_spacing_m
    pulses = slice(interval.start, interval.stop)
    line_of_sight = track.line_of_sight[pulses]
    turn = accumulated_turn_rad(line_of_sight)
    _check_unambiguous(history, turn, settings)
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * history.frequency_hz
    in_plane = line_of_sight @ axes.T
    weights = HAMMING.weights(turn / turn[-1])[:, None] * HAMMING.weights(
        np.linspace(0, 1, len(wavenumber))
    )
    image = finufft.nufft2d1(
        ((np.outer(in_plane[:, 0], wavenumber) - wavenumber.mean()) * settings.pixel_spacing_m)
        .ravel()
        .astype(np.float32),
        (np.outer(in_plane[:, 1], wavenumber) * settings.pixel_spacing_m)
        .ravel()
        .astype(np.float32),
        (history.samples[pulses] * weights.astype(np.float32)).ravel(),
        settings.shape,
        eps=1e-5,
        isign=1,
        nthreads=1,  # as in the echoes: the same input gives the same image
    )
    return Frame(
        amplitude=np.abs(image) / np.float32(weights.sum()),
        projection=projection,
        time_s=float(track.time_s[interval.middle]),
        sensor="radar",
        label=label,
        line_of_sight=range_axis,
        row_spacing_m=settings.pixel_spacing_m,
        column_spacing_m=settings.pixel_spacing_m,
        row_resolution_m=HAMMING.half_power_width_cells
        * SPEED_OF_LIGHT_M_PER_S
        / (2 * history.bandwidth_hz),
        column_resolution_m=HAMMING.half_power_width_cells
        * history.wavelength_m
        / (2 * interval.turn_rad),
    )


def _check_unambiguous(history: PhaseHistory, turn: Floats, settings: ImagingSettings) -> None:
    """Refuse images wider than what the samples tell apart, which would show every point twice."""
    pixel_m = settings.pixel_spacing_m
    height_m, width_m = (count * pixel_m for count in settings.shape)
    range_m = SPEED_OF_LIGHT_M_PER_S / (2 * history.frequency_step_hz)
    cross_range_m = history.wavelength_m / (2 * float(np.diff(turn).max()))
    if range_m < height_m or cross_range_m < width_m:
        raise ValueError(
            f"The echoes tell {range_m:.1f} m of range and {cross_range_m:.1f} m of cross-range "
            f"apart, but the image spans {height_m:.1f} × {width_m:.1f} m and would show ghosts; "
            "use fewer or smaller pixels, or echoes with denser frequencies and pulses."
        )
