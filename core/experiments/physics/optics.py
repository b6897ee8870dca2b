"""The optical part of the physics experiment: telescope frames from the sun to the hull."""

from datetime import UTC, datetime, timedelta

import numpy as np

from core.experiments.demo import DEMO_ORBIT, DEMO_STATION
from core.experiments.physics.optics_checks import (
    essential_residual,
    full_width,
    phase_law,
    photon_transfer,
    point_spread,
    sun_error_deg,
)
from core.experiments.physics.optics_outlines import (
    LOST_PX,
    Outlined,
    agreement,
    area_error_percent,
    outlined,
    random_frames,
    sunward_errors_px,
)
from core.experiments.physics.optics_pictures import (
    Scene,
    checks_picture,
    partner_picture,
    pass_picture,
)
from core.experiments.physics.part import Part, Progress
from core.experiments.results import Figure
from core.geometry.orbit import Pass, line_of_sight_track, passes, satellite_from_elements
from core.geometry.track import LineOfSightTrack, accumulated_turn_rad
from core.hull.shadow import CarvingRule
from core.hull.sunlight import MOST_PHASE_RAD
from core.optical.simulation import OpticalSettings, simulate_optical_frames
from core.optical.sun import (
    CIVIL_TWILIGHT_RAD,
    Illumination,
    illumination,
    phase_angle_rad,
    sun_elevation_rad,
    track_illumination,
)
from core.optical.telescope import AIRY_FWHM, Detector, Telescope
from core.parallel import in_order
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import Waveform
from core.targets import Target, tiangong_like

SEARCH_FROM_UTC = datetime(2016, 3, 11, 15, tzinfo=UTC)
SEARCH_DAYS = 14
"""The built-in orbit crosses Beijing in the Earth's shadow for twelve days from the first pass."""

PASS_MOMENTS = 6
HULL_FRAMES = 20
HULL_SPACING_M = 0.2
RULES: tuple[CarvingRule, CarvingRule] = ("shadow", "strict")


def optics_part(progress: Progress) -> Part:
    """Hold cameras, light and outlines against theory, and photograph a pass at dusk."""
    random = np.random.default_rng(1)
    target = tiangong_like()
    curves = {
        "phase": phase_law(),
        "spread": point_spread(Telescope()),
        "photons": photon_transfer(Detector(), random),
    }
    progress("optics: checks", 1, 1)
    phases = np.linspace(np.deg2rad(5.0), MOST_PHASE_RAD, HULL_FRAMES)
    found = random_frames(
        target,
        phases_rad=phases,
        settings=OpticalSettings(shape=(480, 480), supersampling=2),
        random=random,
        progress=lambda done, total: progress("optics: random views", done, total),
    )
    scene = _dusk_pass(target, random, progress)
    figures = (
        Figure(
            name="eq. 8, largest relative residual",
            value=essential_residual(poses=200, random=random),
            wanted="<= 1e-12",
        ),
        Figure(name="sun's place, error", value=sun_error_deg(), unit="°", wanted="<= 0.01 °"),
        Figure(
            name="Lambertian sphere's phase law, largest error",
            value=100 * _largest(curves["phase"].measured - curves["phase"].theory),
            unit="%",
            wanted="<= 1 %",
        ),
        Figure(
            name="point spread's width against 1.029 λ/D, error",
            value=100 * abs(full_width(curves["spread"]) / AIRY_FWHM - 1),
            unit="%",
            wanted="<= 5 %",
        ),
        Figure(
            name="photons' variance against their mean, largest error",
            value=100 * _largest(curves["photons"].measured / curves["photons"].theory - 1),
            unit="%",
            wanted="<= 3 %",
        ),
        *_outline_figures(found, target),
        *_pass_figures(scene),
    )
    return Part(
        figures=figures,
        pictures=(pass_picture(scene), partner_picture(scene), checks_picture(curves)),
    )


def visible_pass(*, start_utc: datetime, days: int) -> Pass:
    """Return the first pass of the built-in orbit that a telescope at the station can see.

    The satellite is in full sun throughout, and the station has night at its culmination.

    Raises:
        ValueError: there is none.
    """
    satellite = satellite_from_elements(DEMO_ORBIT)
    for each in passes(
        satellite,
        DEMO_STATION,
        start_utc=start_utc,
        duration_s=days * 86400.0,
        elevation_mask_rad=float(np.deg2rad(10)),
    ):
        moments = [each.rise_utc + timedelta(seconds=each.duration_s * k / 8) for k in range(9)]
        is_night = sun_elevation_rad(DEMO_STATION, moments[4:5])[0] < CIVIL_TWILIGHT_RAD
        if is_night and np.all(illumination(satellite, moments).sunlit_fraction == 1):
            return each
    raise ValueError(
        f"No pass within {days} days of {start_utc:%Y-%m-%d} is sunlit over a dark station."
    )


def _dusk_pass(target: Target, random: np.random.Generator, progress: Progress) -> Scene:
    satellite = satellite_from_elements(DEMO_ORBIT)
    waveform = Waveform()
    each = visible_pass(start_utc=SEARCH_FROM_UTC, days=SEARCH_DAYS)
    track = line_of_sight_track(
        satellite,
        DEMO_STATION,
        start_utc=each.rise_utc,
        duration_s=each.duration_s,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
    )
    time_s = np.linspace(0.2, 0.85, PASS_MOMENTS) * each.duration_s
    light = track_illumination(satellite, track, time_s)
    pictures = simulate_optical_frames(
        target,
        track,
        list(time_s),
        light,
        random=random,
        progress=lambda done, total: progress("optics: pass at dusk", done, total),
    )
    found = tuple(in_order(lambda frame: outlined(frame, target), pictures))
    radar = _radar_frame(target, track, float(time_s[3]), waveform, random)
    (rolled,) = simulate_optical_frames(
        target,
        track,
        [float(time_s[3])],
        _only(light, 3),
        OpticalSettings(roll_rad=float(np.deg2rad(40))),
        random=random,
    )
    return Scene(
        start_utc=each.rise_utc,
        found=found,
        radar=radar,
        partner=found[3],
        rolled=outlined(rolled, target),
    )


def _only(light: Illumination, number: int) -> Illumination:
    where = slice(number, number + 1)
    return Illumination(
        sun_direction=light.sun_direction[where],
        sunlit_fraction=light.sunlit_fraction[where],
        earth_distance_m=light.earth_distance_m[where],
    )


def _radar_frame(
    target: Target,
    track: LineOfSightTrack,
    time_s: float,
    waveform: Waveform,
    random: np.random.Generator,
) -> Outlined:
    """Return the radar frame whose interval holds a moment."""
    middle = int(np.argmin(np.abs(track.time_s - time_s)))
    turn_rad = waveform.wavelength_m / (2 * ImagingSettings().cross_range_resolution_m)
    turn = accumulated_turn_rad(track.line_of_sight)
    span_rad = 0.505 * turn_rad * np.array([-1, 1])
    start, stop = (int(pulse) for pulse in np.searchsorted(turn, turn[middle] + span_rad))
    history = simulate_echoes(
        surface_scatterers(target, count=20_000, random=random),
        track.part(start, stop + 1),
        waveform,
        signal_to_noise_db=20.0,
        random=random,
    )
    frame = next(iter(frames(history, ImagingSettings())))
    return outlined(frame, target)


def _outline_figures(found: list[Outlined], target: Target) -> tuple[Figure, ...]:
    errors = np.concatenate([sunward_errors_px(each) for each in found])
    near = errors[np.abs(errors) < LOST_PX]
    true, shadow, strict = (
        agreement(found, target, rule, HULL_SPACING_M) for rule in (None, *RULES)
    )
    return (
        Figure(
            name="area of the outline with the sun 5° from behind the observer, error",
            value=abs(area_error_percent(found[0])),
            unit="%",
            wanted="<= 5 %",
        ),
        Figure(
            name="edge toward the sun, bias",
            value=float(np.median(near)),
            unit="px",
            wanted="<= 0.5 px",
        ),
        Figure(
            name="edge toward the sun, rms",
            value=float(np.sqrt(np.mean(near**2))),
            unit="px",
            wanted="<= 1 px",
        ),
        Figure(
            name="edge toward the sun, unlit share",
            value=100 * float(np.mean(errors <= -LOST_PX)),
            unit="%",
            wanted="<= 3 %",
        ),
        Figure(
            name=f"hull of {len(found)} true outlines, IoU",
            value=true.intersection_over_union,
        ),
        Figure(
            name=f"hull of {len(found)} sunlit frames, shadow rule, IoU",
            value=shadow.intersection_over_union,
        ),
        Figure(
            name=f"hull of {len(found)} sunlit frames, shadow rule, coverage",
            value=shadow.coverage,
            wanted=">= 0.95",
        ),
        Figure(
            name=f"hull of {len(found)} sunlit frames, as they stand, IoU",
            value=strict.intersection_over_union,
        ),
        Figure(
            name=f"hull of {len(found)} sunlit frames, as they stand, coverage",
            value=strict.coverage,
        ),
    )


def _pass_figures(scene: Scene) -> tuple[Figure, ...]:
    phases = [_phase_deg(each) for each in scene.found]
    fit = [phase <= np.rad2deg(MOST_PHASE_RAD) for phase in phases]
    return (
        Figure(name="pass at dusk, largest phase angle", value=max(phases), unit="°"),
        Figure(name="pass at dusk, least phase angle", value=min(phases), unit="°"),
        Figure(name="pass at dusk, frames fit to carve", value=100 * float(np.mean(fit)), unit="%"),
    )


def _phase_deg(each: Outlined) -> float:
    sun = each.frame.sun_direction
    return float(np.rad2deg(phase_angle_rad(each.frame.line_of_sight, np.asarray(sun))))


def _largest(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    return float(np.abs(values).max())
