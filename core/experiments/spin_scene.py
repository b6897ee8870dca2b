"""A spinning target that three stations see at once: its orbit, its echoes and their images."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np

from core.experiments.frame_pictures import OutlinedFrame
from core.frame import Frame
from core.geometry.orbit import MeanElements, Station, inertial_track, satellite_from_elements
from core.geometry.spin import Spin
from core.geometry.track import LineOfSightTrack
from core.parallel import in_order
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, whole_frame, whole_interval
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import Scatterers
from core.radar.waveform import Waveform
from core.registration.spin import SpinningOutline
from core.silhouettes.extraction import extract_silhouette

ORBIT = MeanElements(
    name="770 km",
    epoch_utc=datetime(2024, 5, 20, 20, tzinfo=UTC),
    inclination_deg=98.5,
    node_deg=240.0,
    eccentricity=0.0001,
    argument_of_perigee_deg=90.0,
    mean_anomaly_deg=0.0,
    mean_motion_rev_per_day=14.38,
)
"""A polar orbit 770 km up, where large satellites that spin out of control are found."""

EPOCH_UTC = datetime(2024, 5, 21, 15, 48, tzinfo=UTC)
"""Middle of the two minutes that are seen; all stations have it more than 30° high."""

STATIONS = (
    Station(latitude_deg=39.9, longitude_deg=116.4, height_m=88.0, name="Beijing"),
    Station(latitude_deg=34.3, longitude_deg=108.9, height_m=400.0, name="Xi'an"),
    Station(latitude_deg=36.1, longitude_deg=120.4, height_m=30.0, name="Qingdao"),
)
"""Their lines of sight lie 39° to 60° apart, and turn by 42° to 58° meanwhile."""

AXIS = (0.5, 0.3, 0.81)
"""Of the true spin, inertial; askew to the target, whose axes are inertial at the epoch."""

SPAN_S = 120.0
PULSES_PER_TURN_RAD = 150 * 180 / np.pi
"""Enough to tell the whole image's cross-range apart at any rate of the spin."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpinningEchoes:
    """Echoes of one image, with the line of sight as the tracking gives it: inertial.

    Attributes:
        station: number of the station.
        track: at every pulse, inertial.
        history: as received; its own track is the truth's and is not looked at.
    """

    station: int
    track: LineOfSightTrack
    history: PhaseHistory


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpunFrame:
    """An image formed under an assumed spin.

    Attributes:
        station: number of the station.
        found: the image, projected as that spin has it, and its silhouette.
        outline: the same silhouette in range and Doppler, for any spin.
    """

    station: int
    found: OutlinedFrame
    outline: SpinningOutline


def true_spin(rate_deg_per_s: float) -> Spin:
    """Return the spin of the target at a rate."""
    return Spin(axis=np.array(AXIS), rate_rad_per_s=float(np.deg2rad(rate_deg_per_s)))


def spinning_echoes(
    points: Scatterers,
    spin: Spin,
    *,
    frames: int,
    signal_to_noise_db: float,
    random: np.random.Generator,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[SpinningEchoes]:
    """Return the echoes of images that all stations take evenly over two minutes.

    Each image's pulses last as long as the spin takes to turn by λ/2ρ, so that cross-range is
    coarser than ρ where the line of sight lies askew to the spin's plane. Stations take turns.

    Args:
        points: of the target.
        spin: the true one.
        frames: images of each station.
        signal_to_noise_db: as in `simulate_echoes`.
        random: for the noise.
        progress: told of images done and in all.
    """
    waveform = Waveform(pulse_repetition_frequency_hz=PULSES_PER_TURN_RAD * spin.rate_rad_per_s)
    turn_rad = waveform.wavelength_m / (2 * ImagingSettings().cross_range_resolution_m)
    pulses = np.arange(round(turn_rad * PULSES_PER_TURN_RAD))
    burst_s = (pulses - len(pulses) // 2) / waveform.pulse_repetition_frequency_hz
    satellite = satellite_from_elements(ORBIT)

    def echoes(work: tuple[int, float, np.random.Generator]) -> SpinningEchoes:
        number, middle_s, of_noise = work
        track = inertial_track(
            satellite, STATIONS[number], epoch_utc=EPOCH_UTC, time_s=middle_s + burst_s
        )
        history = simulate_echoes(
            points,
            spin.target_track(track),
            waveform,
            signal_to_noise_db=signal_to_noise_db,
            random=of_noise,
        )
        return SpinningEchoes(station=number, track=track, history=history)

    slots = SPAN_S * ((np.arange(frames * len(STATIONS)) + 0.5) / (frames * len(STATIONS)) - 0.5)
    works = [
        (index % len(STATIONS), float(middle_s), of_noise)
        for index, (middle_s, of_noise) in enumerate(
            zip(slots, random.spawn(len(slots)), strict=True)
        )
    ]
    received = []
    for each in in_order(echoes, works):
        received.append(each)
        progress(len(received), len(works))
    return received


def spun_frames(received: Sequence[SpinningEchoes], spin: Spin) -> list[SpunFrame]:
    """Return images of echoes under an assumed spin, with the silhouettes found in them.

    Only echoes and inertial lines of sight are used. Images without a target are left out.
    """
    imaged = list(in_order(lambda each: _spun_frame(each, spin), received))
    return [each for each in imaged if not each.outline.silhouette.is_empty]


def _spun_frame(echoes: SpinningEchoes, spin: Spin) -> SpunFrame:
    history = PhaseHistory(
        samples=echoes.history.samples,
        frequency_hz=echoes.history.frequency_hz,
        track=spin.target_track(echoes.track),
    )
    settings = ImagingSettings()
    middle = whole_interval(history).middle
    frame: Frame = whole_frame(history, settings)
    silhouette = extract_silhouette(frame)
    row_m, column_m = settings.spacing_m
    rate_rad_per_s = float(np.linalg.norm(history.track.line_of_sight_rate_per_s[middle]))
    return SpunFrame(
        station=echoes.station,
        found=OutlinedFrame(frame=frame, silhouette=silhouette),
        outline=SpinningOutline(
            silhouette=silhouette,
            time_s=float(echoes.track.time_s[middle]),
            line_of_sight=echoes.track.line_of_sight[middle],
            line_of_sight_rate_per_s=echoes.track.line_of_sight_rate_per_s[middle],
            row_spacing_m=row_m,
            column_spacing_m_per_s=column_m * rate_rad_per_s,
        ),
    )
