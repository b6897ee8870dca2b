"""Physical optics: what lit, perfectly conducting facets return, in closed form.

Every facet's surface current is that of an endless mirror in its place, and the echo is the
integral of that current over what is lit:

    S = −j √(4π) / λ ∫ (−n·k) exp(−j 2π (2/λ) k·r) dS,    |S|² the radar cross-section in m².

Backwards the mirror keeps the polarisation, so that S is one number.
"""

from dataclasses import dataclass

import finufft
import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.facets import Facets
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S

TRANSFORM_PRECISION = 1e-6
"""Asked of the transform over frequency, relative to the sum of all corners' strengths."""

SERIES_BELOW_RAD = 1.0
"""Phase across a facet or an edge under which the closed form, a difference of nearly equal
numbers, gives way to Gauss's rule, whose error is then below 10⁻⁵."""

_EDGE_NODES, _EDGE_WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(3))
_EDGE_NODES = _EDGE_NODES + 0.5

_NEAR, _FAR = (6 - np.sqrt(15)) / 21, (6 + np.sqrt(15)) / 21
_FACET_NODES = np.array(
    [
        [1 / 3, 1 / 3, 1 / 3],
        *[
            np.roll([1 - 2 * share, share, share], turn)
            for share in (_NEAR, _FAR)
            for turn in (0, 1, 2)
        ],
    ]
)
_FACET_WEIGHTS = np.array([270, *[155 - np.sqrt(15)] * 3, *[155 + np.sqrt(15)] * 3]) / 1200
"""Radon's rule of seven points, exact to the fifth degree (Abramowitz and Stegun, 25.4.63)."""

_FACTORS = np.array([-1j, 1.0, -1j]) / np.sqrt(4 * np.pi)
"""−j √(4π) / λ is −j κ / √(4π); corners, edges and facets bring κ⁻², j κ⁻¹ and 1 with them."""


def physical_optics(
    facets: Facets, direction: Floats, frequency_hz: Floats
) -> NDArray[np.complex64]:
    """Return the scattered amplitude S of facets, (pulses, frequencies); |S|² is in m².

    Its phase is a phase history's: a facet at p turns by −4π f k·p / c.

    Args:
        facets: what is lit; those that face away from a pulse count as dark for it.
        direction: (pulses, 3) k, or cos(β/2) times the bisector of a bistatic pair.
        frequency_hz: (frequencies,) evenly spaced.

    Source: Gordon, "Far-field approximations to the Kirchhoff–Helmholtz representations of
    scattered fields", 1975: with κ = 4π f / c and k's part t along the facet, the surface
    integral becomes one over the edges a from corner to corner,

        ∫ exp(−jκ k·r) dS = j / (κ |t|²) Σ k·(a × n) ∫₀¹ exp(−jκ k·(r_a + s a)) ds,

    so that for all but small phases a facet is three points whose strengths do not depend on
    frequency, under a common factor κ⁻². Facets at their flash and edges across k, where that
    would divide by zero, become Gauss's points. One nonuniform transform per pulse sums them all.
    """
    wavenumber = 4 * np.pi / SPEED_OF_LIGHT_M_PER_S * np.asarray(frequency_hz, dtype=np.float64)
    middle = float(wavenumber[len(wavenumber) // 2])
    step = (wavenumber[-1] - wavenumber[0]) / (len(wavenumber) - 1)
    amplitude = np.zeros((len(direction), len(wavenumber)), dtype=np.complex64)
    geometry = _Geometry.of(facets)
    # Planned once; sorting the few thousand points would take longer than it saves.
    transform = finufft.Plan(
        1,
        (len(wavenumber),),
        eps=TRANSFORM_PRECISION,
        isign=-1,
        nthreads=1,  # as in the echoes of points: the same input gives the same output
        spread_sort=0,
    )
    for pulse, toward in enumerate(np.asarray(direction, dtype=np.float64)):
        for power, (place_m, strength) in enumerate(_points(geometry, toward, middle)):
            if len(place_m) > 0:
                transform.setpts(step * place_m)
                summed = transform.execute(strength * np.exp(-1j * middle * place_m))
                amplitude[pulse] += _FACTORS[power] * wavenumber ** (power - 1) * summed
    return amplitude


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Geometry:
    """What does not change from pulse to pulse.

    Attributes:
        corners_m, normal, share: as in `Facets`.
        outward_m: (facets, 3, 3) a × n for every edge a: out of the facet, as long as the edge.
        area_m2: (facets,).
        longest_m: (facets,) of the edges.
    """

    corners_m: Floats
    normal: Floats
    share: Floats
    outward_m: Floats
    area_m2: Floats
    longest_m: Floats

    @staticmethod
    def of(facets: Facets) -> "_Geometry":
        edges = np.roll(facets.corners_m, -1, axis=1) - facets.corners_m
        return _Geometry(
            corners_m=facets.corners_m,
            normal=facets.normal,
            share=facets.share,
            outward_m=np.cross(edges, facets.normal[:, None]),
            area_m2=np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2,
            longest_m=np.linalg.norm(edges, axis=2).max(axis=1),
        )


def _points(
    geometry: _Geometry, toward: Floats, wavenumber: float
) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats], tuple[Floats, Floats]]:
    """Return (places along k, strengths) of the corners', the edges' and the facets' points."""
    cosine = -(geometry.normal @ toward)
    weight = geometry.share * np.maximum(cosine, 0)
    tangential = np.maximum(toward @ toward - cosine**2, 0)  # squared
    along = geometry.corners_m @ toward
    flash = wavenumber * np.sqrt(tangential) * geometry.longest_m < SERIES_BELOW_RAD
    flashing = np.outer((weight * geometry.area_m2)[flash], _FACET_WEIGHTS).ravel()
    facets = ((along[flash] @ _FACET_NODES.T).ravel(), flashing)

    steady = ~flash & (weight > 0)
    along = along[steady]
    part = (geometry.outward_m[steady] @ toward) * (weight / np.where(flash, 1, tangential))[
        steady, None
    ]
    advance = np.roll(along, -1, axis=1) - along
    level = wavenumber * np.abs(advance) < SERIES_BELOW_RAD
    ratio = np.where(level, 0, part) / np.where(level, 1, advance)
    corners = (along.ravel(), (ratio - np.roll(ratio, 1, axis=1)).ravel())
    places = along[level][:, None] + np.outer(advance[level], _EDGE_NODES)
    edges = (places.ravel(), np.outer(part[level], _EDGE_WEIGHTS).ravel())
    return corners, edges, facets
