"""Simulated echoes held against what was asked for: noise, flashes, a bistatic pair, speed."""

from dataclasses import dataclass
from time import perf_counter

import numpy as np
import trimesh
from numpy.typing import NDArray

from core.arrays import Floats
from core.experiments.physics.bounds import bounded, decibels
from core.experiments.physics.part import Part
from core.experiments.physics.scattering_pictures import PeakSeries, glint_picture
from core.experiments.results import Figure
from core.geometry.bistatic import bistatic_track
from core.geometry.track import LineOfSightTrack, random_views_track, track_from_angles
from core.parallel import in_order
from core.radar.echoes import ScatteringModel, simulate_echoes
from core.radar.imaging import ImagingSettings, frames
from core.radar.phase_history import PhaseHistory
from core.radar.scatterers import surface_scatterers
from core.radar.scattering_models import ModelName, scattering_model
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S, Waveform
from core.targets import Target, tiangong_like

GLINT_FRAMES, GLINT_PULSES, GLINT_STEP_RAD = 30, 160, 0.06
"""Of the series in which facets flash: one after the other, over 103° of azimuth."""

SPEED_FRAMES, SPEED_PULSES, SPEED_SCATTERERS = 60, 256, 125_000
"""Of the simulation whose time is taken."""


def noise_part() -> Part:
    """Compare the noise that a stated ratio gives with the mean echo power."""
    waveform = Waveform(frequency_count=64)
    ball = Target(name="ball", parts=(trimesh.creation.icosphere(subdivisions=3, radius=1.0),))
    track = _burst(256, waveform, seed=3)
    figures = []
    names: tuple[ModelName, ...] = ("diffuse", "physical-optics", "mixed")
    for name in names:
        model = scattering_model(ball, name, random=np.random.default_rng(2), scatterers=10_000)
        quiet, loud = (
            simulate_echoes(
                model, track, waveform, signal_to_noise_db=ratio, random=np.random.default_rng(5)
            ).samples
            for ratio in (300.0, 20.0)
        )
        ratio_db = decibels(model.mean_echo_power() / np.mean(np.abs(loud - quiet) ** 2))
        figures.append(
            bounded(f"signal-to-noise, {name}, off 20 dB", abs(ratio_db - 20), "<= 0.2 dB")
        )
    return Part(figures=tuple(figures))


def bistatic_part() -> Part:
    """Image points of a pair from delays written out, and see how far off they land."""
    waveform, time_s = Waveform(), np.arange(600) / 100
    sender = track_from_angles(time_s, 0.2 + 0 * time_s, 0.03 * time_s)
    receiver = track_from_angles(time_s, 0.9 - 0.004 * time_s, 0.6 + 0.015 * time_s)
    pair, frequency = bistatic_track(sender, receiver), waveform.frequencies_hz()
    settings = ImagingSettings(shape=(256, 256))
    worst_m = 0.0
    for point_m in np.random.default_rng(4).uniform(-4, 4, (5, 3)):
        way_m = (sender.line_of_sight + receiver.line_of_sight) @ point_m
        samples = np.exp(-2j * np.pi / SPEED_OF_LIGHT_M_PER_S * np.outer(way_m, frequency))
        history = PhaseHistory(samples=samples, frequency_hz=frequency, track=pair)
        for frame in frames(history, settings):
            off = _peak(frame.amplitude) - frame.projection.image_points(point_m)
            worst_m = max(worst_m, float(np.abs(off).max()) * settings.pixel_spacing_m)
    between = np.sum(sender.line_of_sight * receiver.line_of_sight, axis=1)
    angle_deg = np.rad2deg(np.arccos(between)).mean()
    return Part(
        figures=(
            Figure(name="bistatic angle", value=float(angle_deg), unit="°"),
            bounded("bistatic points, largest distance from their place", worst_m, "<= 0.015 m"),
        )
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Scene:
    """One burst of the series."""

    model: ScatteringModel
    track: LineOfSightTrack


def glint_part() -> Part:
    """Follow the brightest pixel from frame to frame, under each model of the surface."""
    tracks = [
        track_from_angles(
            np.arange(GLINT_PULSES) / 100,
            np.full(GLINT_PULSES, -0.45),
            start + np.linspace(0, GLINT_STEP_RAD, GLINT_PULSES),
        )
        for start in GLINT_STEP_RAD * np.arange(GLINT_FRAMES)
    ]
    target = tiangong_like()
    series = {}
    names: tuple[ModelName, ...] = ("diffuse", "mixed", "physical-optics")
    for name in names:
        model = scattering_model(target, name, random=np.random.default_rng(6), roughness=0.5)
        scenes = [_Scene(model=model, track=track) for track in tracks]
        series[name] = decibels(np.array(list(in_order(_brightest, scenes))) ** 2)
    change = {name: float(np.sqrt(np.mean(np.diff(peaks) ** 2))) for name, peaks in series.items()}
    return Part(
        figures=(
            *(
                Figure(name=f"peak's change from frame to frame, {name}, rms", value=db, unit="dB")
                for name, db in change.items()
            ),
            bounded(
                "peak's change of mirrors over that of points",
                change["physical-optics"] / change["diffuse"],
                ">= 2",
            ),
        ),
        pictures=(
            glint_picture(
                [PeakSeries(name=name, peak_db=peaks) for name, peaks in series.items()],
                azimuth_deg=np.rad2deg(GLINT_STEP_RAD * (np.arange(GLINT_FRAMES) + 0.5)),
            ),
        ),
    )


def _brightest(scene: _Scene) -> float:
    history = simulate_echoes(
        scene.model,
        scene.track,
        Waveform(),
        signal_to_noise_db=40.0,
        random=np.random.default_rng(7),
    )
    frame = next(frames(history, ImagingSettings(shape=(320, 320), cross_range_resolution_m=0.17)))
    return float(frame.amplitude.max())


def speed_part() -> Part:
    """Time the diffuse model at the size of a whole observation."""
    waveform = Waveform()
    points = surface_scatterers(
        tiangong_like(), count=SPEED_SCATTERERS, random=np.random.default_rng(8)
    )
    scenes = [
        _Scene(model=points, track=_burst(SPEED_PULSES, waveform, seed=number))
        for number in range(SPEED_FRAMES)
    ]
    started = perf_counter()
    for _ in in_order(_simulated, scenes):
        pass
    name = f"{SPEED_SCATTERERS} points × {SPEED_PULSES} pulses × {SPEED_FRAMES} frames, wall time"
    return Part(figures=(bounded(name, perf_counter() - started, "<= 15 s"),))


def _simulated(scene: _Scene) -> PhaseHistory:
    return simulate_echoes(
        scene.model,
        scene.track,
        Waveform(),
        signal_to_noise_db=20.0,
        random=np.random.default_rng(9),
    )


def _burst(pulses: int, waveform: Waveform, *, seed: int) -> LineOfSightTrack:
    return random_views_track(
        views=1,
        turn_rad=waveform.wavelength_m / 0.3,
        pulses_per_view=pulses,
        pulse_repetition_frequency_hz=100.0,
        random=np.random.default_rng(seed),
    )


def _peak(amplitude: NDArray[np.float32]) -> Floats:
    """Return the (row, column) of the brightest pixel, between pixels by parabolas in dB."""
    row, column = np.unravel_index(np.argmax(amplitude), amplitude.shape)
    place = []
    for line, at in ((amplitude[:, column], row), (amplitude[row], column)):
        left, middle, right = decibels(line[at - 1 : at + 2])
        place.append(float(at) + 0.5 * (left - right) / (left - 2 * middle + right))
    return np.array(place)
