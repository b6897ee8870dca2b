"""Optics held against theory: eq. 8, the sun's place, phase law, point spread and photons."""

from dataclasses import dataclass

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation
from scipy.special import j1

from core.arrays import Floats
from core.optical.camera import affine_camera, camera_axes
from core.optical.epipolar import essential_matrix, relative_pose
from core.optical.materials import Material, facet_materials
from core.optical.rendering import Light, rendered
from core.optical.sun import sun_position_of_date
from core.optical.telescope import Detector, Telescope, blurred, exposed
from core.targets import Target

PUBLISHED_SUN = (
    (2448908.5, 198.378124, -7.783817),
    (2452930.312847 + 67 / 86400, 202.22741, -9.31434),
)
"""Julian date, right ascension and declination in degrees: Meeus, "Astronomical algorithms", 1998,
example 25.b; Reda and Andreas, "Solar position algorithm", NREL 2008, table A5.1."""

SAMPLES_PER_DIFFRACTION = 10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Curve:
    """A measured curve beside its theory, all (points,)."""

    at: Floats
    measured: Floats
    theory: Floats


def essential_residual(*, poses: int, random: np.random.Generator) -> float:
    """Return the largest |x₂ᵀ E x₁| over |E| |x₂| |x₁| of random points before random cameras."""
    worst = 0.0
    for _ in range(poses):
        rotations = Rotation.random(2, rng=random).as_matrix()
        translations = np.array([0, 0, 30.0]) + random.uniform(-2, 2, (2, 3))
        points = random.uniform(-5, 5, (50, 3))
        first, second = zip(rotations, translations, strict=True)
        essential = essential_matrix(*relative_pose(first, second))
        one, two = (points @ r.T + t for r, t in (first, second))
        size = np.linalg.norm(essential) * np.linalg.norm(one, axis=1) * np.linalg.norm(two, axis=1)
        residual = np.abs(np.einsum("ni,ij,nj->n", two, essential, one)) / size
        worst = max(worst, float(residual.max()))
    return worst


def sun_error_deg() -> float:
    """Return the largest angle between the computed and the published places of the sun."""
    worst = 0.0
    for julian_date, right_ascension_deg, declination_deg in PUBLISHED_SUN:
        ascension, declination = np.deg2rad([right_ascension_deg, declination_deg])
        published = np.array(
            [
                np.cos(declination) * np.cos(ascension),
                np.cos(declination) * np.sin(ascension),
                np.sin(declination),
            ]
        )
        place = sun_position_of_date(np.array(julian_date))
        apart = np.linalg.norm(np.cross(place / np.linalg.norm(place), published))
        worst = max(worst, float(np.rad2deg(np.arcsin(apart))))
    return worst


def phase_law() -> Curve:
    """Return the flux of a rendered Lambertian sphere over the phase angle, full phase = 1.

    Source: Lambert, 1760; Russell, 1916: Φ(α) = (sin α + (π − α) cos α) / π.
    """
    ball = Target(name="ball", parts=(trimesh.creation.icosphere(subdivisions=5, radius=10.0),))
    coat = facet_materials(ball, [Material(name="white", diffuse=1.0)])
    ahead, across = np.array([0.0, 1, 0]), np.array([1.0, 0, 0])
    camera = affine_camera(camera_axes(ahead, across), pixel_m=0.2, shape=(128, 128))
    phase = np.deg2rad(np.arange(0, 151, 15))
    flux = [
        rendered(
            ball.mesh(),
            coat,
            camera,
            Light(sun_direction=np.sin(angle) * across - np.cos(angle) * ahead),
            line_of_sight=ahead,
            shape=(128, 128),
            supersampling=2,
        ).sum()
        * 0.1**2
        for angle in phase
    ]
    theory = (np.sin(phase) + (np.pi - phase) * np.cos(phase)) / np.pi
    return Curve(at=phase, measured=np.array(flux) / (2 / 3 * np.pi * 10**2), theory=theory)


def point_spread(telescope: Telescope) -> Curve:
    """Return the point spread across its middle over the angle in units of λ/D, and Airy's."""
    size = 321
    point = np.zeros((size, size))
    point[size // 2, size // 2] = 1.0
    seen = blurred(point, telescope, telescope.diffraction_rad / SAMPLES_PER_DIFFRACTION)
    at = (np.arange(size) - size // 2) / SAMPLES_PER_DIFFRACTION
    x = np.pi * np.where(at == 0, 1e-9, at)
    return Curve(at=at, measured=seen[size // 2] / seen.max(), theory=(2 * j1(x) / x) ** 2)


def full_width(curve: Curve) -> float:
    """Return the measured full width at half maximum, in the unit of `at`."""
    above = np.flatnonzero(curve.measured >= 0.5)
    a, b = int(above[0]), int(above[-1])
    left = np.interp(0.5, curve.measured[a - 1 : a + 1], curve.at[a - 1 : a + 1])
    right = np.interp(0.5, curve.measured[[b + 1, b]], curve.at[[b + 1, b]])
    return float(right - left)


def photon_transfer(detector: Detector, random: np.random.Generator) -> Curve:
    """Return the variance of even exposures over their mean, in electrons, less the reading's."""
    radiance = np.geomspace(1e-3, 1.0, 7)
    exposures = [
        exposed(np.full((256, 256), each), detector, random).astype(np.float64)
        * detector.full_well_electrons
        for each in radiance
    ]
    mean = np.array([each.mean() for each in exposures]) - detector.bias_electrons
    variance = np.array([each.var() for each in exposures]) - detector.read_noise_electrons**2
    return Curve(at=mean, measured=variance, theory=mean)
