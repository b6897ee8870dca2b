"""How a target's surfaces scatter sunlight."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.arrays import Floats
from core.targets import Target


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """A surface that scatters part of the light diffusely and part about the mirror direction.

    Attributes:
        name: what a person calls it.
        diffuse: share of the light scattered by Lambert's law.
        specular: share scattered about the mirror direction, at normal incidence.
        shininess: Blinn's exponent; the highlight is about 2 / √shininess radians wide.
    """

    name: str
    diffuse: float
    specular: float = 0.0
    shininess: float = 50.0

    def __post_init__(self) -> None:
        shares = (self.diffuse, self.specular)
        if not (min(shares) >= 0 and sum(shares) <= 1 and 0 < self.shininess < np.inf):
            raise ValueError(
                f"{self.name}: the diffuse and specular shares must not be negative nor exceed 1 "
                "together, and the shininess must be positive; got "
                f"{self.diffuse}, {self.specular} and {self.shininess}."
            )


WHITE_PAINT = Material(name="white paint", diffuse=0.60, specular=0.10, shininess=20.0)
SOLAR_CELLS = Material(name="solar cells", diffuse=0.08, specular=0.12, shininess=300.0)
"""Round values of ours, of the size that measured spacecraft surfaces have."""


def part_materials(target: Target) -> tuple[Material, ...]:
    """Return white paint for a target's first part, its body, and solar cells for the others."""
    return (WHITE_PAINT,) + (SOLAR_CELLS,) * (len(target.parts) - 1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FacetMaterials:
    """The materials of every facet of a target's mesh, as arrays (facets,)."""

    diffuse: Floats
    specular: Floats
    shininess: Floats


def facet_materials(target: Target, materials: Sequence[Material]) -> FacetMaterials:
    """Return the material of every facet of `target.mesh()`.

    Args:
        target: the body.
        materials: one for each of its parts.

    Raises:
        ValueError: another number of materials than parts.
    """
    if len(materials) != len(target.parts):
        raise ValueError(
            f"{target.name} has {len(target.parts)} parts and {len(materials)} materials; "
            "give one material for each part."
        )
    facets = [len(part.faces) for part in target.parts]
    return FacetMaterials(
        **{
            name: np.repeat([getattr(material, name) for material in materials], facets)
            for name in ("diffuse", "specular", "shininess")
        }
    )


def reflected(
    materials: FacetMaterials,
    facet: NDArray[np.intp],
    normal: Floats,
    to_light: Floats,
    to_eye: Floats,
) -> Floats:
    """Return the radiance (points,) of lit points where a white Lambertian facing the light has 1.

    It is π times the bidirectional reflectance times the cosine of incidence.

    Args:
        materials: of all facets.
        facet: (points,) which facet each point lies on.
        normal: (points, 3) unit normals on the observer's side.
        to_light: (3,) unit vector to the light.
        to_eye: (points, 3) or (3,) unit vectors to the observer.

    Source: Lambert, 1760; Blinn, "Models of light reflection", 1977, with the factor
    (n + 2)(n + 4) / 8π (2^(−n/2) + n) that sends out the whole specular share at normal
    incidence (Giesen, "Phong and Blinn-Phong normalization factors", 2009), and less at others.
    """
    cosine = np.maximum(normal @ to_light, 0.0)
    half = to_light + to_eye
    half = half / np.maximum(np.linalg.norm(half, axis=-1, keepdims=True), 1e-12)
    shininess = materials.shininess[facet]
    highlight = np.maximum(np.sum(normal * half, axis=-1), 0.0) ** shininess
    scale = (shininess + 2) * (shininess + 4) / (8 * (2 ** (-shininess / 2) + shininess))
    mirror = materials.specular[facet] * scale * highlight
    radiance: Floats = (materials.diffuse[facet] + mirror) * cosine
    return radiance
