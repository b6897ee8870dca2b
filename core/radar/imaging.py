"""Range-Doppler images of coherent intervals, by the method of one's choice."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.frame import Frame
from core.geometry.projection import Projection, range_doppler_projection
from core.geometry.track import accumulated_turn_rad
from core.parallel import in_order
from core.radar.aperture import aperture_of
from core.radar.backprojection import backproject
from core.radar.focus import FocusCriterion
from core.radar.intervals import (
    AssessedInterval,
    CoherentInterval,
    Division,
    assess,
    usable,
)
from core.radar.phase_history import PhaseHistory
from core.radar.polar_format import keystone, polar_format
from core.radar.range_doppler import range_doppler
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.radar.window import HAMMING, Window

Method = Literal["polar", "keystone", "range-doppler", "backprojection"]
"""How an image is formed.

polar: polar format, exact for plane wavefronts, and fast.
keystone: the keystone transform and a curve per row, nearly as sharp.
range-doppler: two plain Fourier transforms, as in the paper; smears away from the origin.
backprojection: the slow reference, with spherical wavefronts where the range is known.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ImagingSettings:
    """How echoes become frames.

    Attributes:
        cross_range_resolution_m: Rayleigh resolution that sets the intervals' turn (eq. 10).
        overlap: share of an interval that the next one uses again.
        shape: (rows, columns) of the images.
        pixel_spacing_m: size of a pixel in range and cross-range.
        row_spacing_m: size of a pixel in range, None for pixel_spacing_m.
        column_spacing_m: size of a pixel in cross-range, None for pixel_spacing_m.
        method: how an image is formed.
        window: weighs both axes.
        target_radius_m: largest distance of a scatterer from the target frame's origin, for the
            focus criterion; None asks for no focus.
        criterion: what counts against an interval.
        coarsest_resolution_m: to which an interval may be shortened, None for three times what is
            wanted.
    """

    cross_range_resolution_m: float = 0.15
    overlap: float = 0.0
    shape: tuple[int, int] = (512, 512)
    pixel_spacing_m: float = 0.06
    row_spacing_m: float | None = None
    column_spacing_m: float | None = None
    method: Method = "polar"
    window: Window = HAMMING
    target_radius_m: float | None = None
    criterion: FocusCriterion = "angles"
    coarsest_resolution_m: float | None = None

    def __post_init__(self) -> None:
        for spacing_m in (self.pixel_spacing_m, *self.spacing_m):
            if not (np.isfinite(spacing_m) and spacing_m > 0):
                raise ValueError(f"Pixel spacing must be positive metres, got {spacing_m}.")
        if min(self.shape) < 16 or max(self.shape) > 8192:
            raise ValueError(f"Images of 16 to 8192 pixels a side are made, not {self.shape}.")

    @property
    def spacing_m(self) -> tuple[float, float]:
        """Size of a pixel in range and cross-range."""
        row_m, column_m = self.row_spacing_m, self.column_spacing_m
        return (
            self.pixel_spacing_m if row_m is None else row_m,
            self.pixel_spacing_m if column_m is None else column_m,
        )

    def division(self, wavelength_m: float) -> Division:
        """Return how a pass at a wavelength is divided into intervals."""
        return Division(
            wavelength_m=wavelength_m,
            cross_range_resolution_m=self.cross_range_resolution_m,
            overlap=self.overlap,
            target_radius_m=self.target_radius_m,
            criterion=self.criterion,
            coarsest_resolution_m=self.coarsest_resolution_m,
        )


def frames(history: PhaseHistory, settings: ImagingSettings | None = None) -> Iterator[Frame]:
    """Divide a phase history into coherent intervals and yield their images in order.

    A few are made ahead in threads.

    Raises:
        ValueError: the line of sight turns too little, no interval can be sharp, or the echoes
            are ambiguous in the image or on the target.
    """
    settings = settings or ImagingSettings()
    intervals = usable(assessed_intervals(history, settings))

    def frame(interval: CoherentInterval) -> Frame:
        return interval_frame(history, interval, settings)

    yield from in_order(frame, intervals)


def frame_count(history: PhaseHistory, settings: ImagingSettings | None = None) -> int:
    """Return how many frames `frames` will yield."""
    return len(usable(assessed_intervals(history, settings or ImagingSettings())))


def assessed_intervals(
    history: PhaseHistory, settings: ImagingSettings
) -> tuple[AssessedInterval, ...]:
    """Return the intervals of a phase history, those without a frame too, with their verdicts.

    Raises:
        ValueError: the line of sight turns too little, or the target is larger than what the
            echoes tell apart.
    """
    assessed = assess(history.track, settings.division(history.wavelength_m))
    if settings.target_radius_m is not None:
        for each in assessed:
            _check_target(history, each.wanted, settings.target_radius_m)
    return assessed


def whole_interval(history: PhaseHistory) -> CoherentInterval:
    """Return all pulses as one interval, for echoes that are one image as they come."""
    turn = accumulated_turn_rad(history.track.line_of_sight)
    pulses = len(turn)
    return CoherentInterval(
        start=0,
        stop=pulses,
        middle=int(np.searchsorted(turn, turn[-1] / 2)),
        turn_rad=float(turn[-1]) * pulses / (pulses - 1),
    )


def whole_frame(history: PhaseHistory, settings: ImagingSettings) -> Frame:
    """Return one image of all pulses, as `interval_frame` makes it.

    Raises:
        ValueError: as `interval_frame`.
    """
    return interval_frame(history, whole_interval(history), settings)


def interval_frame(
    history: PhaseHistory,
    interval: CoherentInterval,
    settings: ImagingSettings,
    *,
    label: str = "",
) -> Frame:
    """Return the image of one coherent interval.

    Returns:
        A frame whose row grows with range k·p and whose column with cross-range along dk/dt, the
        target frame's origin at pixel (rows // 2, columns // 2), and in which a unit point's peak
        is 1.

    Raises:
        ValueError: the image is larger than the unambiguous range or cross-range, or the pulses
            do not suit the method.

    Source: eqs. 4 to 6 for the axes.
    """
    track, window = history.track, settings.window
    projection = interval_projection(history, interval, settings)
    rayleigh_m = (
        SPEED_OF_LIGHT_M_PER_S / (2 * history.bandwidth_hz),
        history.wavelength_m / (2 * interval.turn_rad),
    )
    return Frame(
        amplitude=np.abs(_image(history, interval, settings, projection)),
        projection=projection,
        time_s=float(track.time_s[interval.middle]),
        sensor="radar",
        label=label,
        line_of_sight=track.line_of_sight[interval.middle],
        row_spacing_m=settings.spacing_m[0],
        column_spacing_m=settings.spacing_m[1],
        row_resolution_m=window.half_power_width_cells * rayleigh_m[0],
        column_resolution_m=window.half_power_width_cells * rayleigh_m[1],
        window=window.name,
    )


def interval_projection(
    history: PhaseHistory, interval: CoherentInterval, settings: ImagingSettings
) -> Projection:
    """Return the projection of an interval's image, from the line of sight at its middle."""
    return range_doppler_projection(
        line_of_sight=history.track.line_of_sight[interval.middle],
        line_of_sight_rate_per_s=history.track.line_of_sight_rate_per_s[interval.middle],
        row_spacing_m=settings.spacing_m[0],
        column_spacing_m=settings.spacing_m[1],
        shape=settings.shape,
    )


def _image(
    history: PhaseHistory,
    interval: CoherentInterval,
    settings: ImagingSettings,
    projection: Projection,
) -> NDArray[np.complex64]:
    shape, spacing_m, window = settings.shape, settings.spacing_m, settings.window
    if settings.method == "backprojection":
        places = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
        part = history.part(interval.start, interval.stop)
        return backproject(part, projection.plane_points(places.astype(np.float64)), window=window)
    _check_image(history, interval, settings)
    if settings.method == "range-doppler":
        return range_doppler(history, interval, window, shape, spacing_m)
    aperture = aperture_of(history, interval, projection, window)
    form = keystone if settings.method == "keystone" else polar_format
    return form(aperture, shape, spacing_m)


def _unambiguous_m(history: PhaseHistory, interval: CoherentInterval) -> tuple[float, float]:
    """Return what the samples tell apart in range and in cross-range, that is in Doppler."""
    turn = accumulated_turn_rad(history.track.line_of_sight[interval.start : interval.stop])
    return (
        SPEED_OF_LIGHT_M_PER_S / (2 * history.frequency_step_hz),
        history.wavelength_m / (2 * float(np.diff(turn).max())),
    )


def _check_target(history: PhaseHistory, interval: CoherentInterval, radius_m: float) -> None:
    range_m, cross_range_m = _unambiguous_m(history, interval)
    if 2 * radius_m > min(range_m, cross_range_m):
        axis, told_m = (
            ("range", range_m) if range_m <= cross_range_m else ("Doppler", cross_range_m)
        )
        raise ValueError(
            f"A target of {radius_m:g} m radius spans {2 * radius_m:g} m, but the echoes are "
            f"unambiguous in {axis} over {told_m:.1f} m only and would fold it; use echoes with "
            f"{'denser frequencies' if axis == 'range' else 'more pulses per second'}."
        )


def _check_image(
    history: PhaseHistory, interval: CoherentInterval, settings: ImagingSettings
) -> None:
    """Refuse images wider than what the samples tell apart, which would show every point twice."""
    height_m, width_m = (
        count * spacing_m
        for count, spacing_m in zip(settings.shape, settings.spacing_m, strict=True)
    )
    range_m, cross_range_m = _unambiguous_m(history, interval)
    if range_m < height_m or cross_range_m < width_m:
        raise ValueError(
            f"The echoes tell {range_m:.1f} m of range and {cross_range_m:.1f} m of cross-range "
            f"apart, but the image spans {height_m:.1f} × {width_m:.1f} m and would show ghosts; "
            "use fewer or smaller pixels, or echoes with denser frequencies and pulses."
        )
