"""Pictures of point responses."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.image import AxesImage

from core.arrays import Floats
from core.experiments.physics.point_spread import PointResponse
from core.experiments.pictures import Picture
from core.radar.window import Window

HALF_SIDE_M = 1.5
DEPTH_DB = 50.0
SHOWN_CELLS = 10.0


def responses_picture(responses: Mapping[str, Mapping[str, PointResponse]]) -> Picture:
    """Return a picture of what each method makes of a point, place by place.

    Args:
        responses: by method, then by place.
    """
    places = list(next(iter(responses.values())))

    def draw(canvas: Canvas) -> None:
        grid = canvas.subplots(len(responses), len(places), squeeze=False)
        for axes_row, (method, by_place) in zip(grid, responses.items(), strict=True):
            for axes, place in zip(axes_row, places, strict=True):
                image = _draw_response(axes, by_place[place])
                axes.set_title(f"{method}\n{place}")
        for axes in grid[-1]:
            axes.set_xlabel("cross-range from the point [m]")
        for axes in grid[:, 0]:
            axes.set_ylabel("range from the point [m]")
        canvas.colorbar(image, ax=grid, label="amplitude [dB of a unit point]", shrink=0.6)

    return Picture(
        name="point-responses",
        caption=(
            "A unit point on the axis and 10 m off, imaged by each method from the same echoes of "
            "a real pass at 0.15 m resolution. Plain range-Doppler smears off the axis: its range "
            "walks through cells and its Doppler changes."
        ),
        draw=draw,
        size_in=(11.0, 3.3 * len(responses)),
    )


def cuts_picture(responses: Mapping[str, tuple[Window, PointResponse]]) -> Picture:
    """Return a picture of cuts through responses over their windows' theory.

    Args:
        responses: by the window's name, with the window.
    """

    def draw(canvas: Canvas) -> None:
        grid = canvas.subplots(len(responses), 2, sharex=True, sharey=True, squeeze=False)
        for axes_row, (name, (window, response)) in zip(grid, responses.items(), strict=True):
            for axes, axis, cut in zip(
                axes_row, ("range", "cross-range"), response.cuts, strict=True
            ):
                place = np.linspace(-SHOWN_CELLS, SHOWN_CELLS, 1601)
                theory = np.abs(window.point_response(place))
                axes.plot(place, _decibels(theory), color="#8b96a8", lw=3.0, label="theory")
                axes.plot(cut.place_cells, _decibels(cut.amplitude), "#ff9a3c", label="image")
                axes.axhline(window.highest_sidelobe_db, color="#4fb3ff", ls=":", lw=1)
                axes.set(
                    title=f"{name}, {axis}: width off by {100 * (cut.width_ratio - 1):+.2f} %,\n"
                    f"sidelobes {cut.sidelobe_db:.1f} dB, theory "
                    f"{window.highest_sidelobe_db:.1f} dB",
                    xlim=(-SHOWN_CELLS, SHOWN_CELLS),
                    ylim=(-70, 3),
                )
        for axes in grid[-1]:
            axes.set_xlabel("from the point [Rayleigh cells]")
        for axes in grid[:, 0]:
            axes.set_ylabel("amplitude [dB]")
        grid[0, 0].legend(loc="upper right")

    return Picture(
        name="window-cuts",
        caption=(
            "Cuts through the polar-format response of a point 10 m off the axis in cross-range, "
            "over the windows' own responses."
        ),
        draw=draw,
        size_in=(11.0, 3.2 * len(responses)),
    )


def _draw_response(axes: Axes, response: PointResponse) -> AxesImage:
    """Draw a response about where the point is, and return the drawn image."""
    frame = response.frame
    row_m, column_m = (
        np.array([cut.place_cells[0], cut.place_cells[-1]]) * cell_m
        for cut, cell_m in zip(response.cuts, response.cell_m, strict=True)
    )
    level = 20 * np.log10(np.maximum(frame.amplitude, 1e-6))
    image = axes.imshow(
        level,
        vmin=-DEPTH_DB,
        vmax=0,
        extent=(column_m[0], column_m[1], row_m[1], row_m[0]),
        interpolation="nearest",
    )
    axes.set(xlim=(-HALF_SIDE_M, HALF_SIDE_M), ylim=(HALF_SIDE_M, -HALF_SIDE_M))
    axes.grid(visible=False)
    return image


def _decibels(amplitude: Floats) -> Floats:
    level: Floats = 20 * np.log10(np.maximum(amplitude, 1e-6))
    return level
