"""Circular synthetic aperture at close range: an antenna on a circle about a standing body."""

from collections.abc import Iterator
from dataclasses import dataclass

import finufft
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.frame import Frame
from core.geometry.track import (
    LineOfSightTrack,
    accumulated_turn_rad,
    line_of_sight_from_angles,
)
from core.radar.echoes import receiver_noise
from core.radar.imaging import ImagingSettings, whole_frame
from core.radar.intervals import CoherentInterval, divide
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import Scatterers, lit_amplitudes
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform

TRANSFORM_PRECISION = 1e-6
"""Asked of the nonuniform Fourier transform."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NearFieldSettings:
    """How close echoes become frames; by default those of a standing person.

    Attributes:
        cross_range_resolution_m: Rayleigh resolution that sets the sub-apertures' turn.
        overlap: share of a sub-aperture that the next one uses again.
        shape: (rows, columns). A standing body seen from an elevation has its height along range:
            160 pixels across by 383 along range.
        pixel_spacing_m: size of a pixel.
    """

    cross_range_resolution_m: float = 0.025
    overlap: float = 0.0
    shape: tuple[int, int] = (383, 160)
    pixel_spacing_m: float = 0.005


def body_waveform() -> Waveform:
    """Return 27 GHz and 6 GHz of band, whose 128 frequencies tell 3.2 m of range apart."""
    return Waveform(carrier_frequency_hz=27e9, bandwidth_hz=6e9, frequency_count=128)


def circular_track(
    *,
    range_m: float,
    elevation_rad: float = np.deg2rad(30.0),
    azimuth_span_rad: float = np.deg2rad(120.0),
    middle_azimuth_rad: float = 0.0,
    pulses: int = 1024,
    duration_s: float = 10.0,
) -> LineOfSightTrack:
    """Return the track of an antenna that goes round on an arc at even speed.

    Args:
        range_m: from antenna to the target frame's origin; the circle's own radius is
            range · cos θ.
        elevation_rad: θ of the line of sight (eq. 3), the same all along. The antenna stands at
            −range·k, so that θ above zero has it above the target where z points down.
        azimuth_span_rad: by which φ grows from half a pulse before the first to half a pulse
            after the last.
        middle_azimuth_rad: φ halfway.
        pulses: how many, evenly spread.
        duration_s: time for the whole arc.

    Raises:
        ValueError: no range, no arc, an antenna on the axis, or fewer than 3 pulses.
    """
    if not (
        range_m > 0
        and duration_s > 0
        and 0 < azimuth_span_rad <= 2 * np.pi
        and abs(elevation_rad) < np.pi / 2
        and pulses >= 3
    ):
        raise ValueError(
            "A circular track needs a range and duration above zero, an arc of up to 360°, an "
            f"elevation within ±90° and at least 3 pulses; got {range_m} m, {duration_s} s, "
            f"{np.degrees(azimuth_span_rad):.6g}°, {np.degrees(elevation_rad):.6g}° and {pulses}."
        )
    share = (np.arange(pulses) + 0.5) / pulses
    azimuth = middle_azimuth_rad + (share - 0.5) * azimuth_span_rad
    elevation = np.full(pulses, elevation_rad)
    along = np.stack([np.cos(azimuth), -np.sin(azimuth), np.zeros(pulses)], axis=-1)
    return LineOfSightTrack(
        time_s=share * duration_s,
        line_of_sight=line_of_sight_from_angles(elevation, azimuth),
        line_of_sight_rate_per_s=along * (np.cos(elevation_rad) * azimuth_span_rad / duration_s),
        range_m=np.full(pulses, range_m),
    )


def near_field_echoes(
    position_m: Floats,
    amplitude: NDArray[np.complex128],
    track: LineOfSightTrack,
    frequency_hz: Floats,
) -> NDArray[np.complex64]:
    """Return Σ a exp(−j 4π f (R(p) − R(0)) / c), (pulses, frequencies), with R exact.

    Args:
        position_m: (points, 3), target frame.
        amplitude: (points,) complex; the falling-off with range is not in it.
        track: with range_m, from which R follows.
        frequency_hz: (frequencies,) evenly spaced.

    Raises:
        ValueError: the track has no ranges.

    Source: for every pulse the even frequencies are a type-1 nonuniform Fourier transform over
    the points' ranges (Barnett, Magland and af Klinteberg, 2019); the direct sum is the reference
    in the tests.
    """
    if track.range_m is None:
        raise ValueError("Near-field echoes need to know how far the radar is: range_m of a track.")
    count = len(frequency_hz)
    echoes = np.zeros((len(track), count), dtype=np.complex64)
    if len(position_m) == 0:
        return echoes
    step = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * (frequency_hz[-1] - frequency_hz[0]) / (count - 1)
    # The transform's own frequencies are −count//2 … : its 0 stands for this one.
    middle = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * frequency_hz[count // 2]
    for pulse, (k, range_m) in enumerate(zip(track.line_of_sight, track.range_m, strict=True)):
        beyond_m = _beyond_origin_m(position_m, k, range_m)
        turned = amplitude * np.exp(-1j * middle * beyond_m)
        phase = np.remainder(step * beyond_m + np.pi, 2 * np.pi) - np.pi
        echoes[pulse] = finufft.nufft1d1(
            phase, turned, count, eps=TRANSFORM_PRECISION, isign=-1, nthreads=1
        )
    return echoes


def simulate_near_field(
    scatterers: Scatterers,
    track: LineOfSightTrack,
    waveform: Waveform,
    *,
    signal_to_noise_db: float,
    random: np.random.Generator,
    shadow_step_rad: float = np.deg2rad(3.5),
) -> PhaseHistory:
    """Return the phase history of a self-shadowing body close to the radar.

    Which scatterers are lit is decided by parallel rays along the line of sight to the origin,
    anew whenever it has turned by `shadow_step_rad`; wavefronts are exact spheres.

    Args:
        scatterers: what scatters, target frame.
        track: with range_m.
        waveform: band and sampling.
        signal_to_noise_db: mean echo power over all aspects to noise power, per sample.
        random: for the noise.
        shadow_step_rad: largest turn over which the lit side is held.

    Raises:
        ValueError: the body is larger than the unambiguous range, or the track has no ranges.
    """
    reach_m = 2 * float(np.linalg.norm(scatterers.position_m, axis=1).max())
    if reach_m > waveform.unambiguous_range_m:
        raise ValueError(
            f"The body spans {reach_m:.2f} m about its origin, more than the waveform's "
            f"unambiguous {waveform.unambiguous_range_m:.2f} m; use more frequency samples."
        )
    frequency_hz = waveform.frequencies_hz()
    turn = accumulated_turn_rad(track.line_of_sight)
    blocks = max(1, min(int(np.ceil(turn[-1] / shadow_step_rad)), len(track) // 2))
    parts = []
    for pulses in np.array_split(np.arange(len(track)), blocks):
        some = track.part(int(pulses[0]), int(pulses[-1]) + 1)
        amplitude = lit_amplitudes(scatterers, some.line_of_sight[len(some) // 2])
        lit = np.flatnonzero(amplitude)
        parts.append(
            near_field_echoes(scatterers.position_m[lit], amplitude[lit], some, frequency_hz)
        )
    samples = np.concatenate(parts)
    noise_power = scatterers.mean_echo_power() * 10 ** (-signal_to_noise_db / 10)
    samples += receiver_noise(samples.shape, noise_power, random)
    return PhaseHistory(samples=samples, frequency_hz=frequency_hz, track=track)


def sub_apertures(
    history: PhaseHistory, settings: NearFieldSettings
) -> tuple[CoherentInterval, ...]:
    """Return the intervals that each make a frame.

    Raises:
        ValueError: the arc is shorter than one sub-aperture, or the pulses are too sparse.
    """
    return divide(
        history.track,
        wavelength_m=history.wavelength_m,
        cross_range_resolution_m=settings.cross_range_resolution_m,
        overlap=settings.overlap,
    )


def near_field_frames(
    history: PhaseHistory, settings: NearFieldSettings | None = None
) -> Iterator[Frame]:
    """Yield the back-projected frame of every sub-aperture, on the frame's own plane.

    The plane holds the origin, k and dk/dt of the middle pulse. The frame's affine projection is
    exact for points of that plane; where it puts others is up to `late_m` off along range, and
    not at all across.

    Raises:
        ValueError: as `sub_apertures`, or a senseless image.
    """
    settings = settings or NearFieldSettings()
    imaging = ImagingSettings(
        method="backprojection", shape=settings.shape, pixel_spacing_m=settings.pixel_spacing_m
    )
    for interval in sub_apertures(history, settings):
        yield whole_frame(history.part(interval.start, interval.stop), imaging)


def late_m(frame: Frame, range_m: float, points_m: Floats) -> Floats:
    """Return by how much points (…, 3) appear farther in a near frame than it projects them.

    A point h off the frame's plane shares its range and its Doppler with the point of the plane
    that has the same cross-range and stands √((R + a)² + h²) − (R + a) behind its foot at a along
    range: h²/2R in short, 8 mm for 0.3 m at 6 m. Far away it is nothing.

    Args:
        frame: of `near_field_frames`.
        range_m: R from radar to the origin at the frame's middle.
        points_m: target frame.
    """
    points = np.asarray(points_m, dtype=np.float64)
    height_m = points @ frame.projection.viewing_direction()
    foot_m = range_m + points @ frame.line_of_sight
    late: Floats = np.hypot(foot_m, height_m) - foot_m
    return late


def _beyond_origin_m(position_m: Floats, k: Floats, range_m: float) -> Floats:
    """Return R(p) − R(0), (points,), without the difference of two large numbers."""
    square = np.sum(position_m * position_m, axis=1) + 2 * range_m * (position_m @ k)
    beyond: Floats = square / (np.sqrt(square + range_m**2) + range_m)
    return beyond
