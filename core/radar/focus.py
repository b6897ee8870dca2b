"""Whether an interval's image can be sharp: the quadratic phase that the line of sight leaves."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from core.arrays import Floats
from core.geometry.track import LineOfSightTrack, angles_from_line_of_sight

FocusCriterion = Literal["angles", "bending", "motion"]
"""Which part of the quadratic phase counts.

angles: what θ̈ and φ̈ make, the paper's criterion (eqs. 12–16). An image former that takes the
    paper's angles for linear in time leaves it.
bending: what a line of sight that leaves the image plane makes. No image of one interval can take
    it out, since a scatterer's height above the plane is unknown: polar format, keystone and
    back-projection leave this and nothing else.
motion: all of ½k̈, which plain range-Doppler leaves, since it takes k itself for linear in time.
"""

Status = Literal["accepted", "shortened", "rejected"]

LARGEST_PHASE_RAD = np.pi / 4
"""At the ends of an interval and the rim of the target (the paper's bound)."""

_CULPRITS = {
    "angles": "θ̈ and φ̈ make",
    "bending": "leaving the image plane makes",
    "motion": "the line of sight's second derivative makes",
}

FITTED_PULSES = 65
"""Pulses of an interval through which its cubic is fitted; noise of a track is averaged so."""


@dataclass(frozen=True, slots=True, kw_only=True)
class QuadraticPhase:
    """The quadratic phase at the ends of an interval, on the rim of a target, in radians.

    Attributes:
        angles_rad: of θ̈ and φ̈, the second derivatives of the paper's angles.
        centripetal_rad: of a uniform turn, (dk/dt)²; on scatterers before and behind the origin.
        uneven_rad: of a turn that grows faster or slower; on scatterers across the line of sight.
        bending_rad: of a line of sight that leaves the image plane; on scatterers above it.
        near_zenith: whether θ̈ and φ̈ come from passing the pole of the angles, the station's
            zenith, more than from an uneven turn.
    """

    angles_rad: float
    centripetal_rad: float
    uneven_rad: float
    bending_rad: float
    near_zenith: bool

    def left_by(self, criterion: FocusCriterion) -> float:
        """Return the phase that a criterion counts."""
        if criterion == "angles":
            return self.angles_rad
        if criterion == "bending":
            return self.bending_rad
        return float(np.hypot(np.hypot(self.centripetal_rad, self.uneven_rad), self.bending_rad))


@dataclass(frozen=True, slots=True, kw_only=True)
class IntervalVerdict:
    """Whether an interval makes a sharp image, and why.

    Attributes:
        status: "accepted" as wanted, "shortened" until it is sharp, or "rejected".
        part: what the unsuitable part of the pass is called, empty for an accepted interval.
        reason: a sentence with the numbers.
        quadratic_phase_rad: of the interval as wanted, None where no target size was given.
        resolution_m: Rayleigh resolution in cross-range of what is used; of a rejected interval,
            the one that a sharp image would have.
    """

    status: Status
    part: str
    reason: str
    quadratic_phase_rad: float | None
    resolution_m: float


def quadratic_phase(
    track: LineOfSightTrack,
    start: int,
    stop: int,
    *,
    wavelength_m: float,
    target_radius_m: float,
) -> QuadraticPhase:
    """Return the quadratic phase of pulses start … stop − 1 for a target of some size.

    Args:
        track: the line of sight at every pulse.
        start: first pulse.
        stop: past the last pulse, at least 4 later.
        wavelength_m: λ at the middle of the band.
        target_radius_m: largest |p| of a scatterer from the target frame's origin.

    Source: eqs. 12–16, read as follows. The phase of a scatterer is 4π/λ k(t)·p. To second order
    in the time t from the middle it holds 4π/λ ½k̈·p t², largest for p along k̈ at the rim and
    t = ±T/2. With θ and φ taken for linear in time, what is missed is ∂k/∂θ ½θ̈ + ∂k/∂φ ½φ̈, of
    length ½√(θ̈² + cos²θ φ̈²): the paper's criterion, which depends on the angles' pole and so
    grows without bound at the zenith. k̈ itself does not: it is −|dk/dt|² along k (uniform turn),
    d|dk/dt|/dt along dk/dt (uneven turn), and what leaves the plane of both (bending).
    """
    chosen = np.linspace(start, stop - 1, min(stop - start, FITTED_PULSES)).round().astype(int)
    time = track.time_s[chosen]
    place = 2 * (time - time[0]) / (time[-1] - time[0]) - 1
    line_of_sight = track.line_of_sight[chosen]
    middle, rate, half_bend = np.polynomial.polynomial.polyfit(place, line_of_sight, 3)[:3]
    axes = _axes(middle, rate)
    to_phase = 4 * np.pi / wavelength_m * target_radius_m
    centripetal, uneven, bending = np.abs(axes @ half_bend) * to_phase
    by_angles = axes @ _by_angles(place, line_of_sight)
    return QuadraticPhase(
        angles_rad=float(np.linalg.norm(by_angles)) * to_phase,
        centripetal_rad=float(centripetal),
        uneven_rad=float(uneven),
        bending_rad=float(bending),
        near_zenith=bool(abs(by_angles[2]) > abs(by_angles[1])),
    )


def verdict_on(
    phase: QuadraticPhase,
    *,
    criterion: FocusCriterion,
    status: Status,
    target_radius_m: float,
    wanted_resolution_m: float,
    sharp_resolution_m: float,
) -> IntervalVerdict:
    """Return a verdict with its reason in numbers.

    Args:
        phase: of the interval as wanted.
        criterion: what counts of it.
        status: what became of the interval.
        target_radius_m: largest |p| of a scatterer.
        wanted_resolution_m: Rayleigh resolution of the interval as wanted.
        sharp_resolution_m: of what is sharp of it.
    """
    left_rad = phase.left_by(criterion)
    part = "" if status == "accepted" else part_name(phase, criterion)
    end = {
        "accepted": "at most π/4",
        "shortened": f"more than π/4; shortened to {sharp_resolution_m:.3g} m",
        "rejected": f"more than π/4; a sharp image would have {sharp_resolution_m:.3g} m",
    }[status]
    return IntervalVerdict(
        status=status,
        part=part,
        reason=(
            f"{part + ': ' if part else ''}{_CULPRITS[criterion]} {left_rad:.2f} rad at "
            f"{target_radius_m:g} m from the middle and {wanted_resolution_m:.3g} m resolution, "
            f"{end}"
        ),
        quadratic_phase_rad=left_rad,
        resolution_m=sharp_resolution_m,
    )


def part_name(phase: QuadraticPhase, criterion: FocusCriterion) -> str:
    """Return what the part of a pass in which a criterion is not met is called."""
    if criterion == "angles":
        return "zenith part" if phase.near_zenith else "unevenly turning part"
    return "bending part" if criterion == "bending" else "curved part"


def _axes(middle: Floats, rate: Floats) -> Floats:
    """Return range, cross-range and the normal of their plane as rows (3, 3)."""
    along = middle / np.linalg.norm(middle)
    across = rate - along * (along @ rate)
    across = across / np.linalg.norm(across)
    axes: Floats = np.stack([along, across, np.cross(along, across)])
    return axes


def _by_angles(place: Floats, line_of_sight: Floats) -> Floats:
    """Return ∂k/∂θ ½θ̈ + ∂k/∂φ ½φ̈ (3,) over half an interval, at its middle."""
    elevation, azimuth = angles_from_line_of_sight(line_of_sight)
    angles = np.stack([elevation, np.unwrap(azimuth)], axis=1)
    (theta, phi), _, (theta_bend, phi_bend) = np.polynomial.polynomial.polyfit(place, angles, 3)[:3]
    by_theta = [-np.sin(theta) * np.sin(phi), -np.sin(theta) * np.cos(phi), np.cos(theta)]
    by_phi = [np.cos(theta) * np.cos(phi), -np.cos(theta) * np.sin(phi), 0.0]
    missed: Floats = np.array(by_theta) * theta_bend + np.array(by_phi) * phi_bend
    return missed
