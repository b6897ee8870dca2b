"""The pictures of the scattering part."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from core.arrays import Floats
from core.experiments.physics.bounds import decibels
from core.experiments.pictures import Picture

FOUND, THEORY, THIRD = "#58b4ff", "#ffb454", "#7fd48a"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sweep:
    """Cross-sections along a line of aspects or sizes.

    Attributes:
        place: (steps,) in degrees or wavelengths.
        found: (steps,) of the simulation, m².
        theory: (steps,) of the textbook, m².
    """

    place: Floats
    found: Floats
    theory: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeakSeries:
    """The brightest pixel of frame after frame.

    Attributes:
        name: of the model.
        peak_db: (frames,) its power in dB of 1 m².
    """

    name: str
    peak_db: Floats


def plate_picture(sweep: Sweep) -> Picture:
    """Return a plate's pattern about its normal."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        _lines(axes, sweep, "closed form on two triangles", "4πA²/λ² cos²θ sinc²")
        axes.set(
            xlabel="angle off the normal, degrees",
            ylabel="cross-section, dB m²",
            ylim=(decibels(sweep.theory[0]) - 45, decibels(sweep.theory[0]) + 3),
            title="Square plate, 1 m, 10 GHz",
        )

    return Picture(
        name="scattering-plate",
        caption="Radar cross-section of a square plate about its normal, simulated and in theory.",
        draw=draw,
    )


def sphere_picture(sweep: Sweep, outline_m2: float) -> Picture:
    """Return a sphere's cross-section over its outline against its size."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        relative = Sweep(
            place=sweep.place, found=sweep.found / outline_m2, theory=sweep.theory / outline_m2
        )
        _lines(axes, relative, "20 480 facets", "integral over the lit half")
        for bound in (-0.5, 0.5):
            axes.axhline(bound, color=THIRD, linewidth=0.8, linestyle=":")
        axes.set(
            xscale="log",
            xticks=(1, 2, 5, 10),
            xticklabels=("1", "2", "5", "10"),
            xlabel="radius, wavelengths",
            ylabel="cross-section over πa², dB",
            title="Sphere, with the bound of ±0.5 dB",
        )
        axes.minorticks_off()

    return Picture(
        name="scattering-sphere",
        caption="Cross-section of a sphere over its outline's area, against its radius.",
        draw=draw,
    )


def corner_picture(two: Sweep, three: Sweep) -> Picture:
    """Return the patterns of both corners beside each other."""

    def draw(canvas: Canvas) -> None:
        left, right = canvas.subplots(1, 2, sharey=True)
        for axes, sweep, name, across in (
            (left, two, "Dihedral, 1 × 1 m", "angle from one plate to the other, degrees"),
            (right, three, "Trihedral, 1 m edges", "angle from an edge, degrees"),
        ):
            _lines(axes, sweep, "simulated", "maximum in theory")
            axes.set(xlabel=across, title=f"{name}, 10 GHz")
        left.set(ylabel="cross-section, dB m²", ylim=(5, 50))

    return Picture(
        name="scattering-corners",
        caption="Patterns of a dihedral and a trihedral from one to three bounces, 10 GHz.",
        draw=draw,
    )


def tube_picture(tube_wavelengths: Floats, two_db: Floats, three_db: Floats) -> Picture:
    """Return how the corners' errors at their maxima fall with the width of ray tubes."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        for name, error_db, colour in (
            ("dihedral", two_db, FOUND),
            ("trihedral", three_db, THEORY),
        ):
            axes.loglog(tube_wavelengths, error_db, "o-", color=colour, label=name, markersize=4)
        axes.axhline(1.0, color=THIRD, linewidth=0.8, linestyle=":")
        axes.set(
            xticks=(0.5, 1, 2, 5),
            xticklabels=("0.5", "1", "2", "5"),
            yticks=(0.01, 0.1, 1),
            yticklabels=("0.01", "0.1", "1"),
            xlabel="side of a ray tube, wavelengths",
            ylabel="error at the maximum, dB",
            title="Convergence of bouncing rays, with the bound of 1 dB",
        )
        axes.minorticks_off()
        axes.legend()

    return Picture(
        name="scattering-tubes",
        caption="Error of dihedral and trihedral at their maxima against the width of ray tubes.",
        draw=draw,
    )


def glint_picture(series: Sequence[PeakSeries], azimuth_deg: Floats) -> Picture:
    """Return the brightest pixel of each model from frame to frame."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots()
        for each, colour in zip(series, (FOUND, THIRD, THEORY), strict=True):
            axes.plot(
                azimuth_deg, each.peak_db, "o-", color=colour, label=each.name, markersize=3.5
            )
        axes.set(
            xlabel="azimuth of the line of sight at the frame's middle, degrees",
            ylabel="brightest pixel, dB m²",
            title="Tiangong-1-like laboratory, frame after frame",
        )
        axes.legend()

    return Picture(
        name="scattering-glint",
        caption="The brightest pixel of every frame: mirrors flash and vanish, points do not.",
        draw=draw,
    )


def _lines(axes: Axes, sweep: Sweep, found: str, theory: str) -> None:
    floor = 1e-9 * float(np.max(sweep.theory))
    axes.plot(
        sweep.place, decibels(np.maximum(sweep.theory, floor)), color=THEORY, label=theory, lw=2.6
    )
    axes.plot(sweep.place, decibels(np.maximum(sweep.found, floor)), color=FOUND, label=found)
    axes.legend()
