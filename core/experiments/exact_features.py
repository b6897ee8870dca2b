"""How exactly lengths and attitude come off a hull of exact outlines: the measuring itself."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from core.arrays import Floats
from core.experiments.results import Figure, Results
from core.experiments.true_outline import true_silhouette
from core.geometry.grid import VoxelGrid
from core.geometry.projection import Projection
from core.hull.surface import Method, Surface, hull_surface
from core.hull.view import View
from core.hull.votes import VoteCounts
from core.measurement.anchors import Extreme
from core.measurement.lines import angle_between_lines_rad
from core.measurement.measuring import measure_all
from core.measurement.regions import Patch
from core.measurement.results import Lost
from core.measurement.specs import CylinderAxis, LineFeature, PlaneThrough, Spec
from core.targets import MRO_LINES, Target, mro_like, tiangong_like

Progress = Callable[[str, int, int], None]

PIXELS_ACROSS = 1200
"""Outlines are polygons, so that a pixel's size means nothing here."""

MARGIN_VOXELS = 4

LENGTH_WANTED, ATTITUDE_WANTED = "<= 0.25 %", "<= 0.1 °"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KnownFeature:
    """A measurement and what it must come out as.

    Attributes:
        spec: how it is measured.
        value: true value in the measurement's unit; None where only the attitude is known.
        direction: (3,) true attitude, target frame; its sign means nothing.
    """

    spec: Spec
    value: float | None
    direction: Floats


def run_exact_features(
    *,
    views: int = 240,
    spacing_m: float = 0.15,
    method: Method = "dual",
    seed: int = 1,
    progress: Progress = lambda _stage, _done, _total: None,
) -> Results:
    """Carve both targets from exact outlines and measure their features.

    Args:
        views: random directions over the sphere.
        spacing_m: voxel spacing.
        method: how the hull is meshed.
        seed: of the random generator.
        progress: told of stage, steps done and steps in all.

    Raises:
        ValueError: parameters a stage refuses.
    """
    figures: list[Figure] = []
    for target, features in (
        (tiangong_like(), tiangong_features()),
        (mro_like(), mro_features()),
    ):
        outlines = exact_views(target, views=views, seed=seed, progress=progress)
        surface = carved(target, outlines, spacing_m=spacing_m, method=method)
        figures += accuracy(target.name, features, surface)
    settings = {"views": views, "spacing_m": spacing_m, "method": method, "seed": seed}
    return Results(name="exact features", settings=settings, figures=tuple(figures))


def exact_views(
    target: Target,
    *,
    views: int,
    seed: int,
    progress: Progress = lambda _stage, _done, _total: None,
) -> list[View]:
    """Return exact, whole outlines of a target from random directions over the sphere."""
    mesh = target.mesh()
    reach_m = 1.05 * float(np.linalg.norm(mesh.vertices, axis=1).max())
    pixel_m, shape = 2 * reach_m / PIXELS_ACROSS, (PIXELS_ACROSS, PIXELS_ACROSS)
    centre = np.full(2, PIXELS_ACROSS / 2)
    outlines = []
    for turn in Rotation.random(views, rng=np.random.default_rng(seed)).as_matrix():
        projection = Projection(matrix=np.column_stack([turn[:2] / pixel_m, centre]))
        silhouette = true_silhouette(mesh, projection, shape)
        outlines.append(View(silhouette=silhouette, projection=projection))
        progress(f"outlines of the {target.name}", len(outlines), views)
    return outlines


def carved(
    target: Target,
    views: Sequence[View],
    *,
    spacing_m: float,
    method: Method = "dual",
    margin_m: float | None = None,
) -> Surface:
    """Return the hull's surface that views carve on a grid around the target.

    Args:
        target: around which the grid is laid.
        views: as they vote.
        spacing_m: voxel spacing.
        method: how the hull is meshed.
        margin_m: by how much the grid reaches beyond the target; a few voxels unless given.
    """
    lower, upper = target.mesh().bounds
    margin_m = MARGIN_VOXELS * spacing_m if margin_m is None else margin_m
    grid = VoxelGrid.over(lower_m=lower - margin_m, upper_m=upper + margin_m, spacing_m=spacing_m)
    volume = VoteCounts(grid)
    for view in views:
        volume.add(view)
    return hull_surface(volume, method=method)


def tiangong_features() -> tuple[KnownFeature, ...]:
    """Return how span, length, diameter and a panel's normal of `tiangong_like` are measured."""
    x, y, tilt = np.eye(3)[0], np.eye(3)[1], np.deg2rad(25.0)
    chord, normal = (
        np.array([np.cos(tilt), 0, -np.sin(tilt)]),
        np.array([np.sin(tilt), 0, np.cos(tilt)]),
    )
    hinge = np.array([-3.12, 0.0, 0.0])
    side = Patch(near_m=np.array([2.0, 0, 1.675]), angle_rad=0.2, growth="smooth", radius_m=2.4)
    corners = (
        _tip(hinge + 6 * y + 1.4 * chord, chord, cap_m=0.1),
        _tip(hinge + 6 * y - 1.4 * chord, -chord, cap_m=0.1),
        _tip(hinge - 6 * y + 1.4 * chord, chord, cap_m=0.1),
    )
    return (
        KnownFeature(spec=_line("span", hinge, 17.0, y, 2.0), value=17.0, direction=y),
        KnownFeature(spec=_line("length", 0 * x, 10.4, x, 2.0), value=10.4, direction=x),
        KnownFeature(spec=CylinderAxis(name="laboratory", region=side), value=3.35, direction=x),
        KnownFeature(
            spec=PlaneThrough(name="panels", anchors=corners), value=None, direction=normal
        ),
    )


def mro_features() -> tuple[KnownFeature, ...]:
    """Return how the three lines of `mro_like` are measured."""
    centres = {"l1": np.array([0.0, 0.0, -4.2])}
    features = []
    for name, length_m, direction in MRO_LINES:
        unit = np.array(direction) / np.linalg.norm(direction)
        spec = _line(name, centres.get(name, np.zeros(3)), length_m, unit, 3.0)
        features.append(KnownFeature(spec=spec, value=length_m, direction=unit))
    return tuple(features)


def accuracy(
    title: str,
    features: Sequence[KnownFeature],
    surface: Surface,
    *,
    length_wanted: str | None = LENGTH_WANTED,
    attitude_wanted: str | None = ATTITUDE_WANTED,
) -> list[Figure]:
    """Return the errors of a hull's measurements, as figures; what is lost misses its target."""
    figures = []
    results = measure_all([feature.spec for feature in features], surface)
    for feature, result in zip(features, results, strict=True):
        error = angle = None
        if not isinstance(result, Lost):
            error = 100 * (result.value / feature.value - 1) if feature.value else None
            if result.direction is not None:
                angle = np.rad2deg(angle_between_lines_rad(result.direction, feature.direction))
        name = f"{title}, {feature.spec.name}"
        if feature.value is not None:
            size = None if error is None else abs(error)
            figures.append(
                Figure(name=f"{name}: error", value=size, unit="%", wanted=length_wanted)
            )
        figures.append(
            Figure(name=f"{name}: attitude error", value=angle, unit="°", wanted=attitude_wanted)
        )
    return figures


def _line(
    name: str, centre_m: Floats, length_m: float, unit: Floats, radius_m: float
) -> LineFeature:
    half = length_m / 2 * unit
    return LineFeature(
        name=name,
        start=_tip(centre_m - half, -unit, radius_m),
        end=_tip(centre_m + half, unit, radius_m),
    )


def _tip(
    near_m: Floats, direction: Floats, radius_m: float = 1.0, *, cap_m: float = 0.2
) -> Extreme:
    """Return where a part ends: an analyst picks near it and says along what it ends."""
    return Extreme(near_m=near_m, direction=direction, radius_m=radius_m, cap_m=cap_m)
