"""Near-field frames of what stands upright: focused where it stands, not where the frame lies.

The plane of a circular aperture's frame is tilted by the elevation θ, and a standing body's head
and feet are far off it: 0.75 m at 30°. That misplaces nothing across, but while the antenna goes
round by ±dφ, what is h off the plane wanders across by h·tan θ·cos θ·dφ: some 50 mm to either side
over a sub-aperture of 25 mm resolution at 27 GHz, two cells. So the echoes are focused on the
upright plane through the axis, and the image is laid back onto the frame's plane along curves of
equal range.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from core.arrays import Floats
from core.frame import Frame
from core.parallel import in_order
from core.radar.backprojection import backproject
from core.radar.circular_sar import NearFieldSettings, late_m, sub_apertures
from core.radar.imaging import ImagingSettings, whole_frame
from core.radar.intervals import CoherentInterval
from core.radar.phase_history import PhaseHistory

UP = np.array([0.0, 0.0, 1.0])
"""The axis that the antenna goes round; its sign means nothing."""


def upright_frames(
    history: PhaseHistory, settings: NearFieldSettings | None = None
) -> Iterator[Frame]:
    """Yield every sub-aperture's frame, focused on the upright plane that faces the radar.

    Frames are laid out as those of `near_field_frames`, and points appear in them at
    `near_image_points` alike; only what stands off the frame's plane is sharper.

    Args:
        history: of an antenna that goes round z at a constant elevation other than 0.
        settings: as for `near_field_frames`.

    Raises:
        ValueError: as `sub_apertures`; no range; or an antenna level with the origin, for which
            range does not tell heights apart.
    """
    settings = settings or NearFieldSettings()
    # Only the layout of this frame is kept, so the fastest image will do.
    imaging = ImagingSettings(
        method="polar", shape=settings.shape, pixel_spacing_m=settings.pixel_spacing_m
    )

    def frame(interval: CoherentInterval) -> Frame:
        part = history.part(interval.start, interval.stop)
        flat = whole_frame(part, imaging)
        points_m = upright_points(flat, middle_range_m(part))
        return replace(flat, amplitude=np.abs(backproject(part, points_m)))

    yield from in_order(frame, sub_apertures(history, settings))


def middle_range_m(history: PhaseHistory) -> float:
    """Return how far the radar is from the origin at the middle pulse.

    Raises:
        ValueError: the track has no ranges.
    """
    ranges = history.track.range_m
    if ranges is None:
        raise ValueError("Near-field frames need to know how far the radar is: range_m of a track.")
    return float(ranges[len(ranges) // 2])


def upright_points(frame: Frame, range_m: float) -> Floats:
    """Return the points (rows, columns, 3) of the upright plane that appear at each pixel.

    A point at height z on the axis is √(R² + 2 R z sin θ + z²) from the radar; where no height is
    as near as a pixel wants, the nearest point of the axis stands in.

    Args:
        frame: gives the layout: rows along range, columns across.
        range_m: R from radar to the origin at the frame's middle.

    Raises:
        ValueError: the antenna is level with the origin.
    """
    sine = float(frame.line_of_sight @ UP)
    if abs(sine) < 0.05:
        raise ValueError(
            "Range tells heights apart only from above or below; the antenna stands "
            f"{np.degrees(np.arcsin(sine)):.3g}° above the origin. Give it 3° or more."
        )
    places = np.stack(np.meshgrid(*map(np.arange, frame.shape), indexing="ij"), axis=-1)
    flat = frame.projection.plane_points(places.astype(np.float64))
    along_m = flat @ frame.line_of_sight
    square = (range_m * sine) ** 2 + 2 * range_m * along_m + along_m**2
    height_m = np.sign(sine) * np.sqrt(np.maximum(square, 0)) - range_m * sine
    across = flat - along_m[..., None] * frame.line_of_sight
    upright: Floats = across + height_m[..., None] * UP
    return upright


def near_image_points(frame: Frame, range_m: float, points_m: Floats) -> Floats:
    """Return where points (…, 3) truly appear in a near-field frame, (…, 2) as (row, column).

    Args:
        frame: of `near_field_frames` or `upright_frames`.
        range_m: from radar to the origin at the frame's middle.
        points_m: target frame.

    Raises:
        ValueError: the frame does not know the size of its pixels.
    """
    if frame.row_spacing_m is None:
        raise ValueError("A near-field frame must know the size of its pixels; this one does not.")
    image = frame.projection.image_points(points_m)
    image[..., 0] += late_m(frame, range_m, points_m) / frame.row_spacing_m
    return image
