"""What a body returns: diffuse points, a conducting surface, or a mixture of both."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.radar.bouncing_rays import bounce_points
from core.radar.echoes import ScatteringModel
from core.radar.facets import ShadedSurface, shaded_surface
from core.radar.physical_optics import physical_optics
from core.radar.scatterers import middle_line_of_sight, point_echoes, surface_scatterers
from core.radar.waveform import SPEED_OF_LIGHT_M_PER_S
from core.targets import Target

ModelName = Literal["diffuse", "physical-optics", "mixed"]

LONGEST_EDGE_M = 0.5
"""Of the pieces whose quarters are lit or dark: a shadow's edge is right to about 0.2 m."""

TUBE_M = 0.05
"""Side of a ray tube. Its echo falls by 0.4 dB at 1.7° from the aspect traced at 16.7 GHz."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConductingSurface:
    """A smooth conducting surface: physical optics, and up to three bounces between its parts.

    Attributes:
        surface: the body's triangles.
        reflection: share of the field's amplitude that each reflection keeps.
        most_bounces: reflections that are followed; 1 leaves those between parts out.
        tube_m: side of a ray tube, as in `bounce_points`.
    """

    surface: ShadedSurface
    reflection: float = 1.0
    most_bounces: int = 3
    tube_m: float = TUBE_M

    def __post_init__(self) -> None:
        if not (0 <= self.reflection <= 1 and self.most_bounces >= 1 and self.tube_m > 0):
            raise ValueError(
                "A surface keeps 0 to 1 of the field at each of at least 1 bounces, traced in "
                f"tubes of positive metres; got {self.reflection}, {self.most_bounces} and "
                f"{self.tube_m} m."
            )

    def reach_m(self) -> float:
        """Return how far from the origin the farthest corner lies."""
        return float(np.linalg.norm(self.surface.mesh.vertices, axis=1).max())

    def mean_echo_power(self) -> float:
        """Return the power of single reflections averaged over all aspects, in m².

        A convex mirror's cross-section π R₁ R₂ averages, over the aspects dΩ = dS / R₁ R₂ that its
        normals take, to a quarter of its surface: the same as the diffuse model's, whatever the
        shape. Flat faces keep to it by flashes as strong as they are rare.
        """
        return self.reflection**2 * float(self.surface.mesh.area) / 4

    def echoes(self, direction: Floats, frequency_hz: Floats) -> NDArray[np.complex64]:
        """Return the echoes of pulses that all light what the middle one lights.

        Args:
            direction: (pulses, 3) lines of sight k, or a bistatic pair's mean of two.
            frequency_hz: (frequencies,) evenly spaced.
        """
        line_of_sight = middle_line_of_sight(direction)
        lit = self.surface.lit_facets(line_of_sight)
        single = np.float32(self.reflection) * physical_optics(lit, direction, frequency_hz)
        if self.most_bounces < 2:
            return single
        middle_hz = float(np.mean(frequency_hz))
        # A pair's frequencies count cos(β/2) times, here as in the phases.
        scale = float(np.linalg.norm(direction[len(direction) // 2]))
        bounced = bounce_points(
            self.surface.mesh,
            line_of_sight,
            wavelength_m=SPEED_OF_LIGHT_M_PER_S / (middle_hz * scale),
            tube_m=self.tube_m,
            most_bounces=self.most_bounces,
            reflection=self.reflection,
        )
        several = point_echoes(bounced.position_m, bounced.amplitude, direction, frequency_hz)
        return single + several * (frequency_hz / middle_hz).astype(np.float32)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mixture:
    """Models whose echoes add up.

    Attributes:
        models: at least one.
    """

    models: tuple[ScatteringModel, ...] = field(default=())

    def __post_init__(self) -> None:
        if not self.models:
            raise ValueError("A mixture needs at least one model to mix.")

    def reach_m(self) -> float:
        """Return how far from the origin anything scatters."""
        return max(model.reach_m() for model in self.models)

    def mean_echo_power(self) -> float:
        """Return the power over all aspects, in m²: without a common phase powers add."""
        return sum(model.mean_echo_power() for model in self.models)

    def echoes(self, direction: Floats, frequency_hz: Floats) -> NDArray[np.complex64]:
        """Return the sum of the models' echoes."""
        each = [model.echoes(direction, frequency_hz) for model in self.models]
        total: NDArray[np.complex64] = np.sum(each, axis=0, dtype=np.complex64)
        return total


def scattering_model(
    target: Target,
    name: ModelName,
    *,
    random: np.random.Generator,
    scatterers: int = 60_000,
    roughness: float = 0.5,
    most_bounces: int = 3,
) -> ScatteringModel:
    """Return a body as the simulation sees it.

    "diffuse" scatters every way from random points; "physical-optics" is a mirror all over;
    "mixed" takes the share `roughness` of the power at every reflection out of the mirror and
    scatters it: √(1 − r) of the mirror's amplitude plus √r of the points'. Both sides return the
    same power on average over all aspects (a quarter of the surface, in m²), and so does the
    mixture, whatever the roughness.

    A height error of rms σ leaves exp(−(4π σ / λ)²) of the coherent power at normal incidence
    (Ament, 1953): r = 0.5 stands for σ = λ / 15, 1.2 mm at 16.7 GHz.

    Args:
        target: the body.
        name: which model.
        random: for the scatterers' places and phases.
        scatterers: points on the surface, where the model has any.
        roughness: r of "mixed", 0 to 1.
        most_bounces: reflections that mirrors are followed through.

    Raises:
        ValueError: a roughness outside 0 … 1, fewer than one bounce, no surface.
    """
    if not 0 <= roughness <= 1:
        raise ValueError(f"Roughness is the share of power scattered, 0 to 1; got {roughness}.")
    if name == "diffuse":
        return surface_scatterers(target, count=scatterers, random=random)
    share = roughness if name == "mixed" else 0.0
    mirror = ConductingSurface(
        surface=shaded_surface(target, longest_edge_m=LONGEST_EDGE_M),
        reflection=float(np.sqrt(1 - share)),
        most_bounces=most_bounces,
    )
    if name == "physical-optics":
        return mirror
    points = surface_scatterers(target, count=scatterers, random=random)
    return Mixture(models=(mirror, points.scaled(float(np.sqrt(share)))))
