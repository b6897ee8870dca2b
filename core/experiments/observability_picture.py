"""A map of directions: how well the views of an experiment can measure along each."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.arrays import Floats
from core.experiments.pictures import Picture
from core.geometry.track import line_of_sight_from_angles
from core.hull.view import View
from core.measurement.observability import OBSERVED_DILUTION, observability

STEP_DEG = 5.0


def dilution_map(views: Sequence[View]) -> tuple[Floats, Floats, Floats]:
    """Return elevations, azimuths in degrees, and the dilution along each pair (θ, φ).

    A direction and its opposite are one, so that azimuths end at 180°.
    """
    elevation = np.arange(-90 + STEP_DEG / 2, 90, STEP_DEG)
    azimuth = np.arange(STEP_DEG / 2, 180, STEP_DEG)
    theta, phi = np.meshgrid(np.deg2rad(elevation), np.deg2rad(azimuth), indexing="ij")
    seen = observability(views)
    directions = line_of_sight_from_angles(theta, phi).reshape(-1, 3)
    values = np.array([seen.dilution(direction) for direction in directions])
    return elevation, azimuth, values.reshape(theta.shape)


def unobserved_percent(views: Sequence[View]) -> float:
    """Return the share of all directions, by solid angle, along which nothing can be measured."""
    elevation, _, dilution = dilution_map(views)
    area = np.cos(np.deg2rad(elevation))[:, None] * np.ones_like(dilution)
    return 100 * float(np.sum(area * (dilution > OBSERVED_DILUTION)) / np.sum(area))


def observability_picture(
    sensors: Mapping[str, Sequence[View]], *, name: str, note: str = ""
) -> Picture:
    """Picture the dilution over all directions, one map for each set of views by its name.

    Args:
        sensors: views as they vote, by what the map is called.
        name: of the picture's file.
        note: a further sentence of the caption.
    """
    maps = {title: dilution_map(views) for title, views in sensors.items()}

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(1, len(maps), squeeze=False)[0]
        for cell, (title, (elevation, azimuth, dilution)) in zip(cells, maps.items(), strict=True):
            shown = np.minimum(dilution, 2 * OBSERVED_DILUTION)
            drawn = cell.pcolormesh(
                azimuth, elevation, shown, cmap="magma_r", vmin=1, vmax=2 * OBSERVED_DILUTION
            )
            if np.any(shown > OBSERVED_DILUTION) and np.any(shown < OBSERVED_DILUTION):
                cell.contour(azimuth, elevation, shown, [OBSERVED_DILUTION], colors="#58b4ff")
            for axis, (phi, theta) in {"x": (90, 0), "y": (5, 0), "z": (90, 84)}.items():
                cell.annotate(axis, (phi, theta), color="#2b8c4a", ha="center", va="center")
            cell.set(title=title, xlabel="azimuth φ in the target frame (°)", ylabel="θ (°)")
            cell.grid(visible=False)
        canvas.colorbar(drawn, ax=list(cells), label="dilution, 1 is best")

    return Picture(
        name=name,
        caption="Dilution of a length along each direction of the target frame: by how much an "
        f"outline's error counts. Beyond the blue line it exceeds {OBSERVED_DILUTION:g}, and "
        f"nothing can be measured; a direction and its opposite are one. {note}".rstrip(),
        draw=draw,
        size_in=(5.6 * len(maps), 4.2),
    )
