"""Pictures of the optical part."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from core.experiments.physics.optics_checks import Curve
from core.experiments.physics.optics_outlines import Outlined
from core.experiments.pictures import Picture
from core.optical.sun import phase_angle_rad

TRUTH, OURS = "#5fd38a", "#ffc14d"

HALF_SIDE_M = 10.0
"""Of the square that pictures show, on the target."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """What a pass at dusk shows.

    Attributes:
        start_utc: when the satellite rises.
        found: telescope frames along the pass.
        radar: a radar frame.
        partner: the telescope frame of the same moment, with the paper's roll.
        rolled: the same with another roll.
    """

    start_utc: datetime
    found: tuple[Outlined, ...]
    radar: Outlined
    partner: Outlined
    rolled: Outlined


def pass_picture(scene: Scene) -> Picture:
    """Picture the frames of a pass with their outlines."""

    def draw(canvas: Canvas) -> None:
        axes = canvas.subplots(2, (len(scene.found) + 1) // 2)
        for number, (cell, each) in enumerate(zip(axes.flat, scene.found, strict=True)):
            sun = np.asarray(each.frame.sun_direction)
            phase = np.rad2deg(phase_angle_rad(each.frame.line_of_sight, sun))
            _show(cell, each, f"{each.frame.time_s:.0f} s, phase angle {phase:.0f}°")
            if number == 0:
                cell.legend(loc="lower left")

    return Picture(
        name="optics-pass",
        caption=(
            f"Telescope frames (3.67 m, 0.7 µm) of the laboratory's pass over Beijing from "
            f"{scene.start_utc:%Y-%m-%d %H:%M:%S} UTC on, 20 m wide, each scaled to its "
            "brightest, under a square root: what is extracted is the sunlit side, which at large "
            "phase angles is a sliver of the true outline."
        ),
        draw=draw,
        size_in=(11.0, 7.6),
    )


def partner_picture(scene: Scene) -> Picture:
    """Picture a radar frame beside its perpendicular partner and another roll."""

    def draw(canvas: Canvas) -> None:
        left, middle, right = canvas.subplots(1, 3)
        _show(left, scene.radar, "radar: range down, cross-range right")
        _show(middle, scene.partner, "partner: k × cross-range down, cross-range right")
        _show(right, scene.rolled, "partner, rolled by 40°")
        left.legend(loc="lower left")

    return Picture(
        name="optics-partner",
        caption=(
            "A radar frame and the telescope's frame of the same moment along the same line of "
            "sight: both show the same extent along cross-range, and what one cannot see lies "
            "along the other's rows. 20 m wide."
        ),
        draw=draw,
        size_in=(12.0, 4.6),
    )


def checks_picture(curves: Mapping[str, Curve]) -> Picture:
    """Picture the measured laws beside theory."""

    def draw(canvas: Canvas) -> None:
        left, middle, right = canvas.subplots(1, 3)
        _compare(left, curves["phase"], "phase angle (°)", "flux of a sphere", 180 / np.pi)
        _compare(middle, curves["spread"], "angle (λ/D)", "point spread", 1.0)
        middle.set(yscale="log", ylim=(1e-5, 1.5), xlim=(-6, 6))
        _compare(right, curves["photons"], "mean (electrons)", "variance (electrons²)", 1.0)
        right.set(xscale="log", yscale="log")
        left.legend()

    return Picture(
        name="optics-checks",
        caption=(
            "Rendered light against theory: Lambert's phase law, Airy's point spread and the "
            "photons' variance, which equals their mean."
        ),
        draw=draw,
        size_in=(12.0, 4.0),
    )


def _show(cell: Any, each: Outlined, title: str) -> None:
    frame = each.frame
    level = frame.decibels(floor_db=-40) if frame.sensor == "radar" else np.sqrt(frame.amplitude)
    cell.imshow(level, cmap="inferno" if frame.sensor == "radar" else "gray")
    for outline, colour, name in ((each.truth, TRUTH, "true"), (each.silhouette, OURS, "found")):
        for number, ring in enumerate(outline.rings):
            closed = np.vstack([ring, ring[:1]])
            label = name if number == 0 else None
            cell.plot(closed[:, 1], closed[:, 0], color=colour, linewidth=0.9, label=label)
    row, column = frame.projection.image_points(np.zeros(3))
    tall, wide = (HALF_SIDE_M / spacing for spacing in _spacings_m(each))
    cell.set(xlim=(column - wide, column + wide), ylim=(row + tall, row - tall))
    cell.set_aspect(wide / tall)
    cell.set_title(title)
    cell.grid(visible=False)
    cell.set(xticks=[], yticks=[])


def _spacings_m(each: Outlined) -> tuple[float, float]:
    row, column = np.linalg.norm(each.frame.projection.matrix[:2, :3], axis=1)
    return 1 / float(row), 1 / float(column)


def _compare(cell: Any, curve: Curve, across: str, title: str, scale: float) -> None:
    cell.plot(curve.at * scale, curve.theory, color=TRUTH, label="theory")
    dots = {"linestyle": "none", "marker": "o", "markersize": 3, "color": OURS}
    cell.plot(curve.at * scale, curve.measured, label="rendered", **dots)
    cell.set(xlabel=across)
    cell.set_title(title)
