"""The imaging part of the physics experiment: responses, axes, and the equality of methods."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.arrays import Floats
from core.experiments.demo import demo_tracks
from core.experiments.physics.imaging_pictures import cuts_picture, responses_picture
from core.experiments.physics.part import Part, Progress
from core.experiments.physics.point_spread import PIXEL_M, PointResponse, respond, with_points
from core.experiments.results import Figure
from core.geometry.track import LineOfSightTrack, random_views_track
from core.radar.imaging import ImagingSettings, Method, interval_frame, whole_interval
from core.radar.intervals import CoherentInterval, divide
from core.radar.phase_history import PhaseHistory
from core.radar.waveform import Waveform
from core.radar.window import HAMMING, Window, taylor

SHARP: tuple[Method, ...] = ("polar", "keystone")
METHODS: tuple[Method, ...] = ("range-doppler", *SHARP)
NAMES = {"polar": "polar format", "keystone": "keystone", "range-doppler": "plain range-Doppler"}

PLACES = {
    "on the axis": (0.0, 0.0),
    "10 m off in range": (10.0, 0.0),
    "10 m off in cross-range": (0.0, 10.0),
}
"""Of the points, (range, cross-range) in metres."""

PASSES = (0, 1, 2)
"""Of the demo's, along which responses are measured."""

SHARES = (0.06, 0.5, 0.8)
"""Where along each pass a response is measured."""

SHOWN = 2
"""Which of all probes the pictures show."""

SIDES = 24
"""From which an unlike set of points is looked at by every method."""

CORNERS_M = np.array([[0.0, 0, 0], [4.0, 0, 0], [0, 2.5, 1.0], [-1.0, -2.0, 3.0]])
STRENGTHS = np.array([1.0, 1.3, 1.7, 2.2])
CLEAR_M = 1.2
"""Between two points in an image, so that neither stands in the other's main lobe."""

Probe = tuple[PhaseHistory, CoherentInterval]


def imaging_part(progress: Progress) -> Part:
    """Measure point responses along the demo's passes, the axes' signs and the methods' equality.

    Args:
        progress: told of stage, steps done and steps in all.
    """
    waveform = Waveform()
    tracks = demo_tracks(waveform)
    probes = [probe for number in PASSES for probe in _probes(tracks[number], waveform)]
    responses = _responses(probes, progress)
    by_taylor = _respond_everywhere(probes[SHOWN], "polar", taylor())
    figures = [figure for method in SHARP for figure in _sharp_figures(method, responses[method])]
    figures += _response_figures("polar format, Taylor −35 dB", by_taylor, taylor())
    figures += _smear_figures(responses["range-doppler"])
    figures += [
        _doppler_figure(tracks, waveform),
        *_side_figures(waveform, progress),
        *_equality_figures(probes[1]),
    ]
    # Late in the first pass the line of sight turns unevenly, as it does but for culminations.
    shown = {NAMES[method]: responses[method][SHOWN] for method in METHODS}
    return Part(
        figures=tuple(figures),
        pictures=(
            responses_picture(shown),
            cuts_picture(
                {
                    "Hamming": (HAMMING, shown[NAMES["polar"]]["10 m off in cross-range"]),
                    "Taylor −35 dB": (taylor(), by_taylor["10 m off in cross-range"]),
                }
            ),
        ),
    )


def _probes(track: LineOfSightTrack, waveform: Waveform) -> list[Probe]:
    """Return silent echoes of some intervals of a pass, for points to be put into."""
    intervals = divide(
        track,
        wavelength_m=waveform.wavelength_m,
        cross_range_resolution_m=ImagingSettings().cross_range_resolution_m,
    )
    return [
        _silent(track, intervals[int(share * (len(intervals) - 1))], waveform) for share in SHARES
    ]


def _silent(track: LineOfSightTrack, interval: CoherentInterval, waveform: Waveform) -> Probe:
    part = track.part(interval.start, interval.stop)
    frequency = waveform.frequencies_hz()
    samples = np.zeros((len(part), len(frequency)), dtype=np.complex64)
    return PhaseHistory(samples=samples, frequency_hz=frequency, track=part), interval.alone()


def _respond_everywhere(probe: Probe, method: Method, window: Window) -> dict[str, PointResponse]:
    return {
        name: respond(*probe, place, method=method, window=window, pixel_m=PIXEL_M)
        for name, place in PLACES.items()
    }


def _responses(
    probes: Sequence[Probe], progress: Progress
) -> dict[Method, list[dict[str, PointResponse]]]:
    found: dict[Method, list[dict[str, PointResponse]]] = {method: [] for method in METHODS}
    for done, probe in enumerate(probes, start=1):
        for method in METHODS:
            found[method].append(_respond_everywhere(probe, method, HAMMING))
        progress("point responses", done, len(probes))
    return found


def _sharp_figures(method: Method, responses: Sequence[dict[str, PointResponse]]) -> list[Figure]:
    """Return the worst of all probes, on and off the axis."""
    worst = {place: [each[place] for each in responses] for place in PLACES}
    return [
        figure
        for place, members in worst.items()
        for figure in _figures_of(f"{NAMES[method]}, {place}", members, HAMMING)
    ]


def _response_figures(
    title: str, responses: dict[str, PointResponse], window: Window
) -> list[Figure]:
    return _figures_of(f"{title}, on the axis and off", list(responses.values()), window)


def _figures_of(title: str, members: Sequence[PointResponse], window: Window) -> list[Figure]:
    sidelobe_db = max(abs(each.sidelobe_db - window.highest_sidelobe_db) for each in members)
    return [
        Figure(
            name=f"{title}: peak out of place, worst",
            value=max(each.error_cells for each in members),
            unit="cells",
            wanted="<= 0.05 cells",
        ),
        Figure(
            name=f"{title}: −3 dB width from the window's, worst",
            value=100 * max(each.width_error for each in members),
            unit="%",
            wanted="<= 5 %",
        ),
        Figure(
            name=f"{title}: highest sidelobe from the window's, worst",
            value=sidelobe_db,
            unit="dB",
            wanted="<= 1 dB",
        ),
    ]


def _smear_figures(responses: Sequence[dict[str, PointResponse]]) -> list[Figure]:
    """Return what plain range-Doppler does to points; nothing is wanted of it."""
    figures = []
    for place in PLACES:
        members = [each[place] for each in responses]
        figures += [
            Figure(
                name=f"plain range-Doppler, {place}: −3 dB width from the window's, worst",
                value=100 * max(each.width_error for each in members),
                unit="%",
            ),
            Figure(
                name=f"plain range-Doppler, {place}: peak lost, worst",
                value=max(0.0, -20 * float(np.log10(min(each.peak for each in members)))),
                unit="dB",
            ),
        ]
    return figures


def _doppler_figure(tracks: Sequence[LineOfSightTrack], waveform: Waveform) -> Figure:
    """Return how far f_d = −(2/λ) dk/dt·p is from the differences of true distances."""
    point_m = np.array([5.0, -7.0, 3.0])
    worst_hz = 0.0
    for track in tracks:
        if track.range_m is None:
            raise ValueError("A pass of an orbit has ranges.")
        radar_m = -track.range_m[:, None] * track.line_of_sight
        beyond_m = np.linalg.norm(point_m - radar_m, axis=1) - track.range_m
        by_range_hz = np.gradient(beyond_m, track.time_s)[2:-2]
        by_rate_hz = (track.line_of_sight_rate_per_s @ point_m)[2:-2]
        worst_hz = max(worst_hz, float(np.abs(by_range_hz - by_rate_hz).max()))
    return Figure(
        name="Doppler from the finite difference of range, along three passes, worst",
        value=2 / waveform.wavelength_m * worst_hz,
        unit="Hz",
        wanted="<= 0.01 Hz",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Seen:
    """How many of the unlike points were looked for, and how many were not where they should be."""

    looked_for: int = 0
    out_of_place: int = 0


def _side_figures(waveform: Waveform, progress: Progress) -> list[Figure]:
    """Look at four unlike points from random sides, where a mirrored axis would misplace them."""
    random = np.random.default_rng(1)
    # At 0.3 m even plain range-Doppler keeps points within a few metres.
    track = random_views_track(
        views=SIDES,
        turn_rad=waveform.wavelength_m / 0.6,
        pulses_per_view=160,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
        random=random,
    )
    methods: tuple[Method, ...] = (*METHODS, "backprojection")
    seen = dict.fromkeys(methods, _Seen())
    for done, (start, stop) in enumerate(track.bursts(), start=1):
        interval = CoherentInterval(start=start, stop=stop, middle=(start + stop) // 2, turn_rad=0)
        silent, _ = _silent(track, interval, waveform)
        echoes = with_points(silent, CORNERS_M, STRENGTHS)
        for method in methods:
            seen[method] = _looked(echoes, method, seen[method])
        progress("sides", done, SIDES)
    return [
        Figure(
            name=f"{NAMES.get(method, method)}: points out of place, of {each.looked_for} from "
            f"{SIDES} sides",
            value=each.out_of_place,
            wanted="<= 0",
        )
        for method, each in seen.items()
    ]


def _looked(echoes: PhaseHistory, method: Method, before: _Seen) -> _Seen:
    settings = ImagingSettings(method=method, shape=(96, 96), pixel_spacing_m=0.12)
    frame = interval_frame(echoes, whole_interval(echoes), settings)
    places = frame.projection.image_points(CORNERS_M)
    clear = _nearest(places) * 0.12 > CLEAR_M
    wrong = 0
    for (row, column), strength in zip(
        np.round(places[clear]).astype(int), STRENGTHS[clear], strict=True
    ):
        near = frame.amplitude[row - 1 : row + 2, column - 1 : column + 2].max()
        wrong += not abs(float(near) / strength - 1) < 0.25
    return _Seen(
        looked_for=before.looked_for + int(clear.sum()), out_of_place=before.out_of_place + wrong
    )


def _nearest(places: Floats) -> Floats:
    apart = np.linalg.norm(places[:, None] - places[None], axis=-1)
    nearest: Floats = (apart + np.diag(np.full(len(places), np.inf))).min(axis=1)
    return nearest


def _equality_figures(probe: Probe) -> list[Figure]:
    """Hold the fast methods against back-projection on random scatterers."""
    random = np.random.default_rng(2)
    amplitude = random.normal(size=12)
    silent, interval = probe
    echoes = with_points(silent, random.uniform(-4, 4, (12, 3)), amplitude)
    made = {
        method: interval_frame(
            echoes,
            interval,
            ImagingSettings(method=method, shape=(96, 96), pixel_spacing_m=0.12),
        ).amplitude
        for method in (*SHARP, "backprojection")
    }
    peak = float(made["backprojection"].max())
    return [
        Figure(
            name=f"{NAMES[method]} differs from back-projection by up to, of the peak",
            value=100 * float(np.abs(made[method] - made["backprojection"]).max()) / peak,
            unit="%",
            wanted="<= 2 %",
        )
        for method in SHARP
    ]
