"""Point responses measured on images, in resolution cells and decibels."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.frame import Frame
from core.radar.echoes import point_echoes
from core.radar.imaging import ImagingSettings, Method, interval_frame
from core.radar.intervals import CoherentInterval
from core.radar.phase_history import PhaseHistory
from core.radar.window import HAMMING, Window, window_named

PIXEL_M = 0.012
"""A twelfth of the finest cell: cuts need no interpolation between pixels to 0.2 dB."""

MARGIN_M = 2.1
"""Of an image beyond the point: fourteen cells of sidelobes."""

HALF_POWER = float(np.sqrt(0.5))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cut:
    """One axis of a point response.

    Attributes:
        place_cells: (n,) from where the point is, in Rayleigh cells.
        amplitude: (n,) relative to the peak.
        error_cells: of the peak's place.
        width_ratio: −3 dB width over the window's.
        sidelobe_db: highest sidelobe below the peak.
    """

    place_cells: Floats
    amplitude: Floats
    error_cells: float
    width_ratio: float
    sidelobe_db: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointResponse:
    """What an image makes of one unit point.

    Attributes:
        frame: the image.
        peak: its highest amplitude, 1 in theory.
        cuts: through the peak along range and cross-range.
    """

    frame: Frame
    peak: float
    cuts: tuple[Cut, Cut]

    @property
    def cell_m(self) -> tuple[float, float]:
        """Rayleigh cells in range and cross-range."""
        frame, width = self.frame, window_named(self.frame.window).half_power_width_cells
        row_m, column_m = frame.row_resolution_m or 0.0, frame.column_resolution_m or 0.0
        return row_m / width, column_m / width

    @property
    def error_cells(self) -> float:
        """The larger of both axes' displacements."""
        return max(abs(cut.error_cells) for cut in self.cuts)

    @property
    def width_error(self) -> float:
        """The larger of both axes' deviations from the window's −3 dB width, as a share."""
        return max(abs(cut.width_ratio - 1) for cut in self.cuts)

    @property
    def sidelobe_db(self) -> float:
        """The higher of both axes' highest sidelobes."""
        return max(cut.sidelobe_db for cut in self.cuts)


def respond(
    history: PhaseHistory,
    interval: CoherentInterval,
    offset_m: tuple[float, float],
    *,
    method: Method,
    window: Window = HAMMING,
    pixel_m: float = PIXEL_M,
) -> PointResponse:
    """Return the response to a unit point at a range and cross-range from the origin.

    Args:
        history: whose track and frequencies are used; its samples are replaced by the point's.
        interval: which pulses.
        offset_m: (range, cross-range) at the interval's middle.
        method: how the image is formed.
        window: weighs both axes.
        pixel_m: size of a pixel.
    """
    rows, columns = (2 * int(np.ceil((abs(x) + MARGIN_M) / pixel_m)) for x in offset_m)
    settings = ImagingSettings(
        shape=(rows, columns), pixel_spacing_m=pixel_m, method=method, window=window
    )
    point_m = np.array(offset_m) @ image_axes(history, interval)
    echoes = with_points(history, point_m[None], np.ones(1))
    return measured(interval_frame(echoes, interval, settings), point_m)


def image_axes(history: PhaseHistory, interval: CoherentInterval) -> Floats:
    """Return the unit directions of range and cross-range at an interval's middle, (2, 3)."""
    along = history.track.line_of_sight[interval.middle]
    rate = history.track.line_of_sight_rate_per_s[interval.middle]
    axes: Floats = np.stack([along, rate / np.linalg.norm(rate)])
    return axes


def with_points(
    history: PhaseHistory, points_m: Floats, amplitude: NDArray[np.float64]
) -> PhaseHistory:
    """Return the same pulses with the noiseless echoes of some points (points, 3)."""
    echoes = point_echoes(
        points_m,
        amplitude.astype(np.complex128),
        history.track.line_of_sight,
        history.frequency_hz,
    )
    return replace(history, samples=echoes)


def measured(frame: Frame, point_m: Floats) -> PointResponse:
    """Measure the response of an image of one point at `point_m` (3,).

    Raises:
        ValueError: a frame whose spacing or resolution is unknown.
    """
    amplitude = frame.amplitude.astype(np.float64)
    row, column = np.unravel_index(np.argmax(amplitude), amplitude.shape)
    expected = frame.projection.image_points(point_m)
    width = window_named(frame.window).half_power_width_cells
    return PointResponse(
        frame=frame,
        peak=float(amplitude.max()),
        cuts=(
            _cut(amplitude[:, column], expected[0], _per_pixel(frame, 0, width), width),
            _cut(amplitude[row], expected[1], _per_pixel(frame, 1, width), width),
        ),
    )


def _per_pixel(frame: Frame, axis: int, width_cells: float) -> float:
    """Return how many Rayleigh cells a pixel is."""
    spacing_m = (frame.row_spacing_m, frame.column_spacing_m)[axis]
    resolution_m = (frame.row_resolution_m, frame.column_resolution_m)[axis]
    if spacing_m is None or resolution_m is None:
        raise ValueError("A point response is measured on frames of known spacing and resolution.")
    return spacing_m * width_cells / resolution_m


def _cut(line: Floats, expected: float, cells: float, width_cells: float) -> Cut:
    relative = line / line.max()
    peak = int(np.argmax(relative))
    left, right = (_crossing(relative, peak, step) for step in (-1, 1))
    return Cut(
        place_cells=(np.arange(len(line), dtype=np.float64) - expected) * cells,
        amplitude=relative,
        error_cells=(_vertex(relative, peak) - expected) * cells,
        width_ratio=(right - left) * cells / width_cells,
        sidelobe_db=max(_highest_sidelobe_db(relative[: peak + 1][::-1], relative[peak:])),
    )


def _vertex(line: Floats, peak: int) -> float:
    """Return the sub-pixel place of a peak, by a parabola."""
    if not 0 < peak < len(line) - 1:
        return float(peak)
    before, at, after = line[peak - 1 : peak + 2]
    return peak + 0.5 * float((before - after) / (before - 2 * at + after))


def _crossing(line: Floats, peak: int, step: int) -> float:
    """Return where a line falls to half the power, from its peak in the direction of `step`."""
    place = peak
    while 0 < place < len(line) - 1 and line[place] > HALF_POWER:
        place += step
    inside, outside = line[place - step], line[place]
    return place - step + step * float((inside - HALF_POWER) / (inside - outside))


def _highest_sidelobe_db(*sides: Sequence[float] | Floats) -> list[float]:
    """Return the highest level past the first minimum of lines that begin at the peak."""
    found = []
    for side in map(np.asarray, sides):
        rising = np.flatnonzero(np.diff(side) > 0)
        rest = side[rising[0] :] if len(rising) else side[-1:]
        found.append(20 * float(np.log10(max(rest.max(), 1e-9))))
    return found
