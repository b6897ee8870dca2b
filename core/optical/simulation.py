"""Telescope frames of a target along its pass, each the partner of a radar frame."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import trimesh

from core.arrays import Floats
from core.frame import Frame
from core.geometry.projection import Projection
from core.geometry.track import LineOfSightTrack
from core.optical.camera import perpendicular_partner
from core.optical.materials import FacetMaterials, Material, facet_materials, part_materials
from core.optical.rendering import Light, rendered
from core.optical.sun import Illumination
from core.optical.telescope import Detector, Telescope, blurred, exposed
from core.targets import Target


@dataclass(frozen=True, slots=True, kw_only=True)
class OpticalSettings:
    """How telescope frames are taken.

    Attributes:
        telescope: its pixels are half of λ/D wide, the Nyquist rate of what passes.
        detector: its electrons.
        shape: (rows, columns).
        roll_rad: of the camera; 0 is the paper's choice, columns along cross-range.
        is_perspective: whether the camera stands at the track's range; a parallel one differs by
            |p|² / range, 0.2 mm at the edge of a 10 m target 450 km away.
        has_earthshine: whether sunlit ground below lights the target too.
        supersampling: rays along each side of a pixel.
    """

    telescope: Telescope = field(default_factory=Telescope)
    detector: Detector = field(default_factory=Detector)
    shape: tuple[int, int] = (512, 512)
    roll_rad: float = 0.0
    is_perspective: bool = False
    has_earthshine: bool = True
    supersampling: int = 3

    def __post_init__(self) -> None:
        if min(self.shape) < 8 or self.supersampling < 1:
            raise ValueError(
                "An optical frame has at least 8 × 8 pixels and a ray in each; got a shape of "
                f"{self.shape} and {self.supersampling} × {self.supersampling} rays."
            )

    def pixel_rad(self) -> float:
        """Return the width of a pixel on the sky."""
        return self.telescope.diffraction_rad / 2


def simulate_optical_frames(
    target: Target,
    track: LineOfSightTrack,
    time_s: Sequence[float],
    illumination: Illumination,
    settings: OpticalSettings | None = None,
    *,
    random: np.random.Generator,
    materials: Sequence[Material] | None = None,
    label: str = "telescope",
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> tuple[Frame, ...]:
    """Return what a telescope beside the radar photographs at some moments of a pass.

    Each frame looks along the radar's line of sight at that pulse, with its columns along
    cross-range at no roll. Moments in the Earth's umbra give no frame.

    Args:
        target: what is seen.
        track: the radar's, with ranges.
        time_s: moments of the track, each moved to the nearest pulse.
        illumination: of these moments, from `track_illumination`.
        settings: of telescope, detector and camera.
        random: for photons and reading.
        materials: one for each of the target's parts; None for white paint and solar cells.
        label: of the frames.
        progress: told of moments done and moments in all.

    Raises:
        ValueError: a track without ranges, every moment in the umbra, or a target larger than
            the picture.
    """
    settings = settings or OpticalSettings()
    ranges_m = _checked_ranges(track, time_s, illumination)
    mesh = target.mesh()
    coats = facet_materials(target, part_materials(target) if materials is None else materials)
    frames = []
    for number, moment_s in enumerate(time_s):
        if illumination.sunlit_fraction[number] > 0:
            pulse = int(np.argmin(np.abs(track.time_s - moment_s)))
            range_m = float(ranges_m[pulse])
            projection = perpendicular_partner(
                line_of_sight=track.line_of_sight[pulse],
                cross_range=track.line_of_sight_rate_per_s[pulse],
                pixel_m=range_m * settings.pixel_rad(),
                shape=settings.shape,
                roll_rad=settings.roll_rad,
                range_m=range_m if settings.is_perspective else None,
            )
            light = Light(
                sun_direction=illumination.sun_direction[number],
                sun=float(illumination.sunlit_fraction[number]),
                earth_distance_m=(
                    float(illumination.earth_distance_m[number])
                    if settings.has_earthshine
                    else None
                ),
            )
            frames.append(
                optical_frame(
                    mesh,
                    coats,
                    projection,
                    light,
                    settings,
                    line_of_sight=track.line_of_sight[pulse],
                    range_m=range_m,
                    time_s=float(track.time_s[pulse]),
                    random=random,
                    label=label,
                )
            )
        progress(number + 1, len(time_s))
    return tuple(frames)


def optical_frame(
    mesh: trimesh.Trimesh,
    materials: FacetMaterials,
    projection: Projection,
    light: Light,
    settings: OpticalSettings,
    *,
    line_of_sight: Floats,
    range_m: float,
    time_s: float,
    random: np.random.Generator,
    label: str = "telescope",
) -> Frame:
    """Return one telescope frame.

    Args:
        mesh: the target's, in metres.
        materials: of its facets.
        projection: of the picture, with pixels of settings.pixel_rad() × range_m.
        light: sun and Earth.
        settings: of telescope and detector.
        line_of_sight: (3,) unit vector from sensor to target, target frame.
        range_m: from sensor to target.
        time_s: since the pass began.
        random: for photons and reading.
        label: of the frame.

    Raises:
        ValueError: a target that does not fit into the picture, which would be cut off.
    """
    _check_fits(mesh, projection, settings.shape)
    factor = settings.supersampling
    fine = rendered(
        mesh,
        materials,
        projection,
        light,
        line_of_sight=line_of_sight,
        shape=settings.shape,
        supersampling=factor,
    )
    formed = blurred(fine, settings.telescope, settings.pixel_rad() / factor)
    rows, columns = settings.shape
    radiance = formed.reshape(rows, factor, columns, factor).mean(axis=(1, 3))
    pixel_m = settings.pixel_rad() * range_m if projection.is_affine else None
    resolution_m = settings.telescope.resolution_rad() * range_m
    return Frame(
        amplitude=exposed(radiance, settings.detector, random),
        projection=projection,
        time_s=time_s,
        sensor="optical",
        line_of_sight=line_of_sight,
        row_spacing_m=pixel_m,
        column_spacing_m=pixel_m,
        row_resolution_m=resolution_m,
        column_resolution_m=resolution_m,
        label=label,
        sun_direction=light.sun_direction,
    )


def _checked_ranges(
    track: LineOfSightTrack, time_s: Sequence[float], illumination: Illumination
) -> Floats:
    if track.range_m is None:
        raise ValueError(
            "The track has no ranges, so the telescope's pixels have no size on the target; use "
            "a track of an orbit."
        )
    if len(time_s) != len(illumination.sunlit_fraction):
        raise ValueError(
            f"There are {len(time_s)} moments, but the sun's direction at "
            f"{len(illumination.sunlit_fraction)}; give one for each."
        )
    if not np.any(illumination.sunlit_fraction > 0):
        raise ValueError(
            "The target is in the Earth's shadow at all of the moments asked for, where a "
            "telescope sees nothing; choose a pass at dusk or dawn."
        )
    return track.range_m


def _check_fits(mesh: trimesh.Trimesh, projection: Projection, shape: tuple[int, int]) -> None:
    corners = projection.image_points(np.asarray(mesh.vertices))
    least, most = corners.min(axis=0), corners.max(axis=0)
    if np.any(least < 0) or np.any(most > np.array(shape) - 1):
        needed = np.ceil(most - least).astype(int) + 1
        raise ValueError(
            f"The target needs {needed[0]} × {needed[1]} pixels about the picture's centre and "
            f"would be cut off by its edge; the picture has {shape[0]} × {shape[1]}. Give more "
            "pixels or a smaller telescope."
        )
