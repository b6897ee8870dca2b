"""Pictures of a hull: from three sides beside the truth, and coloured by its errors."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
from matplotlib.figure import Figure as Canvas
from numpy.typing import NDArray

from core.arrays import Floats
from core.experiments.pictures import Picture
from core.hull.surface import Surface
from core.measurement.comparison import signed_distances_m
from core.optical.rendering import first_hits
from core.targets import Target

AXES = "xyz"

SIDES = ((0, 1, 2), (1, 0, 2), (2, 0, 1))
"""Of each picture: the axis it looks along, from its negative end, then across and down."""

PIXELS = 260
"""Along the longer side of a picture."""

MARGIN = 0.04


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Side:
    """One picture plane: its axes, and where the rays through its pixels start."""

    axes: tuple[int, int, int]
    extent_m: tuple[float, float, float, float]
    shape: tuple[int, int]
    origins_m: Floats
    direction: Floats

    def hits(self, mesh: trimesh.Trimesh) -> tuple[NDArray[np.intp], Floats]:
        """Return the first facet of each pixel (pixels,), −1 for none, and where (pixels, 3)."""
        return first_hits(mesh, self.origins_m, np.broadcast_to(self.direction, (self.count, 3)))

    @property
    def count(self) -> int:
        return self.shape[0] * self.shape[1]

    def image(self, where: NDArray[np.bool_], values: Floats) -> Floats:
        """Return values of the pixels that hit something as an image, NaN elsewhere."""
        image = np.full(self.count, np.nan)
        image[where] = values
        return image.reshape(self.shape)


TARGET_AXES = "target frame: x along-track, y opposite to the orbit normal, z to the geocentre"


def sides_picture(
    hull: Surface, target: Target | None, *, name: str, what: str, axes: str = TARGET_AXES
) -> Picture:
    """Picture a hull from three sides, and the truth below it in the same scale.

    Args:
        hull: its surface, which may be empty where there is a truth.
        target: the truth, None where its shape is not known.
        name: of the picture's file.
        what: the hull is of, for the caption.
        axes: what they are, for the caption.
    """
    bodies = {"hull": _mesh(hull)} | ({} if target is None else {"truth": target.mesh()})
    beside = "" if target is None else ", above the hull and below the truth"
    caption = f"{what}: from three sides{beside} (metres, {axes})."
    return _bodies_picture(bodies, name=name, caption=caption)


def rivals_picture(
    hulls: Mapping[str, Surface], target: Target, *, name: str, what: str
) -> Picture:
    """Picture several hulls of one target from three sides, and the truth last, in one scale.

    Args:
        hulls: surfaces by what they are called; some may be empty, though not all.
        target: the truth.
        name: of the picture's file.
        what: is compared, for the caption.
    """
    bodies = {title: _mesh(hull) for title, hull in hulls.items()}
    return _bodies_picture(
        {**bodies, "truth": target.mesh()},
        name=name,
        caption=f"{what}: from three sides, the truth at the bottom (metres, {TARGET_AXES}).",
    )


def _bodies_picture(bodies: dict[str, trimesh.Trimesh], *, name: str, caption: str) -> Picture:
    sides = _sides(bodies)

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(len(bodies), 3, width_ratios=_widths(sides), squeeze=False)
        for row, (title, body) in zip(cells, bodies.items(), strict=True):
            for cell, side in zip(row, sides, strict=True):
                where, shade = _shading(body, side)
                _show(cell, side, side.image(where, shade), cmap="gray", vmin=0, vmax=1)
                cell.set_title(f"{title}, seen along {AXES[side.axes[0]]}")

    return Picture(
        name=name,
        caption=caption,
        draw=draw,
        size_in=(12.0, _height_in(sides, rows=len(bodies))),
    )


def error_pictures(
    hull: Surface, target: Target, *, name: str, most_m: float = 2.0
) -> tuple[Picture, ...]:
    """Picture how far a hull's surface lies off the truth's, from three sides.

    Args:
        hull: its surface; an empty one gives no picture.
        target: the truth.
        name: of the picture's file.
        most_m: distance at which colours end.
    """
    if hull.is_empty:
        return ()
    mesh = target.mesh()
    truth = Surface(vertices_m=mesh.vertices, faces=mesh.faces)
    body = _mesh(hull)
    sides = _sides({"hull": body, "truth": mesh})

    def draw(canvas: Canvas) -> None:
        cells = canvas.subplots(1, 3, width_ratios=_widths(sides))
        for cell, side in zip(cells, sides, strict=True):
            facet, points = side.hits(body)
            where = facet >= 0
            error_m = signed_distances_m(points[where], truth)
            colours = {"cmap": "coolwarm", "vmin": -most_m, "vmax": most_m}
            drawn = _show(cell, side, side.image(where, error_m), **colours)
            cell.set_title(f"seen along {AXES[side.axes[0]]}")
        canvas.colorbar(drawn, ax=list(cells), label="outside the truth (m)", shrink=0.8)

    picture = Picture(
        name=name,
        caption="Error of the hull's surface: distance from the true surface in metres, outside "
        "it red, inside it blue.",
        draw=draw,
        size_in=(12.0, _height_in(sides, rows=1)),
    )
    return (picture,)


def _mesh(surface: Surface) -> trimesh.Trimesh:
    return trimesh.Trimesh(surface.vertices_m, surface.faces, process=False)


def _sides(bodies: dict[str, trimesh.Trimesh]) -> tuple[_Side, ...]:
    """Return the three picture planes that hold all bodies."""
    points = np.concatenate([np.asarray(body.vertices) for body in bodies.values()])
    lower, upper = points.min(axis=0), points.max(axis=0)
    margin_m = MARGIN * float((upper - lower).max())
    return tuple(_side(axes, lower - margin_m, upper + margin_m) for axes in SIDES)


def _side(axes: tuple[int, int, int], lower: Floats, upper: Floats) -> _Side:
    along, across, down = axes
    pixel_m = float(max((upper - lower)[[across, down]])) / PIXELS
    left, right = float(lower[across]), float(upper[across])
    top, bottom = float(lower[down]), float(upper[down])
    columns = np.arange(left + pixel_m / 2, right, pixel_m)
    rows = np.arange(top + pixel_m / 2, bottom, pixel_m)
    origins = np.empty((len(rows), len(columns), 3))
    origins[..., along] = lower[along] - 1.0
    origins[..., across] = columns
    origins[..., down] = rows[:, None]
    return _Side(
        axes=axes,
        extent_m=(left, right, bottom, top),
        shape=(len(rows), len(columns)),
        origins_m=origins.reshape(-1, 3),
        direction=np.eye(3)[along],
    )


def _widths(sides: tuple[_Side, ...]) -> list[float]:
    return [side.extent_m[1] - side.extent_m[0] for side in sides]


def _height_in(sides: tuple[_Side, ...], *, rows: int) -> float:
    """Return how high a picture 12 inches wide is with so many rows, labels included."""
    tallest_m = max(side.extent_m[2] - side.extent_m[3] for side in sides)
    return rows * (0.9 + 10.5 * tallest_m / sum(_widths(sides)))


def _shading(body: trimesh.Trimesh, side: _Side) -> tuple[NDArray[np.bool_], Floats]:
    """Return which pixels see a body, and how bright a lamp beside the eye makes it there."""
    if len(body.faces) == 0:
        return np.zeros(side.count, dtype=bool), np.empty(0)
    facet, _ = side.hits(body)
    where = facet >= 0
    _, across, down = side.axes
    lamp = -side.direction - 0.5 * np.eye(3)[across] - 0.7 * np.eye(3)[down]
    cosine = body.face_normals[facet[where]] @ (lamp / np.linalg.norm(lamp))
    return where, 0.15 + 0.8 * np.maximum(cosine, 0)


def _show(cell: Any, side: _Side, image: Floats, **colours: Any) -> Any:
    drawn = cell.imshow(image, extent=side.extent_m, interpolation="nearest", **colours)
    cell.grid(visible=False)
    cell.set(xlabel=f"{AXES[side.axes[1]]} (m)", ylabel=f"{AXES[side.axes[2]]} (m)")
    return drawn
