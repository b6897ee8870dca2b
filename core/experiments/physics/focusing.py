"""Autofocus held against simulated translations and against measured echoes."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.arrays import Floats
from core.experiments.physics.part import Part, Progress
from core.experiments.pictures import Picture
from core.experiments.results import Figure
from core.formats.gotcha import read_gotcha
from core.frame import Frame
from core.geometry.track import random_views_track
from core.radar.autofocus import image_entropy, phase_corrected, without_drift, without_line
from core.radar.echoes import simulate_echoes
from core.radar.imaging import ImagingSettings, frames, whole_frame
from core.radar.phase_history import PhaseHistory
from core.radar.range_alignment import aligned
from core.radar.refocusing import Autofocus, PulseCorrection, RefocusSettings, pulse_correction
from core.radar.scatterers import surface_scatterers
from core.radar.waveform import Waveform
from core.targets import tiangong_like

VIEWS = 6
PULSES = 256
SCATTERERS = 6000
SIGNAL_TO_NOISE_DB = 20.0
POLYNOMIAL_M = 3.0
"""Way that the target strays smoothly during an interval, end to end."""
RANDOM_CELLS = 1.0
"""Range cells over which every pulse's place is spread at random."""
GOTCHA_CURVE_RAD, GOTCHA_RANDOM_RAD = 40.0, 1.5
"""Phase errors put into the measured echoes: a cubic this deep, and white ones up to ± this."""
GOTCHA_PIXELS = 400
"""Of 0.2 m, a side of the measured scene's pictures."""
WANTED = "<= 2 %"
FINDERS: tuple[Autofocus, ...] = ("phase-gradient", "minimum-entropy")

OWN, BARE, DISTURBED = "own phases", "taken away", "error put in"

Named = Mapping[str, Frame]


def focusing_part(progress: Progress, gotcha: Path | None = None) -> Part:
    """Restore focus from echoes alone and compare with echoes that had no error.

    Simulated: a Tiangong-like body seen from random directions whose translation, a cubic of 3 m
    and a range cell at random from pulse to pulse, nobody knows. Measured: AFRL's Gotcha history,
    as received (the files' own autofocus phases taken away), with those phases, with ours found
    from the data, and with a known error of tens of radians put in and found again.

    Args:
        progress: told after every step.
        gotcha: folder of the measured files; None leaves their figures out.

    Raises:
        ValueError: the folder holds no such files.
    """
    measured = Part(figures=()) if gotcha is None else _measured(gotcha, progress)
    simulated = _simulated(progress)
    return Part(
        figures=simulated.figures + measured.figures,
        pictures=simulated.pictures + measured.pictures,
    )


def translation_m(pulses: int, cell_m: float, random: np.random.Generator) -> Floats:
    """Return an unknown way along range, (pulses,): a cubic, and a cell at random."""
    time = np.linspace(-1, 1, pulses)
    smooth = np.polynomial.Polynomial([0, *random.uniform(-1, 1, 3)])(time)
    scattered = random.uniform(-0.5, 0.5, pulses) * RANDOM_CELLS * cell_m
    way: Floats = POLYNOMIAL_M * smooth / np.ptp(smooth) + scattered
    return way


def _simulated(progress: Progress) -> Part:
    shown: Named = {}
    excess: dict[str, list[float]] = {}
    random = np.random.default_rng(1)
    for view in range(VIEWS):
        named = _simulated_frames(random)
        entropy = {name: image_entropy(frame.amplitude) for name, frame in named.items()}
        for name, value in entropy.items():
            excess.setdefault(name, []).append(100 * (value / entropy["without error"] - 1))
        shown = shown or named
        progress("simulated translation", view + 1, VIEWS)
    received = Figure(
        name="simulated translation: mean entropy above error-free, not focused",
        value=float(np.mean(excess["as received"])),
        unit="%",
    )
    found = tuple(
        Figure(
            name=f"simulated translation: entropy off error-free, {name}, worst of {VIEWS} views",
            value=float(np.abs(excess[name]).max()),
            unit="%",
            wanted=WANTED,
        )
        for name in FINDERS
    )
    picture = Picture(
        name="focus-simulated",
        caption="A Tiangong-like body whose unknown translation, 3 m and a range cell at random "
        "from pulse to pulse, is found from its echoes; dB of each image's peak.",
        draw=lambda canvas: _draw(canvas, shown, floor_db=-50),
        size_in=(12.0, 3.6),
    )
    return Part(figures=(received, *found), pictures=(picture,))


def _simulated_frames(random: np.random.Generator) -> Named:
    waveform = Waveform()
    track = random_views_track(
        views=1,
        turn_rad=waveform.wavelength_m / (2 * ImagingSettings().cross_range_resolution_m),
        pulses_per_view=PULSES,
        pulse_repetition_frequency_hz=waveform.pulse_repetition_frequency_hz,
        random=random,
    )
    history = simulate_echoes(
        surface_scatterers(tiangong_like(), count=SCATTERERS, random=random),
        track,
        waveform,
        signal_to_noise_db=SIGNAL_TO_NOISE_DB,
        random=random,
    )
    way_m = translation_m(PULSES, waveform.range_resolution_m, random)
    received = aligned(history, -way_m)
    found = {
        name: pulse_correction(received, RefocusSettings(autofocus=name)).removed_from(received)
        for name in FINDERS
    }
    echoes: dict[str, PhaseHistory] = {
        "without error": history,
        "as received": received,
        **{str(name): fixed for name, fixed in found.items()},
    }
    settings = ImagingSettings(shape=(384, 384), pixel_spacing_m=0.08)
    return {name: next(frames(each, settings)) for name, each in echoes.items()}


def _measured(folder: Path, progress: Progress) -> Part:
    paths = sorted(folder.glob("data_3dsar_*.mat"))
    bare, own = read_gotcha(paths), read_gotcha(paths, autofocus=True)
    error_rad = _known_error_rad(len(bare.track))
    disturbed = phase_corrected(bare, -error_rad)
    named = {OWN: _gotcha_frame(own), BARE: _gotcha_frame(bare)}
    own_rad = _own_phases_rad(bare, own)
    own_rms = float(without_line(own_rad).std())
    figures = [Figure(name="Gotcha: rms of its own phases about a line", value=own_rms, unit="rad")]
    for done, name in enumerate(FINDERS, start=1):
        fix = _phases(bare, name)
        named[f"{BARE}, {name}"] = _gotcha_frame(fix.removed_from(bare))
        alike = float(np.corrcoef(without_line(fix.phase_rad), without_line(own_rad))[0, 1])
        figures.append(
            Figure(name=f"Gotcha: correlation of its own phases with {name}'s", value=alike)
        )
        progress("measured echoes", done, 2 * len(FINDERS))
    named[DISTURBED] = _gotcha_frame(disturbed)
    for done, name in enumerate(FINDERS, start=1 + len(FINDERS)):
        fix = _phases(disturbed, name)
        named[f"{DISTURBED}, {name}"] = _gotcha_frame(fix.removed_from(disturbed))
        left_rad = _turns_apart_rad(fix.phase_rad, error_rad)
        figures.append(
            Figure(name=f"Gotcha: rms of the error that {name} leaves", value=left_rad, unit="rad")
        )
        progress("measured echoes", done, 2 * len(FINDERS))
    return Part(figures=(*_gotcha_figures(named), *figures), pictures=(_gotcha_picture(named),))


def _phases(history: PhaseHistory, name: Autofocus) -> PulseCorrection:
    return pulse_correction(history, RefocusSettings(autofocus=name, aligns=False))


def _known_error_rad(pulses: int) -> Floats:
    time = np.linspace(-1, 1, pulses)
    random = np.random.default_rng(1)
    white = random.uniform(-GOTCHA_RANDOM_RAD, GOTCHA_RANDOM_RAD, pulses)
    # Its drift would only shift the scene, and what the picture's edge cuts off would count.
    return without_drift(GOTCHA_CURVE_RAD * (time**2 + time**3 / 2) + white)


def _own_phases_rad(bare: PhaseHistory, own: PhaseHistory) -> Floats:
    """Return the phases, (pulses,), that the files' own correction takes out mid-band."""
    middle = len(bare.frequency_hz) // 2
    turned = own.samples[:, middle] * np.conj(bare.samples[:, middle])
    phases: Floats = -np.unwrap(np.angle(turned.astype(np.complex128)))
    return phases


def _turns_apart_rad(one_rad: Floats, other_rad: Floats) -> float:
    """Return the rms about a line of two phases' difference, whole turns taken out of it."""
    apart = np.unwrap(np.angle(np.exp(1j * (without_line(one_rad) - without_line(other_rad)))))
    return float(without_line(apart).std())


def _gotcha_frame(history: PhaseHistory) -> Frame:
    shape = GOTCHA_PIXELS, GOTCHA_PIXELS
    settings = ImagingSettings(method="backprojection", shape=shape, pixel_spacing_m=0.2)
    return whole_frame(history, settings)


def _gotcha_figures(named: Named) -> tuple[Figure, ...]:
    """Return every image's contrast, and its entropy over that with the files' own phases."""
    own = image_entropy(named[OWN].amplitude)
    figures = []
    for name, frame in named.items():
        contrast_db = _contrast_db(frame)
        figures.append(
            Figure(name=f"Gotcha: peak over median, {name}", value=contrast_db, unit="dB")
        )
        if name != OWN:
            excess = 100 * (image_entropy(frame.amplitude) / own - 1)
            wanted = WANTED if "," in name else None
            title = f"Gotcha: entropy above that with its own phases, {name}"
            figures.append(Figure(name=title, value=excess, unit="%", wanted=wanted))
    return tuple(figures)


def _contrast_db(frame: Frame) -> float:
    return float(20 * np.log10(frame.amplitude.max() / np.median(frame.amplitude)))


def _gotcha_picture(named: Named) -> Picture:
    return Picture(
        name="focus-measured",
        caption="Measured Gotcha scene, 80 m a side: with the files' own phases, without, with "
        "phases found from the data, and with tens of radians put in and found again; dB of each "
        "image's peak.",
        draw=lambda canvas: _draw(canvas, named, floor_db=-55),
        size_in=(13.0, 7.0),
    )


def _draw(canvas: Canvas, named: Named, *, floor_db: float) -> None:
    """Draw frames in rows of four, range downward."""
    rows = -(-len(named) // 4)
    places = canvas.subplots(rows, 4, squeeze=False).ravel()
    for place, (name, frame) in zip(places, named.items(), strict=False):
        height_m, width_m = (count * (frame.row_spacing_m or 1) for count in frame.shape)
        place.imshow(
            frame.decibels(),
            vmin=floor_db,
            vmax=0,
            extent=(-width_m / 2, width_m / 2, height_m / 2, -height_m / 2),
        )
        place.grid(visible=False)
        place.set(title=name, xlabel="cross-range, m", ylabel="range, m")
    for place in places[len(named) :]:
        place.remove()
